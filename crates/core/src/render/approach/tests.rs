use glam::{DVec2, DVec3};

use super::*;
use crate::model::camera::{Camera, Lens};
use crate::model::exposure::{Motion, Pose};
use crate::model::material::Material;
use crate::numeric::angle::Angle;

/// A ball of albedo 0.5 in ambient light of 0.2, under a light of intensity 0.6, before a background of 0.05.
fn world() -> World {
    let mut world = World::new();
    world.background = Color::splat(0.05);
    world.ambient = Color::splat(0.2);
    let light = Light::directional(DVec3::NEG_Z, Color::splat(0.6));
    world.lights.push(light.unwrap());
    let material = world.add_material(Material {
        albedo: Color::splat(0.5),
        ..Material::MATTE_WHITE
    });
    world.add_sphere(Sphere::new(5.0 * DVec3::Z, 1.0).unwrap(), material);
    world
}

fn view(width: u32) -> View {
    View {
        camera: Camera::free(DVec3::ZERO, Angle::ZERO, Angle::ZERO, Angle::ZERO),
        lens: Lens {
            width: 1.0,
            distance: 1.0,
            shift: DVec2::ZERO,
            pixel_aspect: 1.0,
        },
        zoom: 1.0,
        width,
        height: width,
        frame: 1,
    }
}

fn approach_of(world: &World, exposure: &Exposure<'_>, tolerance: f64, alpha: bool) -> Approach {
    let method = Method::Tolerance(tolerance);
    let light = (world.lights.as_slice(), world.sky);
    Approach::of(world, light, exposure, &Settings { method, alpha })
}

fn approach(tolerance: f64, alpha: bool) -> Approach {
    approach_of(&world(), &(&view(100)).into(), tolerance, alpha)
}

fn samples(per_side: u32) -> Method {
    Method::Samples(NonZeroU32::new(per_side).unwrap())
}

#[test]
fn one_sample_suffices_for_more_than_twice_the_contrast() {
    assert_eq!(approach(0.87, false).method, samples(2));
    let found = approach(0.88, false);
    assert_eq!(found.method, samples(1));
    assert!((found.uniform.error.unwrap() - 0.35).abs() < 1e-12);
}

#[test]
fn samples_suffice_for_the_whole_contrast() {
    // From the background, 0.05, to the ball, 0.5 (0.2 + 0.6).
    let found = approach(0.3501, false);
    assert_eq!(found.method, samples(2));
    let error = found.uniform.error.unwrap();
    assert!((error - 0.35).abs() < 1e-12, "{error}");
    assert_eq!(found.uniform.outcome, Some((Evidence::Bound, Status::Met)));
}

#[test]
fn three_by_three_samples_suffice_for_half_of_the_contrast() {
    let found = approach(0.1751, false);
    assert_eq!(found.method, samples(3));
    let error = found.uniform.error.unwrap();
    assert!((error - 0.4 * 0.35).abs() < 1e-12, "{error}");
    assert_eq!(
        found.uniform.outcome,
        Some((Evidence::Estimate, Status::Met))
    );
    // Alpha differs by 1.
    assert_eq!(approach(0.5, true).method, samples(3));
}

#[test]
fn less_than_half_of_the_contrast_is_integrated() {
    assert_eq!(approach(0.1749, false).method, Method::Tolerance(0.1749));
    assert_eq!(approach(0.49, true).method, Method::Tolerance(0.49));
}

#[test]
fn spheres_between_samples_are_integrated() {
    let mut world = world();
    let material = world.add_material(Material::MATTE_WHITE);
    // The contrast is 0.75 now. A pixel is 0.05 wide there.
    let small = |radius| Sphere::new(5.0 * DVec3::X, radius).unwrap();
    world.add_sphere(small(0.017), material);
    let still = Exposure::from(&view(100));
    assert_eq!(approach_of(&world, &still, 0.4, false).method, samples(3));
    // Of pixels twice as high as wide, 0.017 is less than a third of the height.
    let mut high = view(100);
    high.lens.pixel_aspect = 0.5;
    let integrated = Method::Tolerance(0.4);
    let approach = approach_of(&world, &(&high).into(), 0.4, false);
    assert_eq!(approach.method, integrated);
    world.add_sphere(small(0.016), material);
    assert_eq!(approach_of(&world, &still, 0.4, false).method, integrated);
}

#[test]
fn crowds_are_sampled_to_less() {
    let mut world = world();
    let material = world.add_material(Material::MATTE_WHITE);
    for _ in 0..16 {
        world.add_sphere(Sphere::new(5.0 * DVec3::Z, 1.0).unwrap(), material);
    }
    let integrated = Method::Tolerance(0.16);
    let method = |world: &World, width| {
        let exposure = (&view(width)).into();
        approach_of(world, &exposure, 0.16, false).method
    };
    // A raster knows the shadows of matte spheres in less time.
    world.shadows = false;
    assert_eq!(method(&world, 4), samples(6));
    world.shadows = true;
    assert_eq!(method(&world, 4), integrated);
    // It knows no large ones, such as one around the eye, and matte materials alone.
    let mut around = world.clone();
    around.add_sphere(Sphere::new(0.02 * DVec3::Z, 1.0).unwrap(), material);
    assert_eq!(method(&around, 4), samples(6));
    world.add_material(Material {
        exponent: 2.0,
        ..Material::MATTE_WHITE
    });
    assert_eq!(method(&world, 4), samples(6));
    assert_eq!(method(&world, 5), integrated);
}

#[derive(Debug)]
struct Sideways;

impl Motion for Sideways {
    fn pose(&self, time: f64) -> Option<Pose> {
        let angle = Angle::ZERO;
        Some(Pose {
            camera: Camera::free(time * DVec3::X, angle, angle, angle),
            zoom: 1.0,
        })
    }

    fn is_smooth(&self) -> bool {
        true
    }
}

#[test]
fn motion_is_integrated_below_the_contrast() {
    let moving = Exposure::of_motion(view(100), Sideways);
    let integrated = Method::Tolerance(0.2);
    assert_eq!(
        approach_of(&world(), &moving, 0.2, false).method,
        integrated
    );
    assert_eq!(
        approach_of(&world(), &moving, 0.36, false).method,
        samples(2)
    );
}
