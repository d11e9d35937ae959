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
        is_right_handed: true,
        scale: 2.0,
        turn: turn(DVec3::new(0.0, 90.0, 0.0)),
        position: DVec3::new(100.0, 0.0, 0.0),
    };
    assert!(placement.place(&mut spheres));
    // The box is from (-1, -2, -1) to (11, 2, 6).
    assert_eq!(spheres[0], sphere(105.0, 0.0, 10.0, 2.0));
    assert_eq!(spheres[1], sphere(97.0, 0.0, -8.0, 4.0));
    let mut tiny = [sphere(0.0, 0.0, 0.0, 1e-300)];
    let scale = 1e-300;
    assert!(!Placement { scale, ..placement }.place(&mut tiny));
}
