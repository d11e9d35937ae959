//! Pictures whose pixels or moments have a closed form.

use glam::{DMat3, DVec2, DVec3};
use marbles_core::{Angle, Camera, Color};

use crate::studio::{
    GREY_HALF, around_retina_point, glowing, looking_forward, picture, pixels, single_pixel,
    world_of,
};

/// The textbook quadratic: all intersections of the ray from the origin with a sphere, the nearest first. It is
/// accurate for the well-conditioned spheres of these tests, and independent of the renderer.
fn crossings(direction: DVec3, center: DVec3, radius: f64) -> Vec<f64> {
    let (a, b) = (direction.length_squared(), direction.dot(center));
    let discriminant = b * b - a * (center.length_squared() - radius * radius);
    if discriminant < 0.0 {
        return Vec::new();
    }
    vec![(b - discriminant.sqrt()) / a, (b + discriminant.sqrt()) / a]
}

/// The contour of a sphere on a flat retina: an ellipse whose long axis points toward the center of the retina.
///
/// From the tangent cone: with the center at (a, z) in the plane through the axis of view, the
/// cone meets the retina between r² and a² + z² − r² as below.
#[test]
fn contour_of_a_sphere_off_the_axis_is_the_known_ellipse() {
    let distance = 100.0;
    let (center, radius) = (DVec3::new(1.2, -0.9, 4.0), 1.3);
    let view = looking_forward(240, 200, distance);
    let world = world_of(&[(center, radius, Color::ONE)], &[]);
    let image = picture(&world, &view, 8, true);

    let off_axis = center.truncate().length();
    let (z_sq, r_sq) = (center.z * center.z, radius * radius);
    let middle = distance * off_axis * center.z / (z_sq - r_sq);
    let semi_major = distance * radius * (off_axis * off_axis + z_sq - r_sq).sqrt() / (z_sq - r_sq);
    let semi_minor = distance * radius / (z_sq - r_sq).sqrt();
    let outward = center.truncate() / off_axis;

    // Moments of the coverage: area, center, and mean squares along and across the long axis.
    let (mut area, mut first, mut along_sq, mut across_sq, mut mixed) =
        (0.0, DVec2::ZERO, 0.0, 0.0, 0.0);
    for (col, row) in pixels(&image) {
        let covered = image.rgba(col, row)[3];
        let point = view.cell_center(u64::from(col), u64::from(row), 1);
        let offset = point - outward * middle;
        let (along, across) = (offset.dot(outward), offset.perp_dot(outward));
        area += covered;
        first += covered * point;
        along_sq += covered * along * along;
        across_sq += covered * across * across;
        mixed += covered * along * across;
    }
    let close = |measured: f64, exact: f64, what: &str| {
        // Sampling a disc of about 300 cells across by a grid: about 1e-5 of its area.
        let error = (measured / exact - 1.0).abs();
        assert!(error < 1e-4, "{what}: {measured} instead of {exact}");
    };
    close(area, std::f64::consts::PI * semi_major * semi_minor, "area");
    close((first / area).dot(outward), middle, "center");
    assert!((first / area).perp_dot(outward).abs() < 1e-2);
    // Counting a pixel's coverage in its middle adds the variance of a pixel, 1/12.
    let semi_axis = |sum: f64| 2.0 * (sum / area - 1.0 / 12.0).sqrt();
    close(semi_axis(along_sq), semi_major, "long semi-axis");
    close(semi_axis(across_sq), semi_minor, "short semi-axis");

    assert!((mixed / area).abs() < 1e-2 * semi_minor);
}

