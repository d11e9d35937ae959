//! Pixels with many overlapping spheres: correct, within the tolerance, and not too expensive.

use std::ops::ControlFlow;
use std::path::Path;

use glam::DVec3;
use marbles_core::{Image, Method, Renderer, Settings, View, VisibleArea};
use marbles_scene::Scene;
use marbles_tests::numbers::Numbers;
use marbles_tests::reference::Reference;

use crate::studio::{self, pixels};

/// Spheres of radius 2 whose centers are within a distance of the origin, under a light, in front of a camera.
fn crowd(count: usize, spread: f64, camera: &str) -> Scene {
    let mut numbers = Numbers(count as u64);
    let spheres: String = (0..count)
        .map(|index| {
            let [x, y, z] = [(); 3].map(|()| numbers.between(-spread, spread));
            let material = ["a", "b", "c"][index % 3];
            format!("(center: ({x}, {y}, {z}), radius: 2, material: \"{material}\"), ")
        })
        .collect();
    let text = format!(
        "(image: (width: 6, height: 4), {camera}, ambient: 0.1,
        lights: [Directional(toward: (-1, 2, -1.5), intensity: 0.7)],
        materials: {{ \"a\": (albedo: 0.9), \"b\": (albedo: 0.5), \"c\": (albedo: 0.2) }},
        spheres: [{spheres}])"
    );
    Scene::parse(&text, Path::new("crowd.ron")).unwrap_or_else(|error| panic!("{error}"))
}

const OUTSIDE: &str = "lens: Fov(30), camera: Orbit(target: (0, 0, 0), radius: 10, azimuth: 20)";
/// The plane in which the rays begin cuts all spheres near their outer sides.
const CUT: &str =
    "lens: Parallel(width: 2.4), camera: Orbit(target: (0, 0, 0), radius: 2, azimuth: 20)";

fn view(scene: &Scene) -> View {
    scene.view(1).unwrap()
}

fn picture(scene: &Scene, tolerance: f64) -> Image {
    let settings = Settings {
        method: Method::Tolerance(tolerance),
        alpha: false,
    };
    let go_on = |_| ControlFlow::Continue(());
    let view = view(scene);
    Renderer::new(scene.world())
        .render_with_progress(scene.exposure(&view), &settings, &go_on)
        .unwrap()
}

fn areas(scene: &Scene) -> Vec<VisibleArea> {
    let go_on = |_| ControlFlow::Continue(());
    Renderer::new(scene.world())
        .visible_areas(&view(scene), 1e-3, &go_on)
        .unwrap()
}

/// Compared with the tests' own integrator.
#[test]
fn crowds_are_within_what_they_claim() {
    for (count, spread) in [(20, 0.5), (20, 2.0)] {
        let scene = crowd(count, spread, OUTSIDE);
        let reference = Reference::new(scene.world(), &view(&scene));
        for tolerance in [1e-2, 1e-4] {
            let image = picture(&scene, tolerance);
            assert_eq!(image.summary().over_tolerance, 0, "{count} {spread}");
            for (col, row) in pixels(&image).step_by(9) {
                let truth = reference.pixel_to(col, row, 0.02 * image.error(col, row));
                let off = (image.rgba(col, row)[0] - truth.value.x).abs();
                let claimed = image.error(col, row);
                assert!(
                    off <= claimed + truth.error,
                    "{count} {spread} ({col}, {row}): {off:e} {claimed:e} {:e}",
                    truth.error
                );
            }
        }
    }
}

/// Compared with 48 × 48 samples per pixel.
#[test]
fn large_crowds_are_as_points_see_them() {
    for (count, spread) in [(150, 0.5), (1500, 0.5), (1500, 1.5)] {
        let scene = crowd(count, spread, OUTSIDE);
        let image = picture(&scene, 1e-3);
        assert_eq!(image.summary().over_tolerance, 0, "{count} {spread}");
        let points = studio::picture(scene.world(), &view(&scene), 48, false);
        for (col, row) in pixels(&image) {
            let off = (image.rgba(col, row)[0] - points.rgba(col, row)[0]).abs();
            let claimed = image.error(col, row);
            assert!(
                off <= claimed + 2e-3,
                "{count} {spread} ({col}, {row}): {off:e} {claimed:e}"
            );
        }
    }
}

/// Each part of a pixel would consider every pair of spheres, and every pair of the curves in which spheres intersect.
#[test]
fn crowds_cost_no_more_than_allowed() {
    for (count, spread, camera, allowed, is_met) in [
        (150, 0.5, OUTSIDE, [150.0, 10_000.0], true),
        (1500, 0.5, OUTSIDE, [450.0, 300_000.0], true),
        (150, 0.1, CUT, [330.0, 700_000.0], true),
    ] {
        let scene = crowd(count, spread, camera);
        let image = picture(&scene, 1e-2);
        let share = 1.0 / 24.0;
        let lines = image.work().lines as f64 * share;
        let tests = image.work().candidate_tests as f64 * share;
        let case = format!("{count} {spread}: {lines} lines, {tests} tests");
        assert!(lines <= allowed[0] && tests <= allowed[1], "{case}");
        let over = image.summary().over_tolerance;
        assert_eq!(over == 0, is_met, "{case}, {over} over");
    }
}

/// A table whose columns are mixed up or missing can put all spheres in one place.
#[test]
fn spheres_that_are_equal_cost_as_much_as_one() {
    let scene = |count: usize| {
        let equal = "(center: (0.3, 0, 0), radius: 2, material: \"b\"), ".repeat(count);
        let text = format!(
            "(image: (width: 6, height: 4), {OUTSIDE}, ambient: 0.1,
            lights: [Directional(toward: (-1, 2, -1.5), intensity: 0.7)],
            materials: {{ \"a\": (albedo: 0.9), \"b\": (albedo: 0.3) }},
            spheres: [(center: (0.3, 0, 0), radius: 2, material: \"a\"), {equal}
            (center: (-1, 1.5, -1), radius: 0.5, material: \"a\")])"
        );
        Scene::parse(&text, Path::new("equal.ron")).unwrap_or_else(|error| panic!("{error}"))
    };
    let [alone, many] = [0, 2000].map(|count| picture(&scene(count), 1e-4));
    let tests = [&alone, &many].map(|image| image.work().candidate_tests);
    assert!(tests[1] < 3 * tests[0] + 1000, "{tests:?}");
    assert_eq!(many.summary().over_tolerance, 0);
    for (col, row) in pixels(&many) {
        let off = (many.rgba(col, row)[0] - alone.rgba(col, row)[0]).abs();
        let claimed = many.error(col, row) + alone.error(col, row);
        assert!(off <= claimed, "({col}, {row}): {off:e} {claimed:e}");
    }
}

/// The first sphere that a ray hits, possibly from inside.
fn first_hit(scene: &Scene, origin: DVec3, direction: DVec3) -> Option<usize> {
    let mut nearest = (f64::INFINITY, None);
    for (index, sphere) in scene.world().spheres().iter().enumerate() {
        let to_center = sphere.center() - origin;
        let along = to_center.dot(direction);
        let aside_sq = (to_center - direction * along).length_squared();
        let half_chord = (sphere.radius() * sphere.radius() - aside_sq).sqrt();
        let hits = [along - half_chord, along + half_chord];
        // The root of a negative number is met nowhere.
        let hit = hits.into_iter().find(|&hit| hit > 0.0);
        if let Some(hit) = hit.filter(|&hit| hit < nearest.0) {
            nearest = (hit, Some(index));
        }
    }
    nearest.1
}

/// Compared with 32 × 32 samples per pixel.
#[test]
fn areas_in_crowds_are_within_what_they_claim() {
    const SIDE: u32 = 32;
    for (count, spread, camera, least_known) in [
        (150, 0.5, OUTSIDE, 22.0),
        (1000, 0.5, OUTSIDE, 22.0),
        (40, 0.1, CUT, 14.0),
    ] {
        let scene = crowd(count, spread, camera);
        let view = view(&scene);
        let found = areas(&scene);
        let mut counted = vec![0.0; count];
        for row in 0..4 * SIDE {
            for col in 0..6 * SIDE {
                let ray = view.ray(view.cell_center(u64::from(col), u64::from(row), SIDE));
                let hit = first_hit(&scene, ray.origin, ray.direction.normalize());
                if let Some(sphere) = hit {
                    counted[sphere] += f64::from(SIDE).powi(-2);
                }
            }
        }
        let mut known = 0.0;
        for (sphere, (found, counted)) in found.iter().zip(&counted).enumerate() {
            let doubt = 0.02 + 0.1 * counted.sqrt();
            let off = (found.area - counted).abs();
            assert!(
                off <= found.error + doubt,
                "{sphere} of {count}: {} {counted} {:e}",
                found.area,
                found.error
            );
            known += (found.area - found.error).max(0.0);
        }
        assert!(known >= least_known, "{count}: {known}");
    }
}
