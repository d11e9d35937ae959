//! Floors of any radius: no pixel is over its tolerance, whatever the light, and an ulp moves nothing by more than it
//! should.

use std::path::Path;

use glam::DVec3;
use marbles_core::{Color, Evidence, Image, LightFalloff, PointLight, Sphere, Status, World};
use marbles_scene::Scene;
use marbles_tests::reference::Reference;

use crate::studio::{
    exact_picture, looking_forward, matte, picture, pixels, single_pixel, world_of,
};

/// Balls on and above a floor of this radius, whose top is at y = -1.5, up to the horizon and across it.
fn scene(radius: f64, light: &str, lens: &str) -> Scene {
    let middle = -(radius + 1.5);
    let text = format!(
        "(image: (width: 75, height: 50), {lens}, ambient: 0.05, background: 0.4, lights: [{light}],
        materials: {{ \"m\": (albedo: 0.7, exponent: 1), \"n\": (albedo: 0.5, exponent: 2) }},
        spheres: [(center: (0, {middle:?}, 4), radius: {radius:?}, material: \"m\"),
            (center: (2.2, 0.3, -0.4), radius: 1.3, material: \"n\"),
            (center: (-2, 0.9, 0.9), radius: 0.9, material: \"m\"),
            (center: (-5.8, -1.25, 5.5), radius: 1.5, material: \"m\"),
            (center: (1.2, -0.87, 1.8), radius: 0.633, material: \"m\"),
            (center: (13.4, 8.3, 18.8), radius: 6.4, material: \"n\"),
            (center: (2.9, 2.1, 25.9), radius: 3.6, material: \"m\"),
            (center: (-0.2, -1.4, 4.8), radius: 0.96, material: \"m\"),
            (center: (-3.5, -0.6, 6), radius: 0.6, material: \"m\")])"
    );
    Scene::parse(&text, Path::new("floor.ron")).unwrap_or_else(|error| panic!("{error}"))
}

const PINHOLE: &str = "lens: Retina(width: 2.1, distance: 0.35), camera: Free()";
const SUN: &str = "Directional(toward: (-1, 1, -1))";
const LOW_SUN: &str = "Directional(toward: (1, 1e-3, 0.2))";
const LAMP: &str = "Point(position: (-1, 7, 3), intensity: 1, reference: 1)";

fn image(scene: &Scene, tolerance: f64) -> Image {
    exact_picture(scene.world(), &scene.view(1).unwrap(), tolerance, false)
}

#[test]
fn floors_of_any_radius_are_known_under_any_light() {
    for light in [SUN, LOW_SUN, LAMP] {
        for exponent in [3, 6, 9, 12] {
            let radius = libm::pow(10.0, f64::from(exponent));
            let scene = scene(radius, light, PINHOLE);
            for tolerance in [1e-3, 1e-5] {
                let image = image(&scene, tolerance);
                let over = image.summary().over_tolerance;
                assert_eq!(over, 0, "{light} {radius:e} {tolerance:e}");
            }
        }
    }
}

/// There rounding is all that is left of differences along the edge of a shadow, which turns back where it ends.
#[test]
fn a_shadow_that_ends_at_the_horizon_is_known() {
    let path =
        Path::new(env!("CARGO_MANIFEST_DIR")).join("truth/found/shadow_that_ends_at_a_horizon.ron");
    let text = std::fs::read_to_string(&path).unwrap();
    let scene = Scene::parse(&text, &path).unwrap_or_else(|error| panic!("{error}"));
    let pixel = single_pixel(&scene.view(1).unwrap(), 96, 52);
    for tolerance in [1e-4, 1e-5, 1e-6] {
        let image = exact_picture(scene.world(), &pixel, tolerance, false);
        assert_eq!(image.status(0, 0), Status::Met, "{tolerance:e}");
    }
}

/// A level parallel lens sees all of a floor in one row of pixels: as far as a lamp lights it, in a small part of that row.
/// Balls reach into the floor there, and hang over it.
#[test]
fn horizons_of_floors_under_lamps_are_known_to_level_parallel_lenses() {
    const ROW: u32 = 8;
    for radius in [1e4, 1e6, 1e8] {
        let middle = -(radius + 0.8);
        let text = format!(
            "(image: (width: 16, height: 16), lens: Parallel(width: 32),
            camera: Free(position: (0, 0, -300)), ambient: 0.1,
            lights: [Point(position: (-5, 6, 2), intensity: 0.5, reference: 10),
                Directional(toward: (-0.4, 0.6, 0.5), intensity: 0.4)],
            materials: {{ \"m\": (albedo: 0.9, highlight: (strength: 0.4, shininess: 20)) }},
            spheres: [(center: (0.3, {middle:?}, 1), radius: {radius:?}, material: \"m\"),
                (center: (6, 2.5, -20), radius: 4, material: \"m\"),
                (center: (-9, 7, -3), radius: 2.5, material: \"m\")])"
        );
        let scene = Scene::parse(&text, Path::new("level.ron")).unwrap();
        let reference = Reference::new(scene.world(), &scene.view(1).unwrap());
        for tolerance in [1e-3, 1e-4] {
            let image = image(&scene, tolerance);
            assert_eq!(
                image.summary().over_tolerance,
                0,
                "{radius:e} {tolerance:e}"
            );
            for col in 0..16 {
                let claimed = image.error(col, ROW);
                let truth = reference.pixel_to(col, ROW, 0.1 * tolerance);
                let off = (image.rgba(col, ROW)[0] - truth.value.x).abs();
                assert!(
                    off <= claimed + truth.error,
                    "{radius:e} {tolerance:e} {col}: {off:e} {claimed:e}"
                );
            }
        }
    }
}

/// Smooth light is bounded as often on floors of any radius.
#[test]
fn claims_on_floors_of_any_radius_are_bounds_as_often() {
    let bounds = |radius| {
        let image = image(&scene(radius, SUN, PINHOLE), 1e-3);
        let is_bound = |&(col, row): &(u32, u32)| image.evidence(col, row) == Evidence::Bound;
        pixels(&image).filter(is_bound).count()
    };
    let of_moderate = bounds(1e4);
    assert!(of_moderate > 75 * 50 / 2, "{of_moderate}");
    for radius in [1e7, 1e9, 1e12] {
        let found = bounds(radius);
        assert!(
            10 * found >= 9 * of_moderate,
            "{radius:e}: {found} of {of_moderate}"
        );
    }
}

/// Compared with samples, with their own estimate of the error at edges.
#[test]
fn huge_floors_are_as_samples_see_them() {
    // An edge along the grid costs half a row.
    const DOUBT: f64 = 0.5 / 24.0;
    for light in [SUN, LOW_SUN, LAMP] {
        for (lens, radius) in [
            (PINHOLE, 1e9),
            (PINHOLE, 1e12),
            (
                "lens: Parallel(width: 24), camera: Free(position: (0, 4, -2), tilt: -15)",
                1e9,
            ),
        ] {
            let scene = scene(radius, light, lens);
            let view = scene.view(1).unwrap();
            let image = image(&scene, 1e-3);
            let samples = picture(scene.world(), &view, 24, false);
            for (col, row) in pixels(&image) {
                let off = (image.rgba(col, row)[0] - samples.rgba(col, row)[0]).abs();
                let allowed = image.error(col, row) + DOUBT;
                assert!(off <= allowed, "{light} {radius:e} ({col}, {row}): {off:e}");
            }
        }
    }
}

/// A viewpoint this high above a wall of radius 1, and balls that are cut by the wall.
fn wall(radius: f64, height: f64, seed: u32) -> World {
    let mut state = seed;
    let mut random = || {
        state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        f64::from(state >> 8) / f64::from(1 << 24)
    };
    let mut world = world_of(&[], &[DVec3::new(random() - 0.5, 0.7, -random())]);
    let material = world.add_material(matte(Color::splat(0.8)));
    let middle = DVec3::new(0.0, -1.0 - height, 0.0);
    world.add_sphere(Sphere::new(middle, radius).unwrap(), material);
    for _ in 0..4 {
        let center = DVec3::new(
            3.0 * random() - 1.5,
            0.6 * random() - 1.2,
            1.0 + 4.0 * random(),
        );
        let ball = Sphere::new(center * height, (0.4 + 0.6 * random()) * height).unwrap();
        world.add_sphere(ball, material);
    }
    if seed.is_multiple_of(2) {
        let place = DVec3::new(2.0 * random(), 2.0, random()) * height;
        let lamp = PointLight::new(place, Color::ONE, LightFalloff::None, 1.0).unwrap();
        world.lights.push(lamp.into());
    }
    world
}

/// If the radius is an ulp larger, the wall moves by an ulp. A pixel that changes by more than this explains, and by
/// more than it claims, is wrong. This check needs no reference, and finds errors that a finer picture would share.
#[test]
fn an_ulp_moves_no_pixel_beyond_its_claims() {
    const SIDE: u32 = 24;
    let view = looking_forward(SIDE, SIDE, 20.0);
    let mut seen = 0;
    for seed in 1..=12 {
        let height = libm::pow(10.0, -3.0 - f64::from(seed % 6));
        let pictures = [1.0, 1.0 + f64::EPSILON]
            .map(|radius| exact_picture(&wall(radius, height, seed), &view, 1e-6, false));
        // The wall is that much nearer, in pixels of an edge seen steeply.
        let moved = 400.0 * f64::EPSILON / height;
        let [one, other] = &pictures;
        for (col, row) in pixels(one) {
            let [a, b] = [one, other].map(|image| image.rgba(col, row)[0]);
            let claimed = one.error(col, row) + other.error(col, row);
            let off = (a - b).abs();
            assert!(
                off <= claimed + moved,
                "{seed} ({col}, {row}): {off:e} {claimed:e} {moved:e}"
            );
            seen += u32::from(a > 0.0);
        }
    }
    assert!(seen > 3000, "{seen}");
}
