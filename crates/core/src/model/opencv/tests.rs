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
    assert_eq!(again.focal_lengths, matrix.focal_lengths);
    assert!((again.principal_point - matrix.principal_point).length() < 1e-13);
    let centered = Intrinsics {
        focal_lengths: DVec2::splat(500.0),
        principal_point: DVec2::new(319.5, 240.0),
    };
    assert_eq!(centered.lens(640, 481).shift, DVec2::ZERO);
}

/// A camera whose focal lengths differ, and its points as OpenCV has them.
///
/// # Source
/// `cv2.projectPoints` of opencv-python-headless 5.0.0, with the rotation vector (0.3, −0.7, 0.2) and the
/// translation (−0.1, 0.1, 0.7).
#[test]
fn points_are_where_opencv_projects_them_with_two_focal_lengths() {
    const POINTS: [([f64; 3], [f64; 2]); 6] = [
        (
            [0.0, 0.0, 0.0],
            [243.488_042_857_142_83, 323.987_622_857_142_87],
        ),
        (
            [0.05, 0.0, 0.0],
            [276.386_365_816_965_3, 323.448_719_923_973_16],
        ),
        (
            [0.0, -0.05, 0.02],
            [245.578_058_865_769_66, 279.800_704_515_363],
        ),
        (
            [-0.21, 0.17, 0.4],
            [-26.931_049_101_011_98, 312.006_166_861_410_1],
        ),
        (
            [0.33, -0.29, -0.25],
            [645.186_006_836_013_3, 189.941_345_075_586],
        ),
        (
            [0.02, 0.03, 0.04],
            [235.392_199_021_533_26, 331.196_138_460_737_2],
        ),
    ];
    let intrinsics = Intrinsics {
        focal_lengths: DVec2::new(572.4114, 573.57043),
        principal_point: DVec2::new(325.2611, 242.04899),
    };
    let rotation = [
        [
            0.748_411_816_858_909_5,
            -0.279_650_507_407_814_4,
            -0.601_394_501_215_714_6,
        ],
        [
            0.080_278_739_635_629_47,
            0.938_289_690_927_657,
            -0.336_404_191_206_644_5,
        ],
        [
            0.658_357_863_436_338_8,
            0.203_489_679_358_521_2,
            0.724_677_082_600_316,
        ],
    ];
    let place = Extrinsics {
        rotation: DMat3::from_cols_array_2d(&rotation).transpose(),
        translation: DVec3::new(-0.1, 0.1, 0.7),
    };
    let lens = intrinsics.lens(640, 480);
    let view = View::new(place.camera(), lens, 640, 480);
    for (point, expected) in POINTS {
        let [x, y, z] = point;
        let found = view.project(DVec3::new(x, y, -z)).unwrap() - 0.5;
        let off = (found - DVec2::from_array(expected)).length();
        assert!(off < 1e-9, "{found} {expected:?}");
    }
    let again = Intrinsics::of(&view);
    let off = again.focal_lengths - intrinsics.focal_lengths;
    assert!(off.length() < 1e-12, "{off}");
    assert!((again.principal_point - intrinsics.principal_point).length() < 1e-12);
}
