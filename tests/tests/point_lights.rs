//! The light of point lights at single points, by plain geometry.

use glam::DVec3;
use marbles_core::{Color, Light, LightFalloff, Material, PointLight, Sphere, View, World};
use marbles_tests::reference::Reference;

use crate::studio::{exact_picture, looking_forward, picture};

fn light(position: DVec3, falloff: LightFalloff, reference: f64) -> Light {
    PointLight::new(position, Color::ONE, falloff, reference)
        .unwrap()
        .into()
}

fn world(spheres: &[(DVec3, f64)], lights: &[Light]) -> World {
    let mut world = World::new();
    let white = world.add_material(Material::MATTE_WHITE);
    for &(center, radius) in spheres {
        world.add_sphere(Sphere::new(center, radius).unwrap(), white);
    }
    world.lights.extend(lights);
    world
}

/// The light along the axis of view, in the center of a picture with odd sides.
fn in_the_middle(world: &World) -> f64 {
    let image = picture(world, &looking_forward(5, 5, 100.0), 1, false);
    image.rgba(2, 2)[0]
}

const BALL: (DVec3, f64) = (DVec3::new(0.0, 0.0, 5.0), 1.0);

#[test]
fn intensity_falls_off_from_the_reference_distance() {
    for (falloff, expected) in [
        (LightFalloff::InverseSquare, (3.0_f64 / 4.0).powi(2)),
        (LightFalloff::None, 1.0),
    ] {
        let world = world(&[BALL], &[light(DVec3::ZERO, falloff, 3.0)]);
        let found = in_the_middle(&world);
        assert!((found - expected).abs() < 1e-15, "{found} {expected}");
    }
    // From the side: the point is (0, 0, 4), its normal −z.
    let place = DVec3::new(0.0, 3.0, 0.0);
    let world = world(&[BALL], &[light(place, LightFalloff::InverseSquare, 5.0)]);
    let found = in_the_middle(&world);
    assert!((found - 0.8).abs() < 1e-15, "{found}");
}

#[test]
fn only_what_lies_between_hides_a_light() {
    let place = DVec3::new(0.0, 6.0, -2.0);
    let at = |share: f64| (DVec3::new(0.0, 0.0, 4.0).lerp(place, share), 0.25);
    let lit = |spheres: &[(DVec3, f64)], shadows: bool| {
        let mut world = world(spheres, &[light(place, LightFalloff::None, 1.0)]);
        world.shadows = shadows;
        in_the_middle(&world) > 0.5
    };
    assert!(lit(&[BALL], true));
    for share in [0.1, 0.5, 0.9, 1.0] {
        assert!(!lit(&[BALL, at(share)], true), "{share}");
        assert!(lit(&[BALL, at(share)], false), "{share}");
    }
    // Beyond the light, and beside the way.
    assert!(lit(&[BALL, at(1.1)], true));
    assert!(lit(&[BALL, (DVec3::new(0.5, 3.0, 1.0), 0.45)], true));
    assert!(!lit(&[BALL, (DVec3::new(0.4, 3.0, 1.0), 0.45)], true));
}

#[test]
fn a_light_inside_a_sphere_lights_only_what_is_inside() {
    let place = DVec3::new(0.0, 1.5, 3.0);
    let lights = [light(place, LightFalloff::None, 1.0)];
    let around = (DVec3::new(0.0, 0.0, 3.0), 20.0);
    let is_lit = |spheres: &[(DVec3, f64)]| in_the_middle(&world(spheres, &lights)) > 0.1;
    // Both the viewpoint and the light are inside the large one.
    assert!(is_lit(&[BALL, around]));
    // The light alone is inside a small one, of which the ball is outside.
    assert!(!is_lit(&[BALL, (place, 0.3)]));
    assert!(!is_lit(&[BALL, around, (place, 0.3)]));
    // The viewpoint alone is inside.
    assert!(!is_lit(&[BALL, (DVec3::ZERO, 3.2)]));
    // The light is inside the ball that is seen.
    assert!(!is_lit(&[(DVec3::new(0.0, 0.0, 5.0), 4.2)]));
}

/// The largest difference between pixels at a tolerance of 1e-3 and those of the tests' own integrator, divided by
/// 1e-3.
fn worst_pixel(world: &World, view: &View) -> f64 {
    let tolerance = 1e-3;
    let reference = Reference::new(world, view);
    let image = exact_picture(world, view, tolerance, false);
    let mut worst = 0.0_f64;
    for row in (0..view.height).step_by(3) {
        for col in 0..view.width {
            let truth = reference.pixel_to(col, row, 0.02 * tolerance);
            let value = DVec3::from_slice(&image.rgba(col, row)[..3]);
            let error = (value - truth.value.truncate()).abs().max_element();
            let allowed = tolerance.max(image.error(col, row)) + truth.error;
            worst = worst.max(error / allowed);
        }
    }
    worst
}

