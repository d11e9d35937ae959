//! Cameras in the form of OpenCV: `Matrix` lenses and `Pose` cameras.

use glam::{DMat3, DVec2, DVec3};
use marbles_core::View;

use super::{free, parse};
use crate::Scene;

fn scene(lens: &str, camera: &str, rest: &str) -> Scene {
    parse(&format!(
        "(image: (width: 640, height: 481), lens: {lens}, camera: {camera}, {rest})"
    ))
}

fn view(lens: &str, camera: &str) -> View {
    scene(lens, camera, "").view(1).unwrap()
}

const AHEAD: &str =
    "Pose(rotation: [1, 0, 0, 0, -1, 0, 0, 0, -1], translation: (0, 0, 0), axes: OpenCV)";

#[test]
fn a_matrix_is_a_retina_in_pixels() {
    let lens = view("Matrix(fx: 500, fy: 500, cx: 319.5, cy: 240)", AHEAD).lens;
    assert_eq!(
        (lens.width, lens.distance, lens.shift),
        (640.0, 500.0, DVec2::ZERO)
    );
    // The axis passes the center of the pixel (320, 230): half a pixel right of the middle, ten above.
    let view = view("Matrix(fx: 500, fy: 500, cx: 320, cy: 230)", AHEAD);
    assert_eq!(view.lens.shift, DVec2::new(-0.5, -10.0));
    assert_eq!(view.project(DVec3::Z), Some(DVec2::new(320.5, 230.5)));
    let seen = view.project(DVec3::new(0.2, 0.1, 2.0));
    assert_eq!(seen, Some(DVec2::new(320.5 + 50.0, 230.5 - 25.0)));
    let described = "Matrix(fx: 500, fy: 500, cx: 320, cy: 230)";
    assert_eq!(scene(described, AHEAD, "").description().lens, described);
}

/// Columns are 1/500 of the distance wide, and rows 1/200 high.
#[test]
fn pixels_of_a_matrix_may_be_rectangles() {
    let lens = "Matrix(fx: 500, fy: 200, cx: 320, cy: 230)";
    let view = view(lens, AHEAD);
    assert_eq!((view.lens.distance, view.lens.pixel_aspect), (500.0, 0.4));
    let seen = view.project(DVec3::new(0.2, 0.1, 2.0));
    assert_eq!(seen, Some(DVec2::new(320.5 + 50.0, 230.5 - 10.0)));
    assert_eq!(scene(lens, AHEAD, "").description().lens, lens);
}

#[test]
fn a_pose_leads_from_the_right_handed_world_to_the_camera() {
    let ahead = scene("Fov(90)", AHEAD, "");
    assert_eq!(
        ahead.view(7).unwrap().camera,
        free(DVec3::ZERO, 0.0, 0.0, 0.0)
    );
    assert_eq!(ahead.description().camera, "Pose");
    // The pose of a camera at (3, 1, 4) that looks along +x: its right is −z, which is Z here.
    let camera = view(
        "Fov(90)",
        "Pose(rotation: [0, 0, 1, 0, -1, 0, 1, 0, 0], translation: (4, 1, -3), axes: OpenCV)",
    )
    .camera;
    assert_eq!(camera, free(DVec3::new(3.0, 1.0, 4.0), 90.0, 0.0, 0.0));
}

#[test]
fn a_rotation_may_be_a_list_or_a_tuple_of_numbers_or_rows() {
    for rotation in [
        "(1, 0, 0, 0, -1, 0, 0, 0, -1)",
        "( (1, 0, 0), [0, -1, 0], (0, 0, -1) )",
        "[(1, 0, 0), [0, -1, 0], (0, 0, -1)]",
    ] {
        let camera = AHEAD.replace("[1, 0, 0, 0, -1, 0, 0, 0, -1]", rotation);
        assert_eq!(
            view("Fov(90)", &camera).camera,
            view("Fov(90)", AHEAD).camera,
            "{rotation}"
        );
    }
}

