//! Parallel rays make the same picture, however far away they begin.

use std::path::Path;

use marbles_core::Image;
use marbles_scene::Scene;

use crate::studio::{exact_picture, pixels};

/// Balls that cast shadows on each other, under a sun and a lamp.
fn image(camera: &str) -> Image {
    let text = format!(
        "(image: (width: 30, height: 20), lens: Parallel(width: 9), camera: {camera}, background: 0.1, ambient: 0.1,
        lights: [Directional(toward: (-1, 1.5, -1)), Point(position: (1, 3, -2), intensity: 0.6, reference: 3)],
        materials: {{ \"shiny\": (highlight: (strength: 0.4, shininess: 30)),
            \"rough\": (rough: (amplitude: 0.4, grain: Surface(0.7), seed: 1)) }},
        spheres: [(center: (0.3, 0.2, 0.1), radius: 1.2, material: \"shiny\"),
            (center: (-2, 0.5, 1), radius: 1, material: \"rough\"), (center: (1.7, -0.3, -0.8), radius: 0.7),
            (center: (0.2, -31, 0), radius: 30)])"
    );
    let scene = Scene::parse(&text, Path::new("far.ron")).unwrap_or_else(|error| panic!("{error}"));
    exact_picture(scene.world(), &scene.view(1).unwrap(), 1e-5, false)
}

/// A camera within a few diameters of the balls, and distant cameras on the same axis.
struct Axis {
    near: String,
    far: Vec<String>,
}

fn axes() -> [Axis; 3] {
    // Places whose axes are exact.
    let look_at = |away: f64| {
        let position = (0.25 - 3.0 * away, 0.5 + 4.0 * away, 0.125 - 12.0 * away);
        format!("LookAt(position: {position:?}, target: (0.25, 0.5, 0.125), roll: 12)")
    };
    let orbit = |radius: f64| {
        format!("Orbit(target: (0.25, 0.5, 0.125), radius: {radius:?}, azimuth: 33, elevation: 21)")
    };
    let free = |position: [f64; 3]| {
        let [x, y, z] = position;
        format!("Free(position: ({x:?}, {y:?}, {z:?}), pan: 33, tilt: -21)")
    };
    let far = [1e3, 1e6, 1e9, 1e12];
    [
        Axis {
            near: look_at(8.0),
            far: far.map(look_at).to_vec(),
        },
        Axis {
            near: orbit(50.0),
            far: far.map(orbit).to_vec(),
        },
        // Both are on one axis: computed with 60 digits.
        Axis {
            near: free([-20.111860645919705, 14.851141078553571, -31.229516609603195]),
            far: vec![free([
                -508464342596.1034,
                358367949545.8003,
                -782966426513.0144,
            ])],
        },
    ]
}

#[test]
fn parallel_cameras_far_away_see_what_near_ones_see() {
    for Axis { near, far } in axes() {
        let near_image = image(&near);
        let largest = |image: &Image| {
            let claims = pixels(image).map(|(col, row)| image.error(col, row));
            claims.fold(0.0, f64::max)
        };
        for camera in far {
            let far_image = image(&camera);
            for (col, row) in pixels(&far_image) {
                let [far, near] = [&far_image, &near_image].map(|it| it.rgba(col, row));
                let off = (0..3).map(|channel| (far[channel] - near[channel]).abs());
                let off = off.fold(0.0, f64::max);
                let claimed = far_image.error(col, row) + near_image.error(col, row);
                assert!(
                    off <= claimed,
                    "{camera}, column {col}, row {row}: {off:e}, {claimed:e}"
                );
            }
            assert!(
                largest(&far_image) <= 10.0 * largest(&near_image),
                "{camera}"
            );
        }
    }
}
