mod lights;

use std::num::NonZeroU32;
use std::sync::atomic::AtomicU64;
use std::sync::{Barrier, Mutex};

use glam::{DVec2, DVec3};

use super::*;
use crate::model::camera::{Camera, Lens};
use crate::model::color::Color;
use crate::model::light::Light;
use crate::model::material::Material;
use crate::model::sphere::Sphere;
use crate::model::view::View;
use crate::model::world::World;
use crate::numeric::angle::Angle;
use crate::picture::image::Channels;
use crate::picture::pixel::Method;

/// A white ball, and where it is seen from.
fn ball(width: u32, height: u32) -> (World, View) {
    let mut world = World::new();
    let white = world.add_material(Material::MATTE_WHITE);
    world.add_sphere(Sphere::new(5.0 * DVec3::Z, 1.0).unwrap(), white);
    let light = Light::directional(DVec3::new(-1.0, 1.0, -1.0), Color::ONE);
    world.lights.extend(light);
    let view = View {
        camera: Camera::free(DVec3::ZERO, Angle::ZERO, Angle::ZERO, Angle::ZERO),
        lens: Lens {
            width: 3.0,
            distance: 5.0,
            shift: DVec2::ZERO,
            pixel_aspect: 1.0,
        },
        zoom: 1.0,
        width,
        height,
        frame: 1,
    };
    (world, view)
}

/// All that is known of a pixel.
fn pixel(image: &Image, col: u32, row: u32) -> String {
    let (rgba, error) = (image.rgba(col, row), image.error(col, row));
    let ending = (image.evidence(col, row), image.status(col, row));
    format!("{rgba:?} {error:?} {ending:?}")
}

/// Renders a window on all threads.
fn render(
    renderer: &Renderer<'_>,
    (view, window): (&View, Window),
    settings: &Settings,
    sink: &Collector,
    progress: &(dyn Fn(u64) -> ControlFlow<()> + Sync),
) -> Result<Work, Cancelled> {
    let rendering = renderer.begin(view, window, settings, sink.rows);
    let mut sum = Work::default();
    for work in rayon::broadcast(|_| rendering.help(sink, progress)) {
        sum += work?;
    }
    assert_eq!(rendering.strips_left(), 0);
    Ok(sum)
}

/// Keeps what is known of all pixels.
struct Collector {
    view: View,
    /// Rows of a strip.
    rows: u32,
    /// Row by row; empty where none came.
    pixels: Mutex<Vec<String>>,
    begun: AtomicU32,
    ended: AtomicU32,
    /// After so many strips no more are wanted.
    most: u32,
}

impl Collector {
    fn new(view: View, rows: u32) -> Self {
        Self {
            view,
            rows,
            pixels: Mutex::new(vec![String::new(); (view.width * view.height) as usize]),
            begun: AtomicU32::new(0),
            ended: AtomicU32::new(0),
            most: u32::MAX,
        }
    }
}

impl Sink for Collector {
    fn begin(&self, index: u32) -> Option<Box<dyn Strip + '_>> {
        let begun = self.begun.fetch_add(1, Ordering::Relaxed);
        let row = index * self.rows;
        let strip = CollectedStrip {
            collector: self,
            row,
            rows: self.rows.min(self.view.height - row),
            next: 0,
        };
        (begun < self.most).then(|| Box::new(strip) as Box<dyn Strip>)
    }
}

struct CollectedStrip<'a> {
    collector: &'a Collector,
    row: u32,
    rows: u32,
    /// The column that comes next.
    next: u32,
}

impl Strip for CollectedStrip<'_> {
    fn add(&mut self, col: u32, part: &Image) {
        assert_eq!(col, self.next);
        self.next += part.width();
        assert_eq!(part.height(), self.rows);
        let mut pixels = self.collector.pixels.lock().unwrap();
        for in_part in 0..self.rows {
            let first = ((self.row + in_part) * self.collector.view.width + col) as usize;
            for col in 0..part.width() {
                pixels[first + col as usize] += &pixel(part, col, in_part);
            }
        }
    }

    fn end(self: Box<Self>) {
        assert_eq!(self.next, self.collector.view.width);
        self.collector.ended.fetch_add(1, Ordering::Relaxed);
    }
}

fn settings() -> [Settings; 3] {
    [(1, false), (3, true), (0, true)].map(|(samples, alpha)| Settings {
        method: NonZeroU32::new(samples).map_or(Method::Tolerance(1e-3), Method::Samples),
        alpha,
    })
}

#[test]
fn strips_are_the_picture_whatever_their_height() {
    for (width, height) in [(37, 21), (1, 1), (2 * PART_COLUMNS + 3, 17)] {
        let (mut world, view) = ball(width, height);
        for background in [Color::splat(0.25), Color::new(0.5, 0.25, 0.125)] {
            world.background = background;
            let renderer = Renderer::new(&world);
            for settings in settings() {
                let go = |_| ControlFlow::Continue(());
                let image = renderer
                    .render_with_progress(&view, &settings, &go)
                    .unwrap();
                let places = (0..height).flat_map(|row| (0..width).map(move |col| (col, row)));
                let expected: Vec<String> =
                    places.map(|(col, row)| pixel(&image, col, row)).collect();
                for rows in [1, 2, 3].map(|steps| steps * Rendering::ROW_STEP) {
                    let (sink, done) = (Collector::new(view, rows), AtomicU64::new(0));
                    let count = |pixels| {
                        done.fetch_add(pixels, Ordering::Relaxed);
                        ControlFlow::Continue(())
                    };
                    let whole = (&view, Window::whole(&view));
                    let work = render(&renderer, whole, &settings, &sink, &count);
                    assert_eq!(work, Ok(image.work()));
                    assert_eq!(done.into_inner(), u64::from(width) * u64::from(height));
                    assert_eq!(sink.ended.into_inner(), height.div_ceil(rows));
                    assert!(sink.pixels.into_inner().unwrap() == expected, "{rows} rows");
                }
            }
        }
    }
}

