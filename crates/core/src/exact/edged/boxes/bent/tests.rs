use fearless_simd::{Level, dispatch};

use super::super::by_points::by_points;
use super::super::depth::Function;
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

/// The average of terms of the second degree over a rectangle is that of its points; and a function has the wanted share of
/// its average where the step toward it leads.
#[test]
fn averages_are_those_of_points() {
    const SIDE: usize = 200;
    for [x, y] in [[0.0, 0.0], [0.2, -0.1], [-0.35, 0.4]] {
        let [width, height] = [x, y].map(|place: f64| 1.0 - 2.0 * place.abs());
        let terms = |u: f64, v: f64| (0.3 * u - 0.2 * v) * u - 0.1 * v * v;
        let all = |u: f64, v: f64| 0.7 + 0.9 * u - 0.5 * v + terms(u, v);
        let average = |of: &dyn Fn(f64, f64) -> f64| {
            let place = |middle: f64, side: f64, step: usize| {
                middle + side * ((step as f64 + 0.5) / SIDE as f64 - 0.5)
            };
            let points = (0..SIDE * SIDE).map(|point| {
                let (column, row) = (point % SIDE, point / SIDE);
                of(place(x, width, column), place(y, height, row))
            });
            points.sum::<f64>() / (SIDE * SIDE) as f64
        };
        let [on_average, to_x, to_y] = dispatch!(Level::new(), simd => {
            let splat = |number| f64x8::splat(simd, number);
            let bends = Bends { xx: splat(0.3), xy: splat(-0.2), yy: splat(-0.1) };
            let function = Function { value: splat(0.7), across: [splat(0.9), splat(-0.5)], bends };
            let middle = [splat(x), splat(y)];
            let [to_x, to_y] = function.toward_mean(middle, 8.0 / 9.0);
            [bends.on_average(middle)[3], to_x[3], to_y[3]]
        });
        assert!((on_average - average(&terms)).abs() < 1e-5, "{x} {y}");
        let wanted = 8.0 / 9.0 * average(&all);
        let there = all(x + to_x, y + to_y);
        // The step is linear: what is left is of the second degree in it.
        let left = 0.6 * (to_x * to_x + to_y * to_y) + 1e-5;
        assert!((there - wanted).abs() < left, "{x} {y}: {there} {wanted}");
    }
}
