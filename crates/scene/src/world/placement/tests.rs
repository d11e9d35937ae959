//! Tests of `placement.rs`.

use super::*;

#[test]
fn turns_go_from_axis_to_axis() {
    let turned = |x, y, z, vector: DVec3| turn(DVec3::new(x, y, z)).unwrap() * vector;
    assert_eq!(turned(90.0, 0.0, 0.0, DVec3::Y), DVec3::Z);
    assert_eq!(turned(0.0, 90.0, 0.0, DVec3::Z), DVec3::X);
    assert_eq!(turned(0.0, 0.0, 90.0, DVec3::X), DVec3::Y);
    // First about x, then about z.
    assert_eq!(turned(90.0, 0.0, 90.0, DVec3::Y), DVec3::Z);
    assert_eq!(turned(90.0, 0.0, 90.0, DVec3::X), DVec3::Y);
    assert!(turn(DVec3::ZERO).is_none());
}

#[test]
fn placing_centers_mirrors_scales_turns_and_moves() {
    let sphere = |x, y, z, radius| Sphere::new(DVec3::new(x, y, z), radius).unwrap();
    let mut spheres = [sphere(0.0, 0.0, 0.0, 1.0), sphere(9.0, 0.0, 4.0, 2.0)];
    let placement = Placement {
        is_centered: true,
        middle: None,
        is_right_handed: None,
        up: Up::Y,
        scale: 2.0,
        turn: turn(DVec3::new(0.0, 90.0, 0.0)),
        position: DVec3::new(100.0, 0.0, 0.0),
    };
    assert!(placement.place(&mut spheres, true));
    // The box is from (-1, -2, -1) to (11, 2, 6).
    assert_eq!(spheres[0], sphere(105.0, 0.0, 10.0, 2.0));
    assert_eq!(spheres[1], sphere(97.0, 0.0, -8.0, 4.0));
    let mut tiny = [sphere(0.0, 0.0, 0.0, 1e-300)];
    let scale = 1e-300;
    assert!(!Placement { scale, ..placement }.place(&mut tiny, true));
}

/// Three axes of a table that leave no sphere at the same place, seen from the front.
#[test]
fn what_points_up_is_turned_and_never_mirrored() {
    let corners = [DVec3::X, DVec3::Y, DVec3::Z];
    let placed = |up, is_right_handed| {
        let mut spheres = corners.map(|corner| Sphere::new(corner, 0.5).unwrap());
        let placement = Placement {
            is_centered: false,
            middle: None,
            is_right_handed: None,
            up,
            scale: 1.0,
            turn: None,
            position: DVec3::ZERO,
        };
        assert!(placement.place(&mut spheres, is_right_handed));
        let [x, y, z] = spheres.map(|sphere| sphere.center());
        assert!(up != Up::X || x == DVec3::Y);
        (DMat3::from_cols(x, y, z).determinant(), z)
    };
    // A mirror image has the determinant -1, and right-handed axes look like themselves only by one.
    assert_eq!(placed(Up::Y, false), (1.0, DVec3::Z));
    assert_eq!(placed(Up::Z, false), (1.0, DVec3::Y));
    assert_eq!(placed(Up::X, false), (1.0, DVec3::Z));
    assert_eq!(placed(Up::Y, true), (-1.0, -DVec3::Z));
    assert_eq!(placed(Up::X, true), (-1.0, -DVec3::Z));
    assert_eq!(placed(Up::Z, true), (-1.0, DVec3::Y));
}

#[test]
fn the_scene_file_decides_about_hands_before_the_format_does() {
    let placement = |is_right_handed| Placement {
        is_centered: false,
        middle: None,
        is_right_handed,
        up: Up::Y,
        scale: 1.0,
        turn: None,
        position: DVec3::ZERO,
    };
    for by_default in [false, true] {
        assert_eq!(placement(None).is_right_handed(by_default), by_default);
        assert!(placement(Some(true)).is_right_handed(by_default));
        assert!(!placement(Some(false)).is_right_handed(by_default));
    }
}
