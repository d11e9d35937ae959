//! The geometry at pixel centers, compared with rational arithmetic.

mod scenes;

use std::num::NonZeroU32;
use std::ops::ControlFlow;
use std::sync::Mutex;

use glam::DVec3;
use marbles_core::{
    AverageSettings, Axes, Depth, Geometry, GeometrySettings, Grain, Image, Material, Method,
    Precision, Quantities, Quantity, Ray, Renderer, Roughness, Settings, Sink, Sphere, Strip, View,
    Window, World,
};
use marbles_tests::hits::judge::{Exact, ExactPoint};
use rayon::prelude::*;

use self::scenes::{SIDE, scenes, view};

/// The largest error of a number, in units in the last place.
const CLAIM: f64 = 2.0;

/// Binary digits and least exponents of floats and doubles.
const SINGLE: (i32, i32) = (24, -126);
const DOUBLE: (i32, i32) = (53, -1022);

fn settings(axes: Axes, depth: Depth, precision: Precision) -> GeometrySettings {
    GeometrySettings {
        quantities: Quantity::ALL.into_iter().collect(),
        depth,
        axes,
        precision,
        averages: AverageSettings::default(),
    }
}

/// The sphere that a ray hits, and the point.
fn truth(world: &World, ray: &Ray) -> Option<(usize, ExactPoint)> {
    let mut nearest: Option<(usize, ExactPoint)> = None;
    for (index, sphere) in world.spheres().iter().enumerate() {
        let Some(point) = ExactPoint::new(sphere, ray) else {
            continue;
        };
        let is_nearer = nearest
            .as_ref()
            .is_none_or(|(_, other)| point.distance().order(&other.distance()).is_lt());
        if is_nearer {
            nearest = Some((index, point));
        }
    }
    nearest
}

/// The ray through the center of a pixel, and its point on the retina.
fn center_ray(view: &View, col: usize, row: u32) -> (Ray, DVec3) {
    let center = view.cell_center(col as u64, u64::from(row), 1);
    if view.lens.is_parallel() {
        return (view.ray(center), (center / view.zoom).extend(1.0));
    }
    let retina = center.extend(view.lens.distance * view.zoom);
    (view.ray(center), retina)
}

/// The largest errors of depths, positions and normals, in units in the last place, and the number of pixels in which a
/// sphere is visible.
#[derive(Clone, Copy, Default)]
struct Errors {
    worst: [f64; 3],
    pixels: u64,
}

impl Errors {
    fn and(mut self, other: Self) -> Self {
        for (worst, other) in self.worst.iter_mut().zip(other.worst) {
            *worst = worst.max(other);
        }
        self.pixels += other.pixels;
        self
    }
}

/// Judges a row of pixels; the indices must be correct.
fn judge(
    (name, world, view): &(&str, World, View),
    settings: &GeometrySettings,
    geometry: &Geometry,
    row: u32,
) -> Errors {
    let digits = match settings.precision {
        Precision::Single => SINGLE,
        Precision::Double => DOUBLE,
    };
    let signs = match settings.axes {
        Axes::World => DVec3::ONE,
        Axes::CameraOpenCv => DVec3::new(1.0, -1.0, 1.0),
        Axes::CameraOpenGl => DVec3::new(1.0, 1.0, -1.0),
    };
    let found = |quantity, component, col: usize| {
        let mut values = geometry.values(quantity, component, row).unwrap();
        values.nth(col).unwrap()
    };
    let mut errors = Errors::default();
    for (col, id) in geometry.ids(row).enumerate() {
        let (ray, retina) = center_ray(view, col, row);
        let Some((index, point)) = truth(world, &ray) else {
            assert_eq!(id, Geometry::NOTHING, "{name} {col} {row}");
            assert_eq!(found(Quantity::Depth, 0, col), f64::INFINITY);
            assert_eq!(found(Quantity::Position, 1, col), 0.0);
            continue;
        };
        assert_eq!(id as usize, index, "{name} {col} {row}");
        errors.pixels += 1;
        let mut hold = |kind: usize, exact: Exact, found: f64| {
            let error = exact.error(found, digits);
            assert!(
                error <= CLAIM,
                "{name} {col} {row}: {kind} is off by {error} ulp: {found:e}"
            );
            errors.worst[kind] = errors.worst[kind].max(error);
        };
        let depth = match settings.depth {
            Depth::Axis => point.distance().times(retina.z),
            Depth::Ray if view.lens.is_parallel() => point.distance(),
            Depth::Ray => point.length(),
        };
        hold(0, depth, found(Quantity::Depth, 0, col));
        let camera = &view.camera.world_from_camera;
        for axis in 0..3 {
            let (position, along) = if settings.axes == Axes::World {
                (point.position(axis), DVec3::AXES[axis])
            } else {
                let position = if axis < 2 && view.lens.is_parallel() {
                    Exact::number(retina[axis] * signs[axis])
                } else {
                    point.distance().times(retina[axis] * signs[axis])
                };
                (position, camera.col(axis) * signs[axis])
            };
            hold(1, position, found(Quantity::Position, axis, col));
            let normal = found(Quantity::GeometricNormal, axis, col);
            hold(2, point.normal(along), normal);
            assert_eq!(normal, found(Quantity::Normal, axis, col));
            let albedo = world.albedo(index)[axis];
            let digits = SINGLE.0;
            let off = (found(Quantity::Albedo, axis, col) - albedo).abs();
            assert!(off <= libm::scalbn(albedo, -digits));
        }
    }
    errors
}

