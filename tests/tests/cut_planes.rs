//! Pixels along the curve in which the plane of parallel rays cuts a sphere. On one side of the curve rays show the
//! outer side of the sphere, on the other its inside.

use std::path::Path;

use marbles_scene::Scene;
use marbles_tests::reference::Reference;

use crate::studio::{exact_picture, pixels};

const SUN: &str = "Directional(toward: (-0.2, -0.5, -0.37), intensity: 0.8)";
const LAMP: &str = "Point(position: (9, 4, -11), intensity: 0.5, reference: 35)";

fn scene(width: f64, light: &str, shadows: bool, spheres: &[([f64; 3], f64)]) -> Scene {
    let spheres: String = spheres
        .iter()
        .map(|([x, y, z], radius)| {
            format!("(center: ({x:?}, {y:?}, {z:?}), radius: {radius:?}, material: \"m\"), ")
        })
        .collect();
    let text = format!(
        "(image: (width: 24, height: 24), lens: Parallel(width: {width:?}), camera: Free(), background: 0.3,
        ambient: 0.1, shadows: {shadows}, lights: [{light}],
        materials: {{ \"m\": (albedo: (0.9, 0.6, 0.3), exponent: 1) }}, spheres: [{spheres}])"
    );
    Scene::parse(&text, Path::new("cut.ron")).unwrap_or_else(|error| panic!("{error}"))
}

/// A ball that is cut by the plane, and another ball that intersects it, or stands on it.
fn scenes() -> Vec<Scene> {
    let crossing = [([-12.6, 9.0, -0.7], 15.8), ([5.0, -3.7, 8.4], 8.4)];
    let ahead = [([-5.8, 5.6, 2.6], 15.8), ([-13.0, 8.0, 8.0], 14.4)];
    // The floor's contour lies 4e-8 of a pixel above the curve.
    let floor = [([0.0, -1.7e7 - 9.0, 1.5], 1.7e7), ([3.0, -6.0, 6.0], 3.0)];
    // The curve lies 1e-5 and 1e-3 of a pixel inside of the contour, behind the plane and before it.
    let behind = [([-7.0, 9.0, -0.04], 15.8), ([5.0, -3.7, 7.4], 8.4)];
    let before = [([-7.0, 9.0, 0.4], 15.8), ([5.0, -3.7, 7.4], 8.4)];
    let mut scenes = Vec::new();
    for light in [SUN, LAMP] {
        for shadows in [true, false] {
            scenes.push(scene(80.0, light, shadows, &crossing));
            scenes.push(scene(60.0, light, shadows, &ahead));
            scenes.push(scene(40.0, light, shadows, &floor));
            scenes.push(scene(80.0, light, shadows, &behind));
            scenes.push(scene(80.0, light, shadows, &before));
        }
    }
    scenes
}

#[test]
fn pixels_along_a_cut_meet_their_tolerance() {
    for (number, scene) in scenes().iter().enumerate() {
        let view = scene.view(1).unwrap();
        let reference = Reference::new(scene.world(), &view);
        for tolerance in [1e-2, 1e-5] {
            let image = exact_picture(scene.world(), &view, tolerance, false);
            assert_eq!(image.summary().over_tolerance, 0, "{number} {tolerance:e}");
            for (col, row) in pixels(&image).step_by(7) {
                let claimed = image.error(col, row);
                let truth = reference.pixel_to(col, row, 0.1 * tolerance);
                let background = 0.3 * (1.0 - truth.value.w);
                let off = (image.rgba(col, row)[0] - truth.value.x - background).abs();
                assert!(
                    off <= claimed + truth.error,
                    "{number} {tolerance:e} ({col}, {row}): {off:e} {claimed:e} {:e}",
                    truth.error
                );
            }
        }
    }
}