/// Lit from the camera, the cosine at angle φ off the axis is cos(α − φ), where
/// sin α = d sin φ / r by the law of sines.
#[test]
fn brightness_of_a_sphere_lit_from_the_camera() {
    let (far, radius) = (400.0, 300.0);
    let view = looking_forward(150, 150, 25.0);
    let world = world_of(&[(DVec3::Z * far, radius, Color::ONE)], &[-DVec3::Z]);
    let image = picture(&world, &view, 1, false);
    let mut lit = 0;
    for (col, row) in pixels(&image) {
        let off_axis = view
            .cell_center(u64::from(col), u64::from(row), 1)
            .length()
            .atan2(25.0);
        let sine = far / radius * off_axis.sin();
        let expected = if sine > 1.0 {
            0.0
        } else {
            (sine.asin() - off_axis).cos().max(0.0)
        };
        let error = (image.rgba(col, row)[0] - expected).abs();
        // The arc sine loses digits near the rim, with the root of the distance to it.
        let allowed = 1e-14 / (1.0 - sine.min(1.0)).max(1e-12).sqrt();
        assert!(error <= allowed, "pixel ({col}, {row}) is off by {error:e}");
        lit += u32::from(expected > 0.0);
    }
    assert!(lit > 2_000);
}

#[test]
fn pixel_that_sees_only_ambient_light_is_flat() {
    let mut world = world_of(&[(DVec3::Z * 5.0, 1.0, Color::new(0.5, 1.0, 0.0))], &[]);
    world.ambient = Color::new(0.2, 0.3, 0.4);
    let image = picture(&world, &looking_forward(3, 3, 20.0), 2, false);
    assert_eq!(image.rgba(1, 1), [0.1, 0.3, 0.0, 1.0]);
}

#[test]
fn nearer_sphere_eclipses_the_farther() {
    let near = (DVec3::new(0.1, 0.0, 3.0), 0.5, Color::X);
    let far = (DVec3::new(0.0, 0.0, 9.0), 1.2, Color::Z);
    let larger = (DVec3::new(0.0, 0.0, 9.0), 2.5, Color::Z);
    let view = looking_forward(90, 90, 120.0);
    // The far one fits behind the near one, in either order of the file.
    let alone = picture(&glowing(&[near, (far.0, 1e-9, Color::Z)]), &view, 2, false);
    for balls in [[near, far], [far, near]] {
        assert_eq!(picture(&glowing(&balls), &view, 2, false), alone);
    }
    // A larger one shows around it: red inside the near contour, blue between the two.
    let image = picture(&glowing(&[larger, near]), &view, 1, false);
    let mut seen = [0; 3];
    for (col, row) in pixels(&image) {
        let direction = view
            .ray(view.cell_center(u64::from(col), u64::from(row), 1))
            .direction;
        let meets = |ball: (DVec3, f64, Color)| !crossings(direction, ball.0, ball.1).is_empty();
        let (index, expected) = match (meets(near), meets(larger)) {
            (true, _) => (0, Color::X),
            (false, true) => (1, Color::Z),
            (false, false) => (2, Color::ZERO),
        };
        seen[index] += 1;
        assert_eq!(image.rgba(col, row)[..3], expected.to_array());
    }
    assert!(seen.iter().all(|&count| count > 100), "{seen:?}");
}

/// Two intersecting spheres change places in the plane of their common circle. With K = |c|² − r², a point of sphere 1
/// is inside sphere 2 if p·(c₁ − c₂) < (K₁ − K₂) / 2.
#[test]
fn intersecting_spheres_meet_in_their_radical_plane() {
    let balls = [
        (DVec3::new(-0.8, 0.3, 6.0), 1.5, Color::X),
        (DVec3::new(0.7, -0.2, 5.5), 1.1, Color::Z),
    ];
    let view = looking_forward(120, 100, 130.0);
    let image = picture(&glowing(&balls), &view, 1, false);
    let power = |ball: (DVec3, f64, Color)| ball.0.length_squared() - ball.1 * ball.1;
    let mut seen = [0; 2];
    for (col, row) in pixels(&image) {
        let direction = view
            .ray(view.cell_center(u64::from(col), u64::from(row), 1))
            .direction;
        let meets = balls.map(|ball| crossings(direction, ball.0, ball.1).first().copied());
        let [Some(first), Some(second)] = meets else {
            continue;
        };
        let side = |t: f64| {
            direction.dot(balls[0].0 - balls[1].0) * t - 0.5 * (power(balls[0]) - power(balls[1]))
        };
        // Who is entered inside the other is hidden by it.
        let (index, expected) = if side(first) < -1e-9 {
            (1, Color::Z)
        } else if side(second) > 1e-9 {
            (0, Color::X)
        } else {
            continue;
        };
        seen[index] += 1;
        assert_eq!(
            image.rgba(col, row)[..3],
            expected.to_array(),
            "pixel ({col}, {row})"
        );
    }
    assert!(seen.iter().all(|&count| count > 200), "{seen:?}");
}

