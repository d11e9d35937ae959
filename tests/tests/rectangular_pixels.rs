//! Pixels that are not square: the camera of a public set of poses, and pictures in which each pixel covers several
//! square ones.

use std::path::Path;

use glam::{DVec2, DVec3};
use marbles_core::Image;
use marbles_scene::Scene;
use marbles_tests::reference::Reference;
use rayon::prelude::*;

use crate::studio::{exact_picture, pixels};

const TOLERANCES: [f64; 5] = [1e-2, 1e-3, 1e-4, 1e-5, 1e-6];

fn parse(text: &str) -> Scene {
    Scene::parse(text, Path::new("rectangles.ron")).unwrap_or_else(|error| panic!("{error}"))
}

/// The camera of LINEMOD's pictures, whose focal lengths differ by 0.2 %, and a ball.
fn linemod() -> Scene {
    parse(
        "(
            image: (width: 640, height: 480),
            lens: Matrix(fx: 572.4114, fy: 573.57043, cx: 325.2611, cy: 242.04899),
            camera: Pose(rotation: [1, 0, 0,  0, 1, 0,  0, 0, 1], translation: (-0.1, 0.1, 0.7), axes: OpenCV),
            lights: [Directional(toward: (1, 1, 1))],
            spheres: [(center: (0, 0, 0), radius: 0.05)],
        )",
    )
}

/// # Source
/// `cv2.projectPoints` of opencv-python-headless 5.0.0, with K of the lens, the rotation vector 0 and the translation of
/// the pose.
#[test]
fn points_are_where_opencv_projects_them() {
    const POINTS: [([f64; 3], [f64; 2]); 5] = [
        (
            [0.0, 0.0, 0.0],
            [243.488_042_857_142_83, 323.987_622_857_142_87],
        ),
        (
            [0.0, -0.05, 0.02],
            [245.759_516_666_666_68, 281.880_269_861_111_1],
        ),
        (
            [-0.21, 0.17, 0.4],
            [163.945_160_000_000_02, 382.834_459_181_818_15],
        ),
        (
            [0.33, -0.29, -0.25],
            [617.826_926_666_666_6, -0.125_191_555_555_517_2],
        ),
        (
            [0.02, 0.03, 0.04],
            [263.378_786_486_486_5, 342.811_362_837_837_86],
        ),
    ];
    let view = linemod().view(1).unwrap();
    for (point, expected) in POINTS {
        // A scene's world is left-handed, and counts pixels from the corner of the first one.
        let found = view.project(DVec3::from(point) * DVec3::new(1.0, 1.0, -1.0));
        let off = found.unwrap() - 0.5 - DVec2::from(expected);
        assert!(off.length() < 1e-9, "{point:?}: {off}");
    }
}

#[test]
fn a_ball_before_a_calibrated_camera_keeps_its_tolerance() {
    /// One of so many pixels is judged.
    const STRIDE: usize = 7;
    let scene = linemod();
    let view = scene.view(1).unwrap();
    let reference = Reference::new(scene.world(), &view);
    let contour = view.contour(&scene.world().spheres()[0]).ellipse.unwrap();
    let [low, high] = contour.bounds();
    let is_near = |&(col, row): &(u32, u32)| {
        let pixel = DVec2::new(f64::from(col), f64::from(row));
        pixel.cmpge(low - 2.0).all() && pixel.cmple(high + 1.0).all()
    };
    let coarse = exact_picture(scene.world(), &view, TOLERANCES[0], false);
    let near: Vec<(u32, u32)> = pixels(&coarse).filter(is_near).step_by(STRIDE).collect();
    assert!(near.len() > 800);
    let truths: Vec<_> = near
        .par_iter()
        .map(|&(col, row)| reference.pixel(col, row))
        .collect();
    assert!(truths.iter().filter(|truth| truth.has_edge).count() > 20);
    for tolerance in TOLERANCES {
        let image = exact_picture(scene.world(), &view, tolerance, false);
        assert_eq!(image.summary().over_tolerance, 0);
        for (&(col, row), truth) in near.iter().zip(&truths) {
            let off = (image.rgba(col, row)[0] - truth.value.x).abs();
            let allowed = tolerance.min(image.error(col, row)) + truth.error + 1e-13;
            assert!(off <= allowed, "{tolerance:e} ({col}, {row}): {off:e}");
        }
    }
}

