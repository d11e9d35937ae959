//! Tolerances on scenes of every kind.

use std::path::Path;

use glam::DVec4;
use marbles_core::{Image, Status, View};
use marbles_scene::Scene;
use marbles_tests::reference::Reference;

use crate::studio::{exact_picture, picture, pixels};

fn scene(body: &str) -> Scene {
    let text = format!("(image: (width: 60, height: 40), {body})");
    Scene::parse(&text, Path::new("scene.ron")).unwrap_or_else(|error| panic!("{error}"))
}

/// Touching, nested, intersecting balls and specks, on a floor.
const BALLS: &str = "spheres: [
    (center: (0, -1001, 8), radius: 1000, material: \"m\"),
    (center: (0, 0, 8), radius: 1, material: \"m\"), (center: (2, 0, 8), radius: 1),
    (center: (0.9, 0.8, 7.3), radius: 0.6, material: \"m\"), (center: (0.2, 0.1, 7.9), radius: 0.7),
    (center: (-1.2, -0.8, 6.5), radius: 0.2), (center: (-1.5, 0.4, 6), radius: 0.004, material: \"m\"),
    (center: (-0.5, 0.9, 7.0), radius: 0.0008),
]";

/// Scenes in which no pixel is over the tolerance without a report.
fn scenes() -> Vec<Scene> {
    let lights = "lights: [Directional(toward: (-1, 1, -1), intensity: (0.9, 0.8, 0.6)),
        Directional(toward: (2, 0.6, -0.5), intensity: (0.1, 0.2, 0.5))], background: \"#203040\"";
    let look = "lens: Fov(40), camera: Free(position: (0, 0.3, 0), tilt: -2, roll: 13)";
    let material = |inside: &str| format!("materials: {{ \"m\": ({inside}) }}");
    let mut scenes = Vec::new();
    for inside in [
        "exponent: 1",
        "exponent: 0.5",
        "exponent: 3.7",
        "exponent: 20",
        "albedo: \"#d02840\", highlight: (strength: 0.7, shininess: 60)",
    ] {
        scenes.push(scene(&format!(
            "{look}, {lights}, {}, {BALLS}",
            material(inside)
        )));
    }
    let plain = material("exponent: 1");
    for view in [
        "lens: Fov(140), camera: Free(position: (0, 0.3, 3), pan: 20)",
        "lens: Fov(5), camera: Free(position: (0, 0.3, -8), pan: -1)",
        "lens: Retina(width: 2, distance: 3, shift: (0.5, -0.3)), camera: Free(), zoom: 1.4",
        // Just above the floor, inside a ball, and with a ball across the plane of the eye.
        "lens: Fov(60), camera: Free(position: (-2, -0.99, 4), pan: 20)",
        "lens: Fov(60), camera: Free(position: (2, 0, 8.1))",
        "lens: Fov(100), camera: Free(position: (1.1, 0, 7.5), pan: 30)",
    ] {
        scenes.push(scene(&format!("{view}, {lights}, {plain}, {BALLS}")));
    }
    scenes
}

#[test]
fn every_kind_of_scene_meets_its_tolerance() {
    let tolerance = 1e-3;
    let mut checked = 0;
    for (number, scene) in scenes().iter().enumerate() {
        let view = scene.view(1).unwrap();
        let reference = Reference::new(scene.world(), &view);
        let image = exact_picture(scene.world(), &view, tolerance, true);
        for (index, (col, row)) in pixels(&image).enumerate() {
            let found = image.rgba(col, row);
            assert!(found.iter().all(|value| value.is_finite()));
            let met = image.status(col, row) == Status::Met;
            assert!(
                met,
                "scene {number}, pixel ({col}, {row}) claims {:e}",
                image.error(col, row)
            );
            // Not all: the reference is slow.
            if index % 13 != number % 13 {
                continue;
            }
            checked += 1;
            let truth = reference.pixel_to(col, row, 0.02 * tolerance);
            let off = (DVec4::from_array(found) - truth.value).abs().max_element();
            assert!(
                off <= tolerance + truth.error,
                "scene {number}, pixel ({col}, {row}) is off by {off:e} ± {:e}",
                truth.error
            );
        }
    }
    assert!(checked > 1500);
}

/// Numbers too extreme for computing edges: pixels have the value of samples, and do not claim to meet the tolerance,
/// unless nothing of the sphere is visible.
#[test]
fn extreme_numbers_are_not_claimed_to_be_met() {
    for body in [
        "lens: Fov(40), camera: Free(), spheres: [(center: (0, 0, 4e200), radius: 1e200)]",
        "lens: Fov(40), camera: Free(), spheres: [(center: (0, 0, 4e-200), radius: 1e-200)]",
        "lens: Retina(width: 1e200, distance: 1e200), camera: Free(), spheres: [(center: (0, 0, 4), radius: 1)]",
        "lens: Fov(1e-11), camera: Free(), spheres: [(center: (0, 0, 1e12), radius: 0.1)]",
    ] {
        let (image, samples) = small_pictures(body);
        let mut unmet = 0;
        for (col, row) in pixels(&image) {
            if image.status(col, row) == Status::Met {
                let (found, expected) = (image.rgba(col, row), samples.rgba(col, row));
                assert_eq!(found, expected, "{body}");
            } else {
                unmet += 1;
            }
        }
        assert!(unmet > 10, "{body}: {unmet} pixels make no claim");
    }
}

/// Specks where four pixels meet, and elsewhere: a speck covers almost nothing, and no pixel shows more.
#[test]
fn specks_of_any_radius_are_nearly_dark() {
    for exponent in 3..=13 {
        let radius = libm::pow(10.0, -f64::from(exponent));
        for center in ["0, 0, 40", "0.4, 0, 40", "0.3, 0.2, 40"] {
            let scene = scene(&format!(
                "lens: Retina(width: 60, distance: 50), camera: Free(), ambient: 0.1, \
                 lights: [Directional(toward: (-1, 1, -1), intensity: 0.8)], \
                 spheres: [(center: ({center}), radius: {radius:e})]"
            ));
            let view = scene.view(1).unwrap();
            let image = exact_picture(scene.world(), &view, 1e-3, true);
            // A disc, larger than its picture by the lens, and brighter than the light allows.
            let most = 4.0 * (radius * 50.0 / 40.0).powi(2);
            for (col, row) in pixels(&image) {
                let [value, .., alpha] = image.rgba(col, row);
                let claimed = image.error(col, row);
                let off = value.abs().max(alpha.abs()) - most;
                assert!(
                    off <= claimed,
                    "{radius:e} at {center}: {value:e}, {alpha:e}, {claimed:e}"
                );
                assert!(claimed <= 1e-3, "{radius:e} at {center}: {claimed:e}");
            }
        }
    }
}

/// Relative to the viewpoint, a floor of any radius is computed as accurately as a small one.
#[test]
fn floors_of_any_radius_are_met() {
    for body in [
        "lens: Fov(40), camera: Free(tilt: -20), spheres: [(center: (0, -1e13, 0), radius: 9999999999999)]",
        "lens: Fov(40), camera: Free(tilt: 1), spheres: [(center: (0, -1e9, 0), radius: 999999999)]",
    ] {
        let (image, samples) = small_pictures(body);
        for (col, row) in pixels(&image) {
            assert_eq!(image.status(col, row), Status::Met, "{body}");
            let (found, expected) = (image.rgba(col, row), samples.rgba(col, row));
            let apart = found
                .iter()
                .zip(expected)
                .map(|(found, expected)| (found - expected).abs());
            // An edge along the grid of the samples costs half a row.
            assert!(apart.fold(0.0, f64::max) <= 1e-3 + 0.5 / 64.0, "{body}");
        }
    }
}

/// A small picture of a scene at a tolerance, and by samples.
fn small_pictures(body: &str) -> (Image, Image) {
    let scene = scene(&format!(
        "{body}, ambient: 0.5, lights: [Directional(toward: (-1, 1, -1))]"
    ));
    let view = View {
        width: 12,
        height: 8,
        ..scene.view(1).unwrap()
    };
    (
        exact_picture(scene.world(), &view, 1e-3, true),
        picture(scene.world(), &view, 64, true),
    )
}
