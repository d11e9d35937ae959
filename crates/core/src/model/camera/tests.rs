//! Cameras look where they are told to.

use super::*;

fn turned(pan: f64, tilt: f64, roll: f64) -> Camera {
    let angle = Angle::from_degrees;
    Camera::free(DVec3::ZERO, angle(pan), angle(tilt), angle(roll))
}

#[test]
fn quarter_turns_go_where_the_conventions_say() {
    assert_eq!(turned(90.0, 0.0, 0.0).forward(), DVec3::X);
    assert_eq!(turned(0.0, 90.0, 0.0).forward(), DVec3::Y);
    // Clockwise from behind: the camera's up goes to the right.
    assert_eq!(
        turned(0.0, 0.0, 90.0).world_from_camera * DVec3::Y,
        DVec3::X
    );
}

#[test]
fn pan_then_tilt_reaches_the_spherical_direction() {
    let forward = turned(30.0, 60.0, 77.0).forward();
    let expected = DVec3::new(0.25, 0.75_f64.sqrt(), 0.5 * 0.75_f64.sqrt());
    assert!((forward - expected).length() < 1e-15);
}

#[test]
fn orientations_are_rotations() {
    for step in 0..100 {
        let angle = 37.3 * f64::from(step);
        let matrix = turned(angle, 1.7 * angle, -0.6 * angle).world_from_camera;
        assert!((matrix.determinant() - 1.0).abs() < 1e-14);
        assert!((matrix * matrix.transpose()).abs_diff_eq(DMat3::IDENTITY, 1e-15));
    }
}

#[test]
fn looks_straight_up_with_pan_zero() {
    let up = Camera::look_at(DVec3::ZERO, DVec3::new(0.0, 1e-300, 0.0), Angle::ZERO).unwrap();
    assert_eq!(
        up.world_from_camera,
        turned(0.0, 90.0, 0.0).world_from_camera
    );
    let down = Camera::look_at(DVec3::ONE, DVec3::new(1.0, -7.0, 1.0), Angle::ZERO).unwrap();
    assert_eq!(
        down.world_from_camera,
        turned(0.0, -90.0, 0.0).world_from_camera
    );
}

#[test]
fn looking_nowhere_is_no_camera() {
    let far = DVec3::splat(f64::MAX);
    for (position, target) in [
        (DVec3::ONE, DVec3::ONE),
        (far, -far),
        (DVec3::ZERO, DVec3::NAN),
    ] {
        let refused = Camera::look_at(position, target, Angle::ZERO);
        assert!(matches!(refused, Err(CameraError::Target { .. })));
    }
}

#[test]
fn orbit_stands_behind_and_above_its_target() {
    let target = DVec3::new(1.0, 2.0, 3.0);
    let angle = Angle::from_degrees;
    let camera = Camera::orbit(target, 10.0, angle(90.0), angle(30.0), Angle::ZERO);
    let expected = target + DVec3::new(-10.0 * 0.75_f64.sqrt(), 5.0, 0.0);
    assert!((camera.position - expected).length() < 1e-14);
    let looking = Camera::look_at(camera.position, target, Angle::ZERO).unwrap();
    assert!(
        looking
            .world_from_camera
            .abs_diff_eq(camera.world_from_camera, 1e-15)
    );
}

#[test]
fn field_of_view_is_the_angle_across_the_retina() {
    let lens = |degrees| Lens::from_field_of_view(Angle::from_degrees(degrees));
    let right_angle = lens(90.0).unwrap();
    assert!((right_angle.width - 2.0).abs() < 1e-15);
    for degrees in [1e-3, 40.0, 120.0, 179.0] {
        let lens = lens(degrees).unwrap();
        let width = 2.0 * libm::tan(0.5 * f64::to_radians(degrees));
        assert!((lens.width / width - 1.0).abs() < 1e-13, "{degrees}");
    }
}

#[test]
fn a_field_of_view_is_between_0_and_180_degrees() {
    for (degrees, found) in [
        (0.0, 0.0),
        (180.0, 180.0),
        (200.0, 200.0),
        (-40.0, 320.0),
        (360.0, 0.0),
    ] {
        match Lens::from_field_of_view(Angle::from_degrees(degrees)) {
            Err(CameraError::FieldOfView(told)) => assert!((told - found).abs() < 1e-12),
            other => panic!("{degrees}: {other:?}"),
        }
    }
    assert!(Lens::from_field_of_view(Angle::from_degrees(f64::NAN)).is_err());
    assert!(Lens::from_field_of_view(Angle::from_degrees(400.0)).is_ok());
}

/// The middle of a turned picture is where the axis of view, to 60 digits, comes nearest to the world's origin.
#[test]
fn a_point_on_the_axis_is_known_however_far_the_viewpoint_is() {
    let angle = Angle::from_degrees;
    let position = DVec3::new(-508464342596.1034, 358367949545.8003, -782966426513.0144);
    let camera = Camera::free(position, angle(33.0), angle(-21.0), Angle::ZERO);
    let expected = DVec3::new(-20.111860645919705, 14.851141078553571, -31.229516609603195);
    let along = expected.dot(camera.forward());
    assert!((camera.on_axis_at(along) - expected).length() < 1e-13);
    // One that is not on the axis does not count.
    let elsewhere = Camera {
        on_axis: DVec3::X,
        ..camera
    };
    let way = elsewhere.on_axis_at(along) - position;
    assert!(way.cross(camera.forward()).length() < 1e-3);
}

#[test]
fn pan_tilt_and_roll_make_the_same_camera() {
    let near = |one: f64, other: f64| {
        // A turn more is the same.
        let apart = (one - other).rem_euclid(360.0);
        apart.min(360.0 - apart) < 1e-12
    };
    for pan in [-170.0, -90.0, 0.0, 12.5, 180.0] {
        for tilt in [-89.0, -30.0, 0.0, 75.0] {
            for roll in [-180.0, -95.0, 0.0, 10.0, 180.0] {
                let angles = [pan, tilt, roll].map(Angle::from_degrees);
                let [pan_angle, tilt_angle, roll_angle] = angles;
                let camera = Camera::free(DVec3::ONE, pan_angle, tilt_angle, roll_angle);
                let found = camera.pan_tilt_roll().map(|angle| angle.degrees());
                let pairs = found.into_iter().zip([pan, tilt, roll]);
                assert!(
                    pairs.into_iter().all(|(one, other)| near(one, other)),
                    "{found:?} {pan} {tilt} {roll}"
                );
            }
        }
    }
    // Upside down it looks along the same line as the other way around.
    let half = Angle::from_degrees(180.0);
    let down = Camera::free(DVec3::ZERO, Angle::ZERO, half, Angle::ZERO);
    let [pan, tilt, roll] = down.pan_tilt_roll().map(|angle| angle.degrees().abs());
    assert!(near(pan, 180.0) && near(tilt, 0.0) && near(roll, 180.0));
    // Straight up all of the turn is roll.
    let up = Camera::free(
        DVec3::ZERO,
        Angle::from_degrees(20.0),
        Angle::from_degrees(90.0),
        Angle::ZERO,
    );
    let [pan, tilt, roll] = up.pan_tilt_roll().map(|angle| angle.degrees());
    assert!(
        near(tilt, 90.0) && near(pan.abs() + roll.abs(), 20.0),
        "{pan} {roll}"
    );
}