#[test]
fn windows_show_what_the_picture_does() {
    let (width, height) = (PART_COLUMNS + 21, 45);
    let (mut world, view) = ball(width, height);
    world.background = Color::new(0.5, 0.25, 0.125);
    let renderer = Renderer::new(&world);
    let go = |_| ControlFlow::Continue(());
    for settings in settings() {
        let image = renderer
            .render_with_progress(&view, &settings, &go)
            .unwrap();
        for (col, row, width, height) in [
            (0, 0, width, height),
            (8, 16, 16, 8),
            (3, 5, 1, 1),
            (5, 7, width - 7, 30),
            (width - 1, height - 1, 1, 1),
            (PART_COLUMNS - 1, 1, 3, height - 1),
        ] {
            let window = Window {
                col,
                row,
                width,
                height,
            };
            let places =
                (row..row + height).flat_map(|row| (col..col + width).map(move |c| (c, row)));
            let expected: Vec<String> = places.map(|(col, row)| pixel(&image, col, row)).collect();
            for rows in [1, 5, Rendering::ROW_STEP, 2 * Rendering::ROW_STEP] {
                let size = View {
                    width,
                    height,
                    ..view
                };
                let sink = Collector::new(size, rows);
                let ended = render(&renderer, (&view, window), &settings, &sink, &go);
                assert!(ended.is_ok());
                assert!(
                    sink.pixels.into_inner().unwrap() == expected,
                    "{window:?}, {rows} rows"
                );
            }
        }
    }
}

#[test]
fn parts_have_the_channels_of_the_world() {
    let (mut world, view) = ball(9, 9);
    world.background = Color::X;
    for (alpha, expected) in [(false, Channels::Rgb), (true, Channels::Grey)] {
        assert_eq!(Channels::of(&world, alpha), expected);
        let settings = Settings {
            alpha,
            ..settings()[0]
        };
        let go = |_| ControlFlow::Continue(());
        let image = Renderer::new(&world).render_with_progress(&view, &settings, &go);
        assert_eq!(image.map(|image| image.channels()), Ok(expected));
    }
}

#[test]
fn a_sink_and_progress_can_end_the_rendering() {
    let (world, view) = ball(9, 900);
    let renderer = Renderer::new(&world);
    let sink = Collector {
        most: 3,
        ..Collector::new(view, Rendering::ROW_STEP)
    };
    let go = |_| ControlFlow::Continue(());
    let whole = (&view, Window::whole(&view));
    let ended = render(&renderer, whole, &settings()[0], &sink, &go);
    assert_eq!(ended, Err(Cancelled));
    // Each thread asks once more at most.
    let threads = rayon::current_num_threads() as u32;
    assert!(sink.begun.into_inner() <= 3 + threads);

    let sink = Collector::new(view, Rendering::ROW_STEP);
    let stop = |_| ControlFlow::Break(());
    let ended = render(&renderer, whole, &settings()[0], &sink, &stop);
    assert_eq!(ended, Err(Cancelled));
    assert!(sink.begun.into_inner() <= threads);
}

/// One strip of whose picture comes late.
struct Late<'a> {
    collector: &'a Collector,
    strip: u32,
    until: Barrier,
}

impl Sink for Late<'_> {
    fn begin(&self, index: u32) -> Option<Box<dyn Strip + '_>> {
        if index == self.strip {
            self.until.wait();
        }
        self.collector.begin(index)
    }
}

#[test]
fn a_thread_goes_on_while_another_ends_the_picture_before() {
    let (world, view) = ball(37, 60);
    let zoomed = View { zoom: 1.5, ..view };
    let renderer = Renderer::new(&world);
    let settings = settings()[2];
    let go = |_| ControlFlow::Continue(());
    let [first, second] = [view, zoomed].map(|view| Collector::new(view, Rendering::ROW_STEP));
    let late = Late {
        collector: &first,
        strip: 5,
        until: Barrier::new(2),
    };
    let begin = |view| renderer.begin(view, Window::whole(view), &settings, Rendering::ROW_STEP);
    let [one, other] = [begin(&view), begin(&zoomed)];
    assert_eq!(one.strips_left(), 8);
    std::thread::scope(|scope| {
        for _ in 0..2 {
            scope.spawn(|| {
                one.help(&late, &go).unwrap();
                assert_eq!(one.strips_left(), 0);
                other.help(&second, &go).unwrap();
                // Whoever has the late strip is still at it when the second picture is done.
                if first.ended.load(Ordering::Relaxed) < 8 {
                    assert_eq!(second.ended.load(Ordering::Relaxed), 8);
                    late.until.wait();
                }
            });
        }
    });
    for (view, sink) in [(view, first), (zoomed, second)] {
        let image = renderer
            .render_with_progress(&view, &settings, &go)
            .unwrap();
        let places = (0..60).flat_map(|row| (0..37).map(move |col| (col, row)));
        let expected: Vec<String> = places.map(|(col, row)| pixel(&image, col, row)).collect();
        assert!(sink.pixels.into_inner().unwrap() == expected);
    }
}