/// The shadow of a ball is a cylinder along the light. A point of the lower ball is dark if its distance from the axis
/// through the center of the upper ball is less than the radius of the upper ball.
#[test]
fn shadow_of_one_ball_on_another_is_a_cylinder() {
    let toward = DVec3::new(0.3, 1.0, -0.4).normalize();
    let lower = (DVec3::new(0.0, -1.0, 10.0), 2.0, Color::ONE);
    let upper = (
        lower.0 + 5.0 * toward + DVec3::new(0.4, 0.0, 0.0),
        0.7,
        Color::ONE,
    );
    let view = looking_forward(150, 150, 300.0);
    let world = world_of(&[lower, upper], &[toward]);
    let image = picture(&world, &view, 1, false);
    let (mut dark, mut lit) = (0, 0);
    for (col, row) in pixels(&image) {
        let direction = view
            .ray(view.cell_center(u64::from(col), u64::from(row), 1))
            .direction;
        let Some(&t) = crossings(direction, lower.0, lower.1).first() else {
            continue;
        };
        if !crossings(direction, upper.0, upper.1).is_empty() {
            continue;
        }
        let point = direction * t;
        let facing = (point - lower.0).dot(toward) / lower.1;
        let from_axis = (point - upper.0).reject_from_normalized(toward).length();
        if facing < 1e-9 || (from_axis - upper.1).abs() < 1e-9 {
            continue;
        }
        let shadowed = from_axis < upper.1;
        let expected = if shadowed { 0.0 } else { facing };
        assert!(
            (image.rgba(col, row)[0] - expected).abs() < 1e-12,
            "pixel ({col}, {row})"
        );
        *(if shadowed { &mut dark } else { &mut lit }) += 1;
    }
    assert!(dark > 300 && lit > 3_000, "{dark} dark, {lit} lit");
}

/// A ball behind the lit one, as seen from the light, does not block the light; with shadows off no ball does.
#[test]
fn only_what_stands_toward_the_light_makes_a_shadow() {
    let ball = (DVec3::Z * 10.0, 1.0, Color::ONE);
    let view = looking_forward(60, 60, 250.0);
    let alone = picture(&world_of(&[ball], &[DVec3::X]), &view, 2, false);
    let pair = |center| world_of(&[ball, (center, 1.5, Color::ONE)], &[DVec3::X]);
    let beside = |offset: f64| DVec3::new(offset, 0.0, 10.0);
    assert_eq!(picture(&pair(beside(-5.0)), &view, 2, false), alone);
    assert_ne!(picture(&pair(beside(5.0)), &view, 2, false), alone);
    let mut unshadowed = pair(beside(5.0));
    unshadowed.shadows = false;
    assert_eq!(picture(&unshadowed, &view, 2, false), alone);
}

/// From inside a sphere, its inner side is visible, which only the ambient light reaches.
#[test]
fn inner_side_shows_ambient_light_only() {
    let mut world = world_of(&[(DVec3::new(0.2, 0.1, 0.3), 2.0, GREY_HALF)], &[-DVec3::Z]);
    world.ambient = Color::splat(0.25);
    world.background = Color::ONE;
    let image = picture(&world, &looking_forward(20, 20, 5.0), 1, true);
    assert!(pixels(&image).all(|(col, row)| image.rgba(col, row) == [0.125, 0.125, 0.125, 1.0]));
}