/// Judges every pixel of every scene.
#[expect(clippy::print_stdout, reason = "the measured errors are worth a look")]
fn judge_all(settings: &GeometrySettings) -> Errors {
    let mut all = Errors::default();
    for scene in &scenes() {
        let (_, world, view) = scene;
        let geometry = Renderer::new(world).geometry(view, settings);
        let rows = (0..SIDE).into_par_iter();
        let errors = rows
            .map(|row| judge(scene, settings, &geometry, row))
            .reduce(Errors::default, Errors::and);
        println!("{} {:?}: {:.3?} ulp", scene.0, settings.axes, errors.worst);
        all = all.and(errors);
    }
    all
}

#[test]
fn ten_thousand_floats_are_the_exact_ones() {
    let errors = judge_all(&settings(Axes::World, Depth::Axis, Precision::Single));
    assert!(errors.pixels > 10_000, "{}", errors.pixels);
    // The claims are not idle: the last rounding alone costs half.
    assert!(
        errors.worst.iter().all(|&worst| worst > 0.4),
        "{:?}",
        errors.worst
    );
    judge_all(&settings(Axes::CameraOpenCv, Depth::Ray, Precision::Single));
}

#[test]
fn ten_thousand_doubles_are_the_exact_ones() {
    let errors = judge_all(&settings(Axes::World, Depth::Ray, Precision::Double));
    assert!(errors.pixels > 10_000, "{}", errors.pixels);
    judge_all(&settings(
        Axes::CameraOpenGl,
        Depth::Axis,
        Precision::Double,
    ));
}

/// Pictures and geometries of parts, which together form the whole.
#[derive(Default)]
struct Collector {
    parts: Mutex<Vec<(u32, u32, Geometry, Image)>>,
}

struct Part<'a> {
    collector: &'a Collector,
    strip: u32,
    geometry: Option<Geometry>,
}

impl Sink for Collector {
    fn begin(&self, index: u32) -> Option<Box<dyn Strip + '_>> {
        Some(Box::new(Part {
            collector: self,
            strip: index,
            geometry: None,
        }))
    }
}

impl Strip for Part<'_> {
    fn add_geometry(&mut self, _: u32, part: &Geometry) {
        self.geometry = Some(part.clone());
    }

    fn add(&mut self, col: u32, part: &Image) {
        let geometry = self.geometry.take().unwrap();
        let mut parts = self.collector.parts.lock().unwrap();
        parts.push((col, self.strip * 8, geometry, part.clone()));
    }

    fn end(self: Box<Self>) {}
}

fn values(geometry: &Geometry, quantity: Quantity, row: u32) -> Vec<f64> {
    geometry.values(quantity, 0, row).unwrap().collect()
}