#[test]
fn a_rounded_rotation_is_made_orthonormal() {
    // 30 degrees about the axis of view.
    let rotation = "[0.8660254, 0.5, 0, 0.5, -0.8660254, 0, 0, 0, -1]";
    let camera = format!("Pose(rotation: {rotation}, translation: (0, 0, 0), axes: OpenCV)");
    let turned = view("Fov(90)", &camera).camera.world_from_camera;
    let error = turned - free(DVec3::ZERO, 0.0, 0.0, -30.0).world_from_camera;
    assert!(error.to_cols_array().iter().all(|entry| entry.abs() < 5e-8));
    let product = turned.transpose() * turned - DMat3::IDENTITY;
    assert!(
        product
            .to_cols_array()
            .iter()
            .all(|entry| entry.abs() < 1e-15)
    );
}

#[test]
fn keys_may_zoom_a_pose() {
    let keys = "zoom: 2, animation: Keyframes(keys: [(frame: 1, zoom: 1), (frame: 3, zoom: 5)])";
    let zoomed = scene("Matrix(fx: 500, fy: 500, cx: 300, cy: 200)", AHEAD, keys);
    let (first, last) = (zoomed.view(1).unwrap(), zoomed.view(3).unwrap());
    assert_eq!((first.zoom, last.zoom), (1.0, 5.0));
    assert_eq!(first.camera, last.camera);
    // What is on the axis stays where it is.
    assert_eq!(last.project(DVec3::Z), Some(DVec2::new(300.5, 200.5)));
    assert_eq!(
        last.project(DVec3::new(0.01, 0.0, 1.0)),
        Some(DVec2::new(325.5, 200.5))
    );
}

#[test]
fn a_pose_beyond_the_range_of_numbers_is_refused_in_its_frame() {
    let far = AHEAD.replace("(0, 0, 0)", "(0, 0, 1.7e308)");
    let far = far.replace(
        "[1, 0, 0, 0, -1, 0, 0, 0, -1]",
        "[0.6, 0, 0.8, 0, -1, 0, 0.8, 0, -0.6]",
    );
    assert!(scene("Fov(90)", &far, "").view(1).is_ok());
    let far = far.replace("(0, 0, 1.7e308)", "(1.7e308, 0, 1.7e308)");
    assert!(scene("Fov(90)", &far, "").view(1).is_err());
}

#[test]
fn a_frame_camera_frames_with_a_matrix() {
    let balls = "spheres: [(center: (0, 0, 0), radius: 1)]";
    let lens = "Matrix(fx: 500, fy: 500, cx: 200, cy: 240)";
    let view = scene(lens, "Frame(fill: 1)", balls).view(1).unwrap();
    let middle = view.project(DVec3::ZERO).unwrap();
    assert!(
        (middle - DVec2::new(320.0, 240.5)).length() < 1e-9,
        "{middle}"
    );
}

/// The contour of a ball ahead has the half axes f r / √(d² − r²), of which the longer one, in shares of the picture,
/// reaches the border: 320 columns, or 240.5 rows.
#[test]
fn a_frame_camera_knows_rectangular_pixels() {
    let balls = "spheres: [(center: (0, 0, 0), radius: 1)]";
    for ([fx, fy], half) in [([500.0, 200.0], 320.0), ([200.0, 500.0], 240.5)] {
        let lens = format!("Matrix(fx: {fx}, fy: {fy}, cx: 319.5, cy: 240)");
        let scene = scene(&lens, "Frame(fill: 1)", balls);
        let view = scene.view(1).unwrap();
        let ellipse = view.contour(&scene.world().spheres()[0]).ellipse.unwrap();
        let [long, short] = ellipse.semi_axes;
        assert!((long - half).abs() < 1e-6, "{long}");
        assert!((short / long - 0.4).abs() < 1e-12, "{short}");
    }
}