/// A speck at a known position appears in the pixel that follows from pan, tilt and roll.
#[test]
fn pan_tilt_and_roll_show_known_points_where_they_belong() {
    let degrees = Angle::from_degrees;
    let half = 0.5_f64;
    let root = 0.75_f64.sqrt();
    // (pan, tilt, roll), the direction to the speck, and its retina point at distance 100.
    let cases = [
        ((30.0, 0.0, 0.0), DVec3::new(half, 0.0, root), DVec2::ZERO),
        ((0.0, 30.0, 0.0), DVec3::new(0.0, half, root), DVec2::ZERO),
        (
            (30.0, 0.0, 0.0),
            DVec3::Z,
            DVec2::new(-100.0 * half / root, 0.0),
        ),
        (
            (0.0, 30.0, 0.0),
            DVec3::Z,
            DVec2::new(0.0, -100.0 * half / root),
        ),
        // The camera leans to its right, so what is above moves to the left.
        (
            (0.0, 0.0, 90.0),
            DVec3::new(0.0, half, root),
            DVec2::new(-100.0 * half / root, 0.0),
        ),
        (
            (0.0, 0.0, 30.0),
            DVec3::new(0.0, 0.4, 1.0),
            DVec2::new(-40.0 * half, 40.0 * root),
        ),
        (
            (90.0, 0.0, 0.0),
            DVec3::new(1.0, 0.2, 0.0),
            DVec2::new(0.0, 20.0),
        ),
        (
            (90.0, 45.0, 0.0),
            DVec3::new(1.0, 1.0, -0.3),
            DVec2::new(30.0 / 2.0_f64.sqrt(), 0.0),
        ),
        (
            (180.0, 0.0, 0.0),
            DVec3::new(0.3, 0.1, -1.0),
            DVec2::new(-30.0, 10.0),
        ),
    ];
    for ((pan, tilt, roll), direction, expected) in cases {
        let mut view = looking_forward(161, 161, 100.0);
        view.camera = Camera::free(
            DVec3::new(5.0, 6.0, 7.0),
            degrees(pan),
            degrees(tilt),
            degrees(roll),
        );
        let center = view.camera.position + 50.0 * direction;
        let world = glowing(&[(center, 0.05, Color::ONE)]);
        let on_speck = picture(&world, &around_retina_point(&view, expected, 0.02), 2, true);
        assert_eq!(
            on_speck.rgba(0, 0)[3],
            1.0,
            "pan {pan}, tilt {tilt}, roll {roll}"
        );
        let image = picture(&world, &view, 4, true);
        for (col, row) in pixels(&image) {
            let from_speck = view.cell_center(u64::from(col), u64::from(row), 1) - expected;
            let covered = image.rgba(col, row)[3] > 0.0;
            assert!(!covered || from_speck.abs().max_element() < 0.5 + 0.2);
        }
    }
}

/// The rotation of the camera is Ry(pan) · Rx(tilt) · Rz(roll), compared with glam's rotations, which are for
/// right-handed axes: mirrored in z they are ours.
#[test]
fn orientation_is_pan_after_tilt_after_roll() {
    for (pan, tilt, roll) in [
        (10.0, 20.0, 30.0),
        (-100.0, 80.0, 170.0),
        (250.0, -45.0, -3.0),
    ] {
        let degrees = Angle::from_degrees;
        let ours = Camera::free(DVec3::ZERO, degrees(pan), degrees(tilt), degrees(roll));
        let mirror = DMat3::from_diagonal(DVec3::new(1.0, 1.0, -1.0));
        let (pan, tilt, roll): (f64, f64, f64) = (
            -f64::to_radians(pan),
            f64::to_radians(tilt),
            -f64::to_radians(roll),
        );
        let theirs = DMat3::from_rotation_y(pan)
            * DMat3::from_rotation_x(tilt)
            * DMat3::from_rotation_z(roll);
        let ours = ours.world_from_camera;
        assert!(ours.abs_diff_eq(mirror * theirs * mirror, 1e-15), "{ours}");
    }
}

#[test]
fn single_pixels_are_those_of_the_whole_picture() {
    let balls = [(DVec3::new(0.3, 0.2, 4.0), 1.0, Color::ONE)];
    let world = world_of(&balls, &[DVec3::new(-1.0, 2.0, -3.0)]);
    let view = looking_forward(17, 13, 20.0);
    let image = picture(&world, &view, 3, true);
    for (col, row) in pixels(&image) {
        let alone = picture(&world, &single_pixel(&view, col, row), 3, true);
        let whole = image.rgba(col, row);
        for (one, other) in alone.rgba(0, 0).into_iter().zip(whole) {
            assert!((one - other).abs() < 1e-13);
        }
    }
}