#[test]
fn what_is_inside_a_sphere_is_lit_from_inside_alone() {
    let inside = light(DVec3::new(3.0, 4.0, 2.0), LightFalloff::InverseSquare, 8.0);
    let parallel = Light::directional(DVec3::new(-1.0, 1.0, -1.0), Color::ONE).unwrap();
    let around = (DVec3::new(0.0, 0.0, 10.0), 30.0);
    for lights in [&[inside][..], &[inside, parallel], &[parallel]] {
        let world = world(&[around, (DVec3::new(0.0, 0.0, 8.0), 2.0)], lights);
        let view = looking_forward(24, 24, 24.0);
        let lit = exact_picture(&world, &view, 1e-3, false).rgba(12, 12)[0];
        assert_eq!(lit > 0.1, lights.contains(&inside), "{lit}");
        let worst = worst_pixel(&world, &view);
        assert!(worst <= 1.0, "{worst}");
    }
}

#[test]
fn a_far_light_is_a_directional_one() {
    let toward = DVec3::new(-1.0, 1.0, -1.0).normalize();
    let far = 1e5;
    let spheres = [
        (DVec3::new(0.2, -0.1, 5.0), 1.1),
        (DVec3::new(-0.5, 0.6, 3.8), 0.4),
    ];
    let near = world(
        &spheres,
        &[light(toward * far, LightFalloff::InverseSquare, far)],
    );
    let parallel = world(&spheres, &[Light::directional(toward, Color::ONE).unwrap()]);
    let view = looking_forward(40, 40, 80.0);
    let pictures = [&near, &parallel].map(|world| exact_picture(world, &view, 1e-3, false));
    for row in 0..40 {
        for col in 0..40 {
            let [one, other] = [0, 1].map(|index: usize| pictures[index].rgba(col, row)[0]);
            assert!((one - other).abs() < 2.1e-3, "{col} {row}: {one} {other}");
        }
    }
}

#[test]
fn pixels_meet_their_tolerance() {
    let spheres = [
        (DVec3::new(0.2, -0.1, 5.0), 1.1),
        (DVec3::new(-0.5, 0.6, 3.8), 0.3),
        (DVec3::new(0.4, 0.1, 3.2), 0.2),
    ];
    let lights = [
        light(DVec3::new(-1.2, 1.5, 2.5), LightFalloff::InverseSquare, 2.0),
        light(DVec3::new(1.0, -0.5, 1.0), LightFalloff::None, 1.0),
    ];
    let world = world(&spheres, &lights);
    let view = looking_forward(24, 24, 48.0);
    let reference = Reference::new(&world, &view);
    for tolerance in [1e-2, 1e-4] {
        let image = exact_picture(&world, &view, tolerance, false);
        assert_eq!(image.summary().over_tolerance, 0);
        for row in (0..24).step_by(3) {
            for col in 0..24 {
                let truth = reference.pixel_to(col, row, 0.02 * tolerance);
                let error = (image.rgba(col, row)[0] - truth.value.x).abs();
                assert!(error < tolerance + truth.error, "{col} {row}: {error}");
            }
        }
    }
}

#[test]
fn lights_close_to_a_surface_are_met() {
    let ball = (DVec3::new(-8.9937, 3.6491, 88.7375), 9.9012);
    // In front of the ball, and so close to it that a pixel sees more than all that the light reaches.
    let places = [
        (DVec3::new(-8.7556, 2.4075, 78.7753), 0.14),
        (DVec3::new(-8.7556, 2.4075, 78.9053), 0.01),
    ];
    for (place, reference_distance) in places {
        let lights = [light(
            place,
            LightFalloff::InverseSquare,
            reference_distance,
        )];
        let world = world(&[ball], &lights);
        let view = looking_forward(32, 32, 52.46);
        let reference = Reference::new(&world, &view);
        for tolerance in [1e-3, 1e-5] {
            let image = exact_picture(&world, &view, tolerance, false);
            assert_eq!(image.summary().over_tolerance, 0);
            for (col, row) in (0..32).flat_map(|row| (0..32).map(move |col| (col, row))) {
                let truth = reference.pixel_to(col, row, 0.02 * tolerance);
                let off = (image.rgba(col, row)[0] - truth.value.x).abs() - truth.error;
                assert!(off <= tolerance, "column {col}, row {row}: {off:e}");
            }
        }
    }
}