/// Balls that meet and shade each other on a floor, with bumps, a highlight and an outline, under a sun and a lamp.
fn balls(image: &str, lens: &str) -> Scene {
    parse(&format!(
        "(
            image: {image}, lens: {lens},
            camera: Free(position: (0, 1.5, -6), pan: 3, tilt: -8, roll: 5),
            background: (0.1, 0.2, 0.5), ambient: 0.05,
            lights: [
                Directional(toward: (-1, 0.6, -0.8), intensity: 0.6),
                Point(position: (2.5, 3, -2), intensity: 0.4, reference: 3),
            ],
            materials: {{
                \"shiny\": (albedo: (0.3, 0.5, 0.8), exponent: 2, highlight: (strength: 0.4, shininess: 30)),
                \"rough\": (rough: (amplitude: 0.3, grain: Surface(0.9), seed: 2)),
                \"lined\": (albedo: 0.8, outline: (width: Units(0.03), color: (1, 0.2, 0.1))),
            }},
            spheres: [
                (center: (0, -200, 0), radius: 200),
                (center: (-0.9, 0.8, 0), radius: 0.8, material: \"rough\"),
                (center: (0.3, 0.9, 0.4), radius: 0.9, material: \"shiny\"),
                (center: (1.2, 0.4, -0.8), radius: 0.4, material: \"lined\"),
                (center: (0.5, 2.2, 0.2), radius: 0.35),
            ],
        )"
    ))
}

/// Compares each pixel with the mean of the square ones that it covers: `wide` × `high` of them.
fn covers(rectangles: &Image, squares: &Image, [wide, high]: [u32; 2], tolerance: f64) {
    let mut over = 0;
    for (col, row) in pixels(rectangles) {
        let (mut mean, mut claimed) = ([0.0; 3], rectangles.error(col, row));
        over += u32::from(claimed > tolerance);
        for part in 0..wide * high {
            let (col, row) = (col * wide + part % wide, row * high + part / wide);
            let square = squares.rgba(col, row);
            for channel in 0..3 {
                mean[channel] += square[channel] / f64::from(wide * high);
            }
            claimed += squares.error(col, row) / f64::from(wide * high);
        }
        let found = rectangles.rgba(col, row);
        for channel in 0..3 {
            let off = (found[channel] - mean[channel]).abs();
            assert!(
                off <= claimed + 1e-14,
                "{tolerance:e} ({col}, {row}): {off:e}, claimed {claimed:e}"
            );
        }
    }
    let count = rectangles.width() * rectangles.height();
    assert!(
        100 * over <= count,
        "{tolerance:e}: {over} of {count} over the tolerance"
    );
}

#[test]
fn a_rectangle_has_the_mean_of_the_squares_that_it_covers() {
    let squares = "Matrix(fx: 180, fy: 180, cx: 61.3, cy: 55.7)";
    let squares = balls("(width: 120, height: 120)", squares);
    // Pixel k covers the squares from w k to w k + w − 1, whose middle is w k + (w − 1) / 2.
    for [wide, high] in [[4_u32, 1_u32], [1, 5], [3, 2]] {
        let [w, h] = [wide, high].map(f64::from);
        let lens = format!(
            "Matrix(fx: {}, fy: {}, cx: {}, cy: {})",
            180.0 / w,
            180.0 / h,
            (61.3 - 0.5 * (w - 1.0)) / w,
            (55.7 - 0.5 * (h - 1.0)) / h
        );
        let size = format!("(width: {}, height: {})", 120 / wide, 120 / high);
        let rectangles = balls(&size, &lens);
        for tolerance in [1e-2, 1e-3, 1e-4, 1e-5] {
            let [one, other] = [&rectangles, &squares].map(|scene| {
                exact_picture(scene.world(), &scene.view(1).unwrap(), tolerance, false)
            });
            covers(&one, &other, [wide, high], tolerance);
        }
    }
}
