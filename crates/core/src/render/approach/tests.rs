use super::*;
use crate::model::light::Light;
use crate::model::material::Material;
use crate::model::sphere::Sphere;
use glam::DVec3;

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

fn approach(tolerance: f64, alpha: bool) -> Approach {
    let method = Method::Tolerance(tolerance);
    let world = world();
    Approach::of(&world, &world.lights, &Settings { method, alpha })
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
fn less_than_the_contrast_is_integrated() {
    assert_eq!(approach(0.3499, false).method, Method::Tolerance(0.3499));
    // Alpha differs by 1.
    assert_eq!(approach(0.9, true).method, Method::Tolerance(0.9));
    assert_eq!(approach(1.0, true).method, samples(2));
}
