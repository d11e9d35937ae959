//! Values, errors and alpha on pixels known in closed form.

mod exactness;
mod shading;

use glam::{DVec2, DVec3};

use super::*;
use crate::model::camera::{Camera, Lens};
use crate::model::color::Color;
use crate::model::material::Material;
use crate::model::sphere::Sphere;
use crate::numeric::angle::Angle;
use crate::search::grid::RayPoints;
use crate::search::visibility::Visibility;

/// A 2 × 1 picture whose right pixel is covered but for its left quarter, by a sphere so
/// large that its contour is straight there.
fn scene() -> (World, View) {
    let mut world = World::new();
    let white = world.add_material(Material::MATTE_WHITE);
    let radius = 1e6;
    let touched = DVec3::new(0.25, 0.0, 1.0);
    let across = DVec3::new(1.0, 0.0, -0.25).normalize();
    world.add_sphere(
        Sphere::new(touched + radius * across, radius).unwrap(),
        white,
    );
    world.ambient = Color::splat(0.5);
    world.background = Color::splat(0.1);
    let view = View {
        camera: Camera::free(DVec3::ZERO, Angle::ZERO, Angle::ZERO, Angle::ZERO),
        lens: Lens {
            width: 2.0,
            distance: 1.0,
            shift: DVec2::ZERO,
            pixel_aspect: 1.0,
        },
        zoom: 1.0,
        width: 2,
        height: 1,
        frame: 1,
    };
    (world, view)
}

fn pixels(samples: u32, alpha: bool) -> Vec<Pixel> {
    let (world, view) = scene();
    let visibility = Visibility::new(&world);
    let index = ViewIndex::new(&visibility, &view, RayPoints::All);
    let samples = NonZeroU32::new(samples).unwrap();
    let tile = Tile {
        col: 0,
        row: 0,
        width: 2,
        height: 1,
    };
    let mut pixels = Vec::new();
    Supersampling::new(&world, &view, &index, samples, alpha).integrate(
        tile,
        &mut Scratch::default(),
        &mut pixels,
    );
    pixels
}

#[test]
fn value_is_the_mean_over_the_grid() {
    let [left, right] = pixels(4, false)[..] else {
        panic!("two pixels")
    };
    assert!((left.value.x - 0.1).abs() < 1e-15 && left.alpha == 0.0 && left.error == 0.0);
    assert!((right.value.x - 0.4).abs() < 1e-15 && right.alpha == 0.75);
    assert_eq!(right.error, (0.5 - 0.1) / 8.0);
}

#[test]
fn alpha_leaves_the_background_out_and_counts_in_the_error() {
    let [left, right] = pixels(4, true)[..] else {
        panic!("two pixels")
    };
    assert_eq!(
        (left.value, left.alpha, left.error),
        (Color::ZERO, 0.0, 0.0)
    );
    assert_eq!((right.value, right.alpha), (Color::splat(0.375), 0.75));
    assert_eq!(right.error, 1.0 / 8.0);
}

#[test]
fn one_sample_claims_nothing() {
    assert!(
        pixels(1, false)
            .iter()
            .all(|pixel| pixel.error == f64::INFINITY)
    );
}

/// Pictures of one light after the other, of a crowd whose occluders are looked up for each point.
#[test]
fn what_is_remembered_of_a_light_is_not_taken_for_another() {
    let mut random = crate::search::tests::Random(17);
    let mut world = World::new();
    let white = world.add_material(Material::MATTE_WHITE);
    for _ in 0..4000 {
        let center = random.point() * 2.0;
        world.add_sphere(Sphere::new(center, 0.06).unwrap(), white);
    }
    let view = View {
        camera: Camera {
            position: DVec3::Z * -8.0,
            ..Camera::default()
        },
        width: 64,
        height: 64,
        ..scene().1
    };
    let picture = |toward: DVec3, scratch: &mut Scratch| {
        let mut world = world.clone();
        world
            .lights
            .extend(crate::model::light::Light::directional(toward, Color::ONE));
        let visibility = Visibility::new(&world);
        let index = ViewIndex::new(&visibility, &view, RayPoints::All);
        let one = NonZeroU32::MIN;
        let samples = Supersampling::new(&world, &view, &index, one, false);
        let mut pixels = Vec::new();
        for tile in (0..64).step_by(8).flat_map(|row| {
            let band = Tile {
                col: 0,
                row,
                width: 64,
                height: 8,
            };
            band.tiles()
        }) {
            samples.integrate(tile, scratch, &mut pixels);
        }
        let values = pixels.iter().map(|pixel| pixel.value.x.to_bits());
        values.collect::<Vec<u64>>()
    };
    let mut scratch = Scratch::default();
    for toward in [
        DVec3::new(0.3, 0.3, -1.0),
        DVec3::new(-0.3, 0.2, -1.0),
        DVec3::new(0.0, 1.0, -0.2),
    ] {
        let alone = picture(toward, &mut Scratch::default());
        assert!(picture(toward, &mut scratch) == alone, "{toward}");
    }
}
