use fearless_simd::{Level, dispatch};

use super::super::by_points::by_points;
use super::*;
use crate::numeric::lanes::f64x8;

/// The share of a box inside of a disc.
fn truth([x, y]: [f64; 2], radius: f64) -> f64 {
    let [area, ..] = by_points(|u, v| (u - x).powi(2) + (v - y).powi(2) < radius * radius);
    area
}

/// The share and its doubt, by the formula.
fn found(middle: [f64; 2], radius: f64) -> [f64; 2] {
    dispatch!(Level::new(), simd => {
        let splat = |number| f64x8::splat(simd, number);
        let [x, y] = middle;
        let bends = Bends { xx: splat(-1.0), xy: splat(0.0), yy: splat(-1.0) };
        let value = splat(radius * radius - x * x - y * y);
        let across = [splat(2.0 * x), splat(2.0 * y)];
        let part = HalfPlane::of_second_degree(simd, value, across, &bends, None);
        [part.share[2], part.doubt[2]]
    })
}

/// The sign of a constant function says all, in any unit.
#[test]
fn functions_without_a_gradient_have_one_sign() {
    for unit in [1e-9, 1.0, 1e9] {
        for value in [-2.0, -0.03, 0.03, 2.0] {
            dispatch!(Level::new(), simd => {
                let splat = |number| f64x8::splat(simd, number * unit);
                let flat = splat(0.0);
                let bends = Bends { xx: flat, xy: flat, yy: flat };
                for rest in [None, Some(splat(5.0))] {
                    let part =
                        HalfPlane::of_second_degree(simd, splat(value), [flat; 2], &bends, rest);
                    let (share, doubt) = (part.share[5], part.doubt[5]);
                    let expected = f64::from(u8::from(value > 0.0));
                    let place = format!("{value} in units of {unit}");
                    assert_eq!(share, expected, "{place}");
                    // What may differ by more than the value may have the other sign.
                    assert_eq!(doubt, f64::from(u8::from(rest.is_some())), "{place}");
                }
            });
        }
    }
}

#[test]
fn discs_fill_boxes_as_points_say() {
    for radius in [0.3, 0.45, 0.6, 1.0, 2.0, 5.0] {
        for turn in 0..24 {
            let (sine, cosine) = (0.61 * turn as f64).sin_cos();
            let distance = radius + 0.7 * (0.37 * turn as f64).sin();
            let middle = [distance * cosine, distance * sine];
            let ([share, doubt], truth) = (found(middle, radius), truth(middle, radius));
            let error = (share - truth).abs();
            // Points know the area to this.
            assert!(
                error < doubt + 5e-4,
                "{radius} {middle:?}: {share} for {truth}, claims {doubt}"
            );
        }
    }
}
