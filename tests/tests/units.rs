//! Light has no unit: if all light and the tolerance are multiplied by a power of two, each number is multiplied by it,
//! bit for bit, and the cost is the same.

use std::ops::ControlFlow;
use std::path::Path;

use marbles_core::{Image, Method, Renderer, Settings};
use marbles_scene::Scene;

use crate::studio::pixels;

/// Balls with this material, lens, lights and more; all light is multiplied by a factor.
fn scene([material, lens, lights, more]: [&str; 4], factor: f64) -> Scene {
    let bright = |share: f64| format!("{:e}", share * factor);
    let lights = lights
        .replace("BRIGHT", &bright(0.8125))
        .replace("DIM", &bright(0.25));
    let [ambient, background, outline] = [0.0625, 0.375, 0.5].map(bright);
    let material = material.replace("OUTLINE", &outline);
    let text = format!(
        "(image: (width: 20, height: 16), {lens}, ambient: {ambient}, background: {background}, lights: [{lights}],
        materials: {{ \"m\": ({material}) }},
        spheres: [(center: (0, 0, 40), radius: 8, material: \"m\"), (center: (5, 6, 28), radius: 3, material: \"m\"),
            (center: (-6, -2, 36), radius: 5), (center: (0, -1009, 40), radius: 1000, material: \"m\")], {more})"
    );
    Scene::parse(&text, Path::new("units.ron")).unwrap_or_else(|error| panic!("{error}"))
}

fn image(scene: &Scene, tolerance: f64, alpha: bool) -> Image {
    let view = scene.view(1).unwrap();
    let settings = Settings {
        method: Method::Tolerance(tolerance),
        alpha,
    };
    let go_on = |_| ControlFlow::Continue(());
    Renderer::new(scene.world())
        .render_with_progress(scene.exposure(&view), &settings, &go_on)
        .unwrap()
}

const PINHOLE: &str = "lens: Retina(width: 20, distance: 40), camera: Free()";
const PARALLEL: &str = "lens: Parallel(width: 24), camera: Free()";
const SUNS: &str = "Directional(toward: (-1, 1, -1), intensity: BRIGHT), Directional(toward: (2, 1, -1), intensity: DIM)";
const LAMP: &str = "Point(position: (-9, 9, 25), intensity: BRIGHT, reference: 20)";
const SHINY: &str = "exponent: 2, highlight: (strength: 0.5, shininess: 30)";
const BUMPS: &str = "exponent: 1, rough: (amplitude: 0.4, grain: Surface(2), seed: 1)";
const LINES: &str = "exponent: 1, outline: (width: 1.5, color: OUTLINE)";
const MOVES: &str = "animation: Keyframes(frames: (1, 3), shutter: 1, keys: [
    (frame: 1, position: (-1, 0, 0), ease: Linear), (frame: 3, position: (1, 0, 0))])";

#[test]
fn light_has_no_unit() {
    let bodies = [
        [SHINY, PINHOLE, SUNS, ""],
        [SHINY, PARALLEL, SUNS, ""],
        [SHINY, PINHOLE, LAMP, ""],
        [BUMPS, PINHOLE, SUNS, ""],
        [BUMPS, PARALLEL, LAMP, ""],
        [LINES, PINHOLE, SUNS, ""],
        [SHINY, PINHOLE, SUNS, MOVES],
    ];
    for body in bodies {
        for (tolerance, alpha) in [(1e-2, false), (1e-3, true), (1e-5, false)] {
            let tolerance = if body[3].is_empty() { tolerance } else { 1e-2 };
            let expected = image(&scene(body, 1.0), tolerance, alpha);
            for exponent in [-40, -7, 1, 6, 40] {
                let factor = libm::scalbn(1.0, exponent);
                let found = image(&scene(body, factor), tolerance * factor, alpha);
                let place = format!("{body:?} at {tolerance:e}, 2^{exponent}");
                assert_eq!(found.work(), expected.work(), "{place}");
                for (col, row) in pixels(&found) {
                    let [r, g, b, coverage] = expected.rgba(col, row);
                    let times = [r * factor, g * factor, b * factor, coverage];
                    assert_eq!(found.rgba(col, row), times, "{place} ({col}, {row})");
                    let claimed = expected.error(col, row) * factor;
                    assert_eq!(found.error(col, row), claimed, "{place} ({col}, {row})");
                }
            }
        }
    }
}
