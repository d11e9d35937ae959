//! Measures the cost of the geometry at pixel centers, in addition to one sample per pixel.

use std::num::NonZeroU32;
use std::ops::ControlFlow;
use std::sync::atomic::{AtomicU64, Ordering};

use glam::DVec2;
use marbles_benches::{Case, load, main as run, square_view, table};
use marbles_core::{
    AverageSettings, Axes, Depth, Geometry, GeometrySettings, Image, Lens, Method, Precision,
    Quantity, Renderer, Settings, Sink, Strip, View, Window,
};

const SIDE: u32 = 600;
/// The width of a parallel lens that shows the balls in about the same size.
const WIDTH: f64 = 350.0;
/// The height of the strips of an EXR.
const ROWS: u32 = 16;

/// Counts the pixels of the geometries that it receives.
#[derive(Default)]
struct Counter(AtomicU64);

impl Sink for Counter {
    fn begin(&self, _: u32) -> Option<Box<dyn Strip + '_>> {
        Some(Box::new(CountedStrip(self)))
    }
}

struct CountedStrip<'a>(&'a Counter);

impl Strip for CountedStrip<'_> {
    fn add_geometry(&mut self, _: u32, part: &Geometry) {
        let pixels = u64::from(part.width()) * u64::from(part.height());
        self.0.0.fetch_add(pixels, Ordering::Relaxed);
    }

    fn add(&mut self, _: u32, _: &Image) {}

    fn end(self: Box<Self>) {}
}

/// Renders with one sample per pixel; returns the number of pixels whose geometry was computed.
fn pixels(renderer: &Renderer<'_>, view: &View, geometry: Option<&GeometrySettings>) -> u64 {
    let settings = Settings {
        method: Method::Samples(NonZeroU32::MIN),
        alpha: false,
    };
    let window = Window::whole(view);
    let counter = Counter::default();
    let rendering = renderer.begin_with_geometry(view, window, &settings, ROWS, geometry);
    let helped = rendering.help(&counter, &|_| ControlFlow::Continue(()));
    helped.expect("nothing cancels it");
    counter.0.into_inner()
}

fn main() {
    run(|| {
        let scene = load("tests/truth/pixels/cloud1k");
        let view = square_view(&scene, SIDE);
        let parallel = View {
            lens: Lens::parallel(WIDTH, DVec2::ZERO),
            ..view
        };
        let renderer = Renderer::new(scene.world());
        let wanted = |quantities: &[Quantity], axes, precision| {
            Some(GeometrySettings {
                quantities: quantities.iter().copied().collect(),
                depth: Depth::Axis,
                axes,
                precision,
                averages: AverageSettings::default(),
            })
        };
        let (world, camera) = (Axes::World, Axes::CameraOpenCv);
        let (single, double) = (Precision::Single, Precision::Double);
        let all = [
            Quantity::Depth,
            Quantity::Normal,
            Quantity::Position,
            Quantity::Albedo,
        ];
        let cases = [
            ("none", &view, None),
            ("id", &view, wanted(&[], world, single)),
            ("depth", &view, wanted(&all[..1], world, single)),
            (
                "depth, normal, position",
                &view,
                wanted(&all[..3], world, single),
            ),
            ("all", &view, wanted(&all, world, single)),
            ("all, camera's axes", &view, wanted(&all, camera, single)),
            ("all, doubles", &view, wanted(&all, world, double)),
            (
                "all, doubles, camera's axes",
                &view,
                wanted(&all, camera, double),
            ),
            ("parallel rays, none", &parallel, None),
            ("parallel rays, all", &parallel, wanted(&all, world, single)),
            (
                "parallel rays, all, doubles",
                &parallel,
                wanted(&all, world, double),
            ),
        ];
        let are_wanted = cases.each_ref().map(|(_, _, settings)| settings.is_some());
        let cases = cases.map(|(name, view, settings)| Case {
            name: name.to_owned(),
            millions: f64::from(SIDE * SIDE) * 1e-6,
            run: Box::new({
                let renderer = &renderer;
                move |_| pixels(renderer, view, settings.as_ref())
            }),
        });
        let counts = table("channels", "rays", 6, &cases);
        let expected = are_wanted.map(|is_wanted| u64::from(is_wanted) * u64::from(SIDE * SIDE));
        assert_eq!(counts[..], expected);
    });
}
