//! The same bits however the picture is cut, and nothing missed between moments.

use std::ops::ControlFlow;
use std::sync::Arc;

use glam::{DVec2, DVec3};

use super::exact::ExactOverTime;
use super::instants::Instants;
use super::sampled::SampledOverTime;
use crate::model::camera::{Camera, Lens};
use crate::model::color::Color;
use crate::model::exposure::{Motion, Pose};
use crate::model::light::Light;
use crate::model::material::Material;
use crate::model::sphere::Sphere;
use crate::model::view::View;
use crate::model::world::World;
use crate::numeric::angle::Angle;
use crate::picture::pixel::{Method, Pixel, Work};
use crate::picture::progress::{Cancelled, Progress};
use crate::picture::tile::Tile;
use crate::search::visibility::Visibility;

/// A pan by so many degrees, evenly.
#[derive(Debug)]
struct Pan(f64);

impl Motion for Pan {
    fn pose(&self, time: f64) -> Option<Pose> {
        let pan = Angle::from_degrees(self.0 * time);
        Some(Pose {
            camera: Camera::free(DVec3::ZERO, pan, Angle::ZERO, Angle::ZERO),
            zoom: 1.0,
        })
    }

    fn is_smooth(&self) -> bool {
        true
    }
}

const VIEW: View = View {
    camera: Camera {
        position: DVec3::ZERO,
        on_axis: DVec3::ZERO,
        world_from_camera: glam::DMat3::IDENTITY,
    },
    lens: Lens {
        width: 1.0,
        distance: 1.0,
        shift: DVec2::ZERO,
        pixel_aspect: 1.0,
    },
    zoom: 1.0,
    width: 29,
    height: 13,
    frame: 1,
};

fn world(balls: &[(DVec3, f64)]) -> World {
    let mut world = World::new();
    let white = world.add_material(Material::MATTE_WHITE);
    for &(center, radius) in balls {
        world.add_sphere(Sphere::new(center, radius).unwrap(), white);
    }
    world
        .lights
        .extend(Light::directional(DVec3::new(-1.0, 1.0, -1.0), Color::ONE));
    world.ambient = Color::splat(0.1);
    world.background = Color::splat(0.3);
    world
}

/// All pixels of the picture, in tiles of this side.
fn pixels(world: &World, pan: f64, method: Method, side: u32) -> Vec<Pixel> {
    let visibility = Visibility::new(world);
    let instants = Instants::new(&visibility, &VIEW, Arc::new(Pan(pan)), method);
    match method {
        Method::Tolerance(tolerance) => {
            let integrator = ExactOverTime::new(world, instants, tolerance, false);
            in_tiles(side, |tile, progress| {
                integrator.pixels(tile, &mut Default::default(), progress)
            })
        }
        Method::Samples(samples) => {
            let integrator = SampledOverTime::new(world, instants, samples, false);
            in_tiles(side, |tile, progress| {
                integrator.pixels(tile, &mut Default::default(), progress)
            })
        }
    }
}

fn in_tiles(
    side: u32,
    pixels: impl Fn(Tile, &Progress<'_>) -> Result<(Vec<Pixel>, Work), Cancelled>,
) -> Vec<Pixel> {
    let mut found = vec![None; (VIEW.width * VIEW.height) as usize];
    for row in (0..VIEW.height).step_by(side as usize) {
        for col in (0..VIEW.width).step_by(side as usize) {
            let tile = Tile {
                col,
                row,
                width: side.min(VIEW.width - col),
                height: side.min(VIEW.height - row),
            };
            let (pixels, _) = pixels(tile, &|_| ControlFlow::Continue(())).unwrap();
            for ((col, row), pixel) in tile.pixels().zip(pixels) {
                found[(row * VIEW.width + col) as usize] = Some(pixel);
            }
        }
    }
    found.into_iter().map(Option::unwrap).collect()
}

#[test]
fn tiles_do_not_change_a_bit() {
    let balls = [
        (DVec3::new(0.0, 0.0, 5.0), 1.0),
        (DVec3::new(-0.9, 0.4, 4.0), 0.3),
        (DVec3::new(1.2, -0.3, 6.0), 0.1),
    ];
    let world = world(&balls);
    let three = std::num::NonZeroU32::new(3).unwrap();
    for method in [Method::Tolerance(1e-3), Method::Samples(three)] {
        let expected = pixels(&world, 10.0, method, Tile::SIDE);
        for side in [1, 2, 4] {
            let found = pixels(&world, 10.0, method, side);
            assert!(expected == found, "tiles of {side}, {method:?}");
        }
    }
}

/// A ball far smaller than its way: its light is spread along that, wherever it lies to the moments
/// that are looked at.
#[test]
fn what_passes_quickly_is_seen() {
    for place in 0..7 {
        let x = 0.11 * f64::from(place) - 0.3;
        let world = world(&[(DVec3::new(x, 0.0, 10.0), 0.1)]);
        let moving = pixels(&world, 30.0, Method::Tolerance(1e-3), Tile::SIDE);
        let still = pixels(&world, 0.0, Method::Tolerance(1e-4), Tile::SIDE);
        // Off the axis of view pictures are larger: no more than this.
        let larger = 1.0..1.25;
        let light = |pixels: &[Pixel]| -> f64 {
            let above = pixels.iter().map(|pixel| pixel.alpha);
            above.sum()
        };
        let part = light(&moving) / light(&still);
        assert!(larger.contains(&part), "{place}: {part}");
        let touched = moving.iter().filter(|pixel| pixel.alpha > 0.0).count();
        assert!(touched > 14, "{touched} pixels");
    }
}

#[test]
fn breaking_progress_ends_the_work() {
    let world = world(&[(DVec3::new(0.0, 0.0, 5.0), 1.0)]);
    let exposure = crate::Exposure::of_motion(VIEW, Pan(10.0));
    let settings = crate::Settings {
        method: Method::Tolerance(1e-3),
        alpha: false,
    };
    let renderer = crate::Renderer::new(&world);
    let ended = renderer.render_with_progress(&exposure, &settings, &|_| ControlFlow::Break(()));
    assert_eq!(ended, Err(crate::Cancelled));
}
