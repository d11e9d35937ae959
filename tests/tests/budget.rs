//! The work for expensive pixels, counted, and their claims if they end over their tolerance.

use std::ops::ControlFlow;
use std::path::Path;

use marbles_core::{Image, Method, Renderer, Settings, Status};
use marbles_scene::Scene;
use marbles_tests::reference::Reference;
use rayon::prelude::*;

use crate::studio::pixels;

/// Two balls, one of which casts a shadow on the other, with this material and these other fields of the scene.
fn scene(material: &str, lights: usize, lens: &str, more: &str) -> Scene {
    let lights: String = (0..lights)
        .map(|index| {
            let angle = index as f64 * 2.4 + 2.3;
            let (x, y) = (libm::cos(angle), libm::sin(angle));
            let share = 0.8 / lights as f64;
            format!("Directional(toward: ({x}, {y}, -0.7), intensity: {share}), ")
        })
        .collect();
    let text = format!(
        "(image: (width: 24, height: 24), {lens}, ambient: 0.1, lights: [{lights}],
        materials: {{ \"m\": ({material}) }},
        spheres: [(center: (0, 0, 40), radius: 9, material: \"m\"),
            (center: (5, 6, 28), radius: 3, material: \"m\")], {more})"
    );
    Scene::parse(&text, Path::new("budget.ron")).unwrap_or_else(|error| panic!("{error}"))
}

const NEAR: &str = "lens: Retina(width: 24, distance: 40), camera: Free()";
const FAR: &str = "lens: Retina(width: 24, distance: 1e12), camera: Free(position: (0, 0, -1e12))";

fn image(scene: &Scene, tolerance: f64) -> Image {
    let frame = if scene.frames().is_some() { 2 } else { 1 };
    let view = scene.view(frame).unwrap();
    let settings = Settings {
        method: Method::Tolerance(tolerance),
        alpha: false,
    };
    Renderer::new(scene.world())
        .render_with_progress(scene.exposure(&view), &settings, &|_| {
            ControlFlow::Continue(())
        })
        .unwrap()
}

fn bumps(grain: f64) -> String {
    format!("rough: (amplitude: 0.5, grain: Surface({grain:e}), seed: 1)")
}

const TURNS: &str = "animation: Keyframes(frames: (1, 3), shutter: 1, keys: [
    (frame: 1, roll: -1e6, ease: Linear), (frame: 3, roll: 1e6)])";
const LEAPS: &str = "animation: Keyframes(frames: (1, 3), shutter: 1, keys: [
    (frame: 1, position: (-1e300, 0, 0), ease: Linear), (frame: 3, position: (1e300, 0, 0))])";
const GOES: &str = "animation: Keyframes(frames: (1, 3), shutter: 1, keys: [
    (frame: 1, position: (-1, 0, 0), ease: Linear), (frame: 3, position: (1, 0, 0))])";

#[test]
fn hard_pixels_cost_no_more_than_allowed() {
    let bright = |strength: &str| format!("highlight: (strength: {strength}, shininess: 40)");
    let cases = [
        (scene(&bumps(0.1), 1, NEAR, ""), 1e-5, 2800.0),
        (scene(&bumps(1e-6), 1, NEAR, ""), 1e-5, 350.0),
        (scene(&bumps(0.1), 17, NEAR, ""), 1e-5, 12_000.0),
        (scene(&bright("65537"), 1, NEAR, ""), 1e-5, 700.0),
        (scene(&bright("1e300"), 1, NEAR, ""), 1e-5, 200.0),
        (scene("exponent: 1", 1, FAR, ""), 1e-5, 250.0),
        (scene("exponent: 1", 1, NEAR, TURNS), 1e-5, 1500.0),
        (scene("exponent: 1", 1, NEAR, LEAPS), 1e-5, 100.0),
        (scene(&bumps(0.1), 1, NEAR, GOES), 1e-4, 1300.0),
    ];
    for (number, (scene, tolerance, allowed)) in cases.iter().enumerate() {
        let image = image(scene, *tolerance);
        let pixels = f64::from(image.width() * image.height());
        let samples = image.work().samples as f64 / pixels;
        assert!(samples <= *allowed, "case {number}: {samples}");
        assert!(image.summary().over_tolerance > 0, "case {number}");
    }
}

/// Compared with the tests' own integrator, with one light and with three groups of lights.
#[test]
fn confessed_pixels_are_within_what_they_claim() {
    let strong = "highlight: (strength: 65537, shininess: 40)".to_owned();
    for (material, lights) in [(bumps(0.4), 1), (bumps(0.4), 17), (strong, 1)] {
        let scene = scene(&material, lights, NEAR, "");
        let view = scene.view(1).unwrap();
        let image = image(&scene, 1e-6);
        let reference = Reference::new(scene.world(), &view);
        let over = pixels(&image)
            .filter(|&(col, row)| image.status(col, row).is_over_tolerance())
            .collect::<Vec<_>>();
        assert_eq!(image.summary().over_tolerance, over.len() as u64);
        assert!(over.len() > 10, "{material} {lights}: {}", over.len());
        let some: Vec<_> = over.iter().step_by(over.len().div_ceil(8)).collect();
        some.par_iter().for_each(|&&(col, row)| {
            let claimed = image.error(col, row);
            assert!(claimed > 1e-6);
            // Bumps make the truth dear: it is known well enough to judge the claim.
            let truth = reference.pixel_to(col, row, 0.02 * claimed);
            let off = (image.rgba(col, row)[0] - truth.value.x).abs();
            assert!(
                off <= claimed + truth.error,
                "{material} {lights} ({col}, {row}): {off:e} {claimed:e}"
            );
        });
    }
}

/// A view that turns too fast for any number of moments claims everything that may be visible: black, and white under
/// all lights.
#[test]
fn pixels_that_moments_cannot_know_claim_the_contrast() {
    for motion in [TURNS, LEAPS] {
        let scene = scene("highlight: (strength: 5, shininess: 40)", 1, NEAR, motion);
        let image = image(&scene, 1e-3);
        let most = 0.1 + 0.8 * 6.0;
        let mut over = 0;
        for (col, row) in pixels(&image) {
            let (value, claimed) = (image.rgba(col, row)[0], image.error(col, row));
            let is_over = image.status(col, row) != Status::Met;
            assert_eq!(is_over, claimed > 1e-3);
            assert!(!is_over || claimed >= value.max(most - value) - 1e-12);
            over += u64::from(is_over);
        }
        assert_eq!(image.summary().over_tolerance, over);
        assert!(over > 400, "{over}");
    }
}