#[test]
fn a_sample_sees_what_the_geometry_tells() {
    let wanted = settings(Axes::World, Depth::Axis, Precision::Single);
    let window = Window {
        col: 5,
        row: 3,
        width: 37,
        height: 40,
    };
    for (name, world, view) in &scenes() {
        let renderer = Renderer::new(world);
        let whole = renderer.geometry(view, &wanted);
        let methods = [Method::Samples(NonZeroU32::MIN), Method::Tolerance(0.1)];
        for method in methods {
            let settings = Settings {
                method,
                alpha: false,
            };
            let collector = Collector::default();
            let rendering = renderer.begin_with_geometry(view, window, &settings, 8, Some(&wanted));
            let help = |_: u64| ControlFlow::Continue(());
            rendering.help(&collector, &help).unwrap();
            let parts = collector.parts.into_inner().unwrap();
            assert_eq!(parts.len(), 5);
            for (col, row, geometry, image) in &parts {
                for part_row in 0..geometry.height() {
                    let in_whole = window.row + row + part_row;
                    let first = (window.col + col) as usize;
                    let columns = first..first + geometry.width() as usize;
                    let ids: Vec<u32> = geometry.ids(part_row).collect();
                    let all: Vec<u32> = whole.ids(in_whole).collect();
                    assert_eq!(ids, all[columns.clone()], "{name}");
                    for quantity in Quantity::ALL {
                        let values = values(geometry, quantity, part_row);
                        let all = self::values(&whole, quantity, in_whole);
                        assert_eq!(values, all[columns.clone()], "{name} {quantity:?}");
                    }
                    for (col, id) in (0..).zip(ids) {
                        let [red, ..] = image.rgba(col, part_row);
                        // Every sphere glows in its own color, and the background is black.
                        let seen = red as u32;
                        let is_sample = method == Method::Samples(NonZeroU32::MIN);
                        assert!(!is_sample || seen == id.wrapping_add(1), "{name}");
                    }
                }
            }
        }
    }
}

#[test]
fn bumps_tilt_the_shading_normal_alone() {
    for grain in [Grain::Surface(0.3), Grain::Pixel] {
        let mut world = World::new();
        let rough = world.add_material(Material {
            roughness: Some(Roughness {
                amplitude: 0.4,
                grain,
                seed: 3,
            }),
            ..Material::MATTE_WHITE
        });
        let smooth = world.add_material(Material::MATTE_WHITE);
        world.add_sphere(Sphere::new(DVec3::new(-1.0, 0.0, 6.0), 1.0).unwrap(), rough);
        world.add_sphere(Sphere::new(DVec3::new(1.0, 0.0, 6.0), 1.0).unwrap(), smooth);
        let view = view(DVec3::ZERO, [0.0; 3], 1.0);
        let wanted = settings(Axes::World, Depth::Axis, Precision::Single);
        let geometry = Renderer::new(&world).geometry(&view, &wanted);
        let mut tilted = 0;
        for row in 0..SIDE {
            let vector = |quantity, col: usize| {
                let of = |axis| {
                    let mut values = geometry.values(quantity, axis, row).unwrap();
                    values.nth(col).unwrap()
                };
                DVec3::new(of(0), of(1), of(2))
            };
            for (col, id) in geometry.ids(row).enumerate() {
                let shading = vector(Quantity::Normal, col);
                let geometric = vector(Quantity::GeometricNormal, col);
                match id {
                    0 => {
                        assert!((shading.length() - 1.0).abs() < 1e-7);
                        tilted += u32::from(shading.angle_between(geometric) > 0.01);
                    }
                    1 => assert_eq!(shading, geometric),
                    _ => assert_eq!((shading, geometric), (DVec3::ZERO, DVec3::ZERO)),
                }
            }
        }
        assert!(tilted > 100, "{tilted}");
    }
}

#[test]
fn only_what_is_wanted_is_told() {
    let (_, world, view) = &scenes()[0];
    let wanted = GeometrySettings {
        quantities: Quantities::default().with(Quantity::Normal),
        ..settings(Axes::World, Depth::Axis, Precision::Single)
    };
    let all = settings(Axes::World, Depth::Axis, Precision::Single);
    let renderer = Renderer::new(world);
    let [some, all] = [wanted, all].map(|settings| renderer.geometry(view, &settings));
    for row in 0..SIDE {
        assert!(some.ids(row).eq(all.ids(row)));
        assert!(some.values(Quantity::Depth, 0, row).is_none());
        for axis in 0..3 {
            let of = |one: &Geometry| -> Vec<f64> {
                one.values(Quantity::Normal, axis, row).unwrap().collect()
            };
            assert_eq!(of(&some), of(&all));
        }
    }
}
