//! Tests of `opencv.rs`.

use super::*;
use crate::numeric::angle::Angle;

fn camera(position: DVec3, [pan, tilt, roll]: [f64; 3]) -> Camera {
    let angle = Angle::from_degrees;
    Camera::free(position, angle(pan), angle(tilt), angle(roll))
}

fn rows(matrix: DMat3) -> [[f64; 3]; 3] {
    matrix.transpose().to_cols_array_2d()
}

/// A view that nothing is special in.
fn view(camera: Camera) -> View {
    View {
        camera,
        lens: Lens {
            width: 3.0,
            distance: 2.5,
            shift: DVec2::new(0.4, -0.7),
            pixel_aspect: 1.0,
        },
        zoom: 1.7,
        width: 640,
        height: 481,
        frame: 1,
    }
}

#[test]
fn a_camera_without_angles_negates_y_and_z() {
    let place = Extrinsics::of(&camera(DVec3::new(1.0, 2.0, 3.0), [0.0; 3]));
    let expected = [[1.0, 0.0, 0.0], [0.0, -1.0, 0.0], [0.0, 0.0, -1.0]];
    assert_eq!(rows(place.rotation), expected);
    // The world's origin is 1 to the left, 2 below, 3 behind.
    assert_eq!(place.translation, DVec3::new(-1.0, 2.0, -3.0));
}

/// The rows of R are the camera's right, down and forward in the right-handed world.
#[test]
fn quarter_turns_have_their_axes() {
    for (angles, expected) in [
        // Looking along +x: right is toward the one who looked along z.
        (
            [90.0, 0.0, 0.0],
            [[0.0, 0.0, 1.0], [0.0, -1.0, 0.0], [1.0, 0.0, 0.0]],
        ),
        // Looking up: down in the picture is forward in the world.
        (
            [0.0, 90.0, 0.0],
            [[1.0, 0.0, 0.0], [0.0, 0.0, -1.0], [0.0, 1.0, 0.0]],
        ),
        // Turned clockwise as seen from behind: right in the picture is down in the world.
        (
            [0.0, 0.0, 90.0],
            [[0.0, -1.0, 0.0], [-1.0, 0.0, 0.0], [0.0, 0.0, -1.0]],
        ),
    ] {
        let place = Extrinsics::of(&camera(DVec3::ZERO, angles));
        assert_eq!(rows(place.rotation), expected, "{angles:?}");
        assert_eq!(place.rotation.determinant(), 1.0);
    }
}

#[test]
fn no_zero_is_negative() {
    let place = Extrinsics::of(&camera(DVec3::ZERO, [0.0; 3]));
    let numbers = place.rotation.to_cols_array().into_iter();
    let numbers = numbers.chain(place.translation.to_array());
    let numbers = numbers.chain(right_handed(DVec3::ZERO).to_array());
    for number in numbers.chain(place.camera().position.to_array()) {
        assert!(number != 0.0 || number.is_sign_positive());
    }
}

#[test]
fn a_panned_tilted_and_rolled_camera_projects_points_where_the_view_has_them() {
    for index in 0..200_i32 {
        // Steps that no turn is a multiple of.
        let step = f64::from(index);
        let angles = [37.7, -71.3, 111.1].map(|degrees| degrees * step);
        let view = view(camera(DVec3::new(step, 0.3 * step, -7.0), angles));
        let place = Extrinsics::of(&view.camera);
        let matrix = Intrinsics::of(&view).matrix();
        assert!((place.rotation.determinant() - 1.0).abs() < 1e-14);
        for pixel in [DVec2::new(3.25, 477.5), DVec2::new(611.0, 20.75)] {
            let half_size = DVec2::new(320.0, 240.5);
            let on_retina = (pixel - half_size) * DVec2::new(1.0, -1.0) * view.pixel_size();
            let point = view.ray(on_retina + view.lens.shift).at(11.0);
            let in_camera = place.rotation * right_handed(point) + place.translation;
            let seen = matrix * in_camera;
            // The view counts pixels from the corner of the first one, OpenCV from its center.
            let seen = (seen / seen.z).truncate() + 0.5;
            assert!((seen - pixel).length() < 1e-10, "{seen} {pixel}");
            let projected = view.project(point).unwrap();
            assert!((seen - projected).length() < 1e-10, "{seen} {projected}");
        }
        let ahead = place.direction(view.camera.forward());
        assert!((ahead - DVec3::Z).length() < 1e-14, "{ahead}");
    }
}

#[test]
fn the_matrix_has_the_closed_form_of_the_lens() {
    let view = view(camera(DVec3::ZERO, [0.0; 3]));
    let matrix = Intrinsics::of(&view).matrix();
    let per_unit = 640.0 / 3.0;
    let [cx, cy] = [319.5 - 0.4 * per_unit, 240.0 - 0.7 * per_unit];
    let expected = [
        [2.5 * 1.7 * per_unit, 0.0, cx],
        [0.0, 2.5 * 1.7 * per_unit, cy],
        [0.0, 0.0, 1.0],
    ];
    for (found, expected) in rows(matrix).iter().flatten().zip(expected.iter().flatten()) {
        assert!((found - expected).abs() < 1e-12, "{found} {expected}");
    }
}

#[test]
fn the_way_back_leads_to_the_same_camera() {
    let camera = camera(DVec3::new(12.0, -3.0, 5.0), [20.0, -50.0, 70.0]);
    let back = Extrinsics::of(&camera).camera();
    assert_eq!(back.world_from_camera, camera.world_from_camera);
    assert!((back.position - camera.position).length() < 1e-14);
    let view = view(camera);
    let matrix = Intrinsics::of(&view);
    let lens = matrix.lens(view.width, view.height);
    let again = Intrinsics::of(&View {
        lens,
        zoom: 1.0,
        ..view
    });
    assert_eq!(again.focal_length, matrix.focal_length);
    assert!((again.principal_point - matrix.principal_point).length() < 1e-13);
    let centered = Intrinsics {
        focal_length: 500.0,
        principal_point: DVec2::new(319.5, 240.0),
    };
    assert_eq!(centered.lens(640, 481).shift, DVec2::ZERO);
}
