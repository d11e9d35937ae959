//! Tests of the judge: signs of the quadratic, and numbers known from elsewhere.

use glam::DVec3;

use super::super::families::FAMILIES;
use super::*;

fn exact(center: DVec3, radius: f64, direction: DVec3) -> Option<ExactHit> {
    let ray = Ray {
        origin: DVec3::ZERO,
        direction,
    };
    judge(&Sphere::new(center, radius).unwrap(), &ray)
}

/// The quadratic changes its sign within the enclosure, at the right root.
#[test]
fn the_quadratic_changes_its_sign_within_the_enclosure() {
    for family in FAMILIES {
        for index in 0..100 {
            let (sphere, ray) = family.case(index);
            let quadratic = Quadratic::new(&sphere, &ray);
            let by_definition =
                &quadratic.along * &quadratic.along - &quadratic.direction_sq * &quadratic.outside;
            assert_eq!(quadratic.discriminant, by_definition);
            let Some(hit) = judge(&sphere, &ray) else {
                continue;
            };
            assert!(hit.distance.bits() as i64 >= DIGITS);
            // Half the derivative and the value, at x · 2^exponent in the solutions' unit.
            let exponent = hit.exponent - quadratic.unit;
            let (up, down) = (exponent.max(0), (-exponent).max(0));
            let slope =
                |x: &BigInt| &quadratic.direction_sq * (x << up) - (&quadratic.along << down);
            let value = |x: &BigInt| {
                let linear = (slope(x) - (&quadratic.along << down)) * (x << up);
                linear + (&quadratic.outside << (2 * down))
            };
            let (low, high) = (hit.distance.clone(), &hit.distance + BigInt::from(2));
            let zero = BigInt::ZERO;
            if hit.inner_side {
                assert!(value(&low) <= zero && value(&high) >= zero);
                assert!(slope(&high) >= zero);
            } else {
                assert!(value(&low) >= zero && slope(&low) <= zero);
                assert!(value(&high) <= zero || slope(&high) >= zero);
            }
            // The normal is unit, within what was cut from its components.
            let off = dot(&hit.normal, &hit.normal) - (BigInt::from(1) << (2 * DIGITS));
            assert!(off.bits() as i64 <= DIGITS + 4, "{}", family.name);
        }
    }
}

#[test]
fn distances_are_scored_in_units_of_the_last_place() {
    let near = |direction| exact(DVec3::Z * 5.0, 1.0, direction).unwrap();
    let four = near(DVec3::Z);
    let close = |score: f64, expected: f64| assert!((score - expected).abs() < 1e-15, "{score}");
    close(four.ulps(4.0), 0.0);
    close(four.ulps(4.0_f64.next_up()), 1.0);
    close(four.ulps(4.0_f64.next_down()), 0.5);
    assert_eq!(four.ulps(-4.0), f64::INFINITY);
    assert_eq!(four.ulps(f64::NAN), f64::INFINITY);
    // 4/3 lies a third of a unit from the double nearest to it.
    let third = near(DVec3::Z * 3.0);
    close(third.ulps(4.0 / 3.0), 1.0 / 3.0);
    // 2¹⁰²⁷ overflows, and 2¹⁰²⁴ − 2⁹⁷¹ does not.
    let beyond = near(DVec3::Z * 2.0_f64.powi(-1025));
    assert_eq!(beyond.ulps(f64::INFINITY), 0.0);
    assert!(beyond.ulps(f64::MAX) > 1e10);
    let largest = exact(DVec3::Z * f64::MAX, 1e-300, DVec3::Z).unwrap();
    close(largest.ulps(f64::MAX), 0.0);
    close(largest.ulps(f64::INFINITY), 1.0);
    // A quarter of the smallest double.
    let tiny = exact(DVec3::Z * 5.0 * 2.0_f64.powi(-1000), 2.0_f64.powi(-1000), {
        DVec3::Z * 2.0_f64.powi(78)
    });
    let tiny = tiny.unwrap();
    close(tiny.ulps(0.0), 0.25);
    close(tiny.ulps(f64::from_bits(1)), 0.75);
}

#[test]
fn normals_are_scored_as_angles() {
    let up = exact(DVec3::new(0.0, -1.0, 5.0), 1.0, DVec3::Z).unwrap();
    let unit = f64::EPSILON / 2.0;
    assert_eq!(up.angle(DVec3::Y), 0.0);
    assert!((up.angle(DVec3::new(3.0 * unit, 1.0, -4.0 * unit)) - 5.0).abs() < 1e-9);
    assert!((up.angle(DVec3::X) * unit - std::f64::consts::FRAC_PI_2).abs() < 1e-9);
    assert!((up.angle(-DVec3::Y) * unit - std::f64::consts::PI).abs() < 1e-9);
    assert_eq!(up.angle(DVec3::NAN), f64::INFINITY);
    assert_eq!(up.angle(DVec3::ZERO), f64::INFINITY);
    assert!((ExactHit::excess_length(DVec3::Y * (1.0 + 4.0 * unit)) - 4.0).abs() < 1e-9);
}

#[test]
fn tangents_count_and_the_origin_does_not() {
    assert!(exact(DVec3::new(0.0, 1.0, 5.0), 1.0, DVec3::Z).is_some());
    assert!(exact(DVec3::new(0.0, 1.0_f64.next_up(), 5.0), 1.0, DVec3::Z).is_none());
    assert!(exact(DVec3::new(0.0, 0.0, 1.0), 1.0, -DVec3::Z).is_none());
    assert!(exact(DVec3::new(0.0, 0.0, 1.0), 1.0, DVec3::X).is_none());
    let across = exact(DVec3::new(0.0, 0.0, 1.0), 1.0, DVec3::Z).unwrap();
    assert!(across.inner_side && across.ulps(2.0) < 1e-15);
    assert!(exact(DVec3::Z, 1.0, DVec3::ZERO).is_none());
}
