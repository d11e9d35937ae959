//! The work for pictures, counted in samples, lines and candidates per pixel, never in time.

use std::path::PathBuf;

use glam::DVec3;
use marbles_core::{Color, Image, View, Work, World};
use marbles_scene::Scene;

use crate::studio::{exact_picture, glowing, looking_forward, picture, world_of};

/// A bound that is this many times the count is useless.
const STALE: f64 = 2.0;

/// The largest work per pixel of a picture.
struct Allowance {
    scene: &'static str,
    tolerance: f64,
    samples: f64,
    lines: f64,
    candidate_tests: f64,
}

const fn at_most(
    scene: &'static str,
    tolerance: f64,
    samples: f64,
    lines: f64,
    candidate_tests: f64,
) -> Allowance {
    Allowance {
        scene,
        tolerance,
        samples,
        lines,
        candidate_tests,
    }
}

/// About a quarter more than counted, for pictures 150 pixels wide.
const ALLOWANCES: [Allowance; 14] = [
    at_most("tests/truth/pixels/seed1", 1e-2, 0.65, 0.005, 0.22),
    at_most("tests/truth/pixels/seed1", 1e-6, 3.7, 0.62, 0.25),
    at_most("tests/truth/pixels/cloud1k", 1e-2, 13.2, 1.4, 26.0),
    at_most("tests/truth/pixels/cloud1k", 1e-4, 23.6, 5.8, 29.2),
    at_most("tests/truth/pixels/cloud1k", 1e-6, 67.0, 14.2, 29.4),
    at_most("scenes/c60", 1e-3, 11.3, 0.4, 8.7),
    at_most("scenes/c60", 1e-6, 69.1, 8.4, 10.7),
    at_most("scenes/cluster", 1e-3, 2.9, 0.05, 4.6),
    at_most("scenes/floor", 1e-3, 13.1, 0.55, 4.4),
    at_most("scenes/floor", 1e-6, 73.0, 7.0, 5.2),
    at_most(
        "scenes/original/sphere1-rough-surface",
        1e-3,
        28.9,
        0.28,
        0.24,
    ),
    at_most("scenes/turntable", 1e-2, 48.0, 0.35, 5.1),
    at_most("scenes/turntable", 1e-3, 83.0, 1.4, 5.2),
    at_most("scenes/original/cover", 1e-3, 133.0, 0.75, 1.08),
];

/// A scene, and a view of it that is 150 pixels wide.
fn load(name: &str) -> (Scene, View) {
    let root = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("..");
    let scene = Scene::load(&root.join(format!("{name}.ron"))).unwrap();
    let view = scene.view(scene.frames().map_or(1, |frames| *frames.start()));
    let view = view.unwrap();
    let width = 150;
    let height = (width * view.height).div_ceil(view.width);
    let view = View {
        width,
        height,
        ..view
    };
    (scene, view)
}

/// The work per pixel: samples, lines, candidate tests.
fn per_pixel(image: &Image) -> [f64; 3] {
    let pixels = f64::from(image.width()) * f64::from(image.height());
    let Work {
        samples,
        lines,
        candidate_tests,
        ..
    } = image.work();
    [samples, lines, candidate_tests].map(|count| count as f64 / pixels)
}

#[test]
fn pictures_cost_what_they_are_allowed() {
    let mut faults = Vec::new();
    for allowance in &ALLOWANCES {
        let (scene, view) = load(allowance.scene);
        let image = exact_picture(scene.world(), &view, allowance.tolerance, false);
        let counted = per_pixel(&image);
        let allowed = [
            allowance.samples,
            allowance.lines,
            allowance.candidate_tests,
        ];
        let is_kept = |(&counted, &allowed): (&f64, &f64)| {
            counted <= allowed && allowed <= STALE * counted + 0.01
        };
        if !counted.iter().zip(&allowed).all(is_kept) {
            faults.push(format!(
                "{} at {:e}: {counted:.2?}, allowed {allowed:.2?}",
                allowance.scene, allowance.tolerance
            ));
        }
    }
    assert!(faults.is_empty(), "\n{}", faults.join("\n"));
}

/// Between events light is smooth, so a small tolerance costs little more than a large one.
#[test]
fn small_tolerances_cost_little_more_than_large_ones() {
    let (scene, view) = load("tests/truth/pixels/cloud1k");
    // Of the size that is spoken of: smaller pictures have more edges in a pixel.
    let view = View {
        width: 600,
        height: 600,
        ..view
    };
    let cost = |tolerance: f64| {
        let [samples, lines, _] = per_pixel(&exact_picture(scene.world(), &view, tolerance, false));
        samples + lines
    };
    // At larger ones, one sample is enough for most pixels.
    let (large, small) = (cost(1e-4), cost(1e-6));
    assert!(small < 18.0, "{small}");
    assert!(small < 2.5 * large, "{small} instead of {large}");
}

/// One sample is enough if a bound shows it; otherwise one rule with five points, which estimate the error.
#[test]
fn calm_pixels_take_one_sample_or_five() {
    let world = world_of(
        &[(DVec3::Z * 400.0, 300.0, Color::ONE)],
        &[DVec3::new(0.1, 0.2, -1.0)],
    );
    for (tolerance, samples) in [(1e-3, 1), (1e-8, 5)] {
        let image = exact_picture(&world, &looking_forward(16, 8, 1000.0), tolerance, false);
        let pixels = 16 * 8;
        assert_eq!(image.work().samples, samples * pixels);
        assert_eq!(image.work().lines, 0);
        // No sphere lies higher toward the light: none is asked whether it shades the ball.
        assert_eq!(image.work().candidate_tests, pixels);
    }
}

#[test]
fn light_from_everywhere_needs_no_sample() {
    let world = glowing(&[(DVec3::Z * 400.0, 300.0, Color::ONE)]);
    let work = exact_picture(&world, &looking_forward(16, 8, 1000.0), 1e-3, false).work();
    assert_eq!((work.samples, work.lines), (0, 0));
}

#[test]
fn an_empty_picture_costs_nothing() {
    let view = looking_forward(37, 21, 30.0);
    let image = exact_picture(&World::new(), &view, 1e-6, true);
    assert_eq!(image.work(), Work::default());
}

/// Spheres beside, behind, and in one corner of the picture.
#[test]
fn pixels_far_from_any_sphere_test_no_candidates() {
    let view = looking_forward(64, 64, 64.0);
    let aside = [
        (DVec3::new(500.0, 0.0, 100.0), 100.0, Color::ONE),
        (DVec3::new(0.0, 0.0, -50.0), 30.0, Color::ONE),
    ];
    let image = exact_picture(&world_of(&aside, &[DVec3::Y]), &view, 1e-3, false);
    assert_eq!(image.work(), Work::default());
    // Pixels 0 to 7 of the first rows: no other tile is asked.
    let corner = [(DVec3::new(-28.0, 28.0, 64.0), 2.0, Color::ONE)];
    let image = exact_picture(&world_of(&corner, &[DVec3::Y]), &view, 1e-3, false);
    // Once for every pixel, and for the few with edges once more.
    assert!((64..128).contains(&image.work().candidate_tests));
}

#[test]
fn work_does_not_depend_on_threads() {
    let (scene, view) = load("scenes/c60");
    let with_threads = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads);
        pool.build().unwrap().install(|| {
            let exact = exact_picture(scene.world(), &view, 1e-3, false).work();
            let samples = picture(scene.world(), &view, 2, false).work();
            (exact, samples)
        })
    };
    let one = with_threads(1);
    assert!(one.0.lines > 0);
    assert_eq!(one, with_threads(2));
    assert_eq!(one, with_threads(7));
}
