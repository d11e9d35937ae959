use fearless_simd::{Level, dispatch};

use super::super::by_points::by_points;
use super::*;
use crate::numeric::lanes::f64x8;

/// The share, the moments and the mean of the positive part of a linear function over a box.
fn truth(value: f64, [x, y]: [f64; 2]) -> [f64; 4] {
    let [area, along, across] = by_points(|u, v| value + x * u + y * v > 0.0);
    [area, along, across, value * area + x * along + y * across]
}

#[inline(always)]
fn formulas<S: Simd>(simd: S, value: f64, across: [f64; 2]) -> [f64; 4] {
    let splat = |number| f64x8::splat(simd, number);
    let (value, across) = (splat(value), across.map(splat));
    let part = HalfPlane::new(simd, value, across, splat(0.0));
    let [x, y] = part.moments;
    [part.share, x, y, ramp(simd, value, across)].map(|lanes| lanes[3])
}

#[test]
fn shares_are_those_of_points() {
    let cases = [
        (0.3, [1.0, 0.2]),
        (-0.3, [1.0, 0.2]),
        (0.55, [0.2, -1.0]),
        (-0.55, [-0.2, -1.0]),
        (0.1, [1.0, 1.0]),
        (-0.7, [-1.0, 0.9]),
        (0.2, [0.0, 3.0]),
        (2.0, [1.0, 1.0]),
        (-2.0, [1.0, 1.0]),
        (0.0, [1.0, -0.4]),
    ];
    for (value, across) in cases {
        let truth = truth(value, across);
        let found = dispatch!(Level::new(), simd => formulas(simd, value, across));
        for (found, truth) in found.iter().zip(truth) {
            assert!(
                (found - truth).abs() < 2e-4,
                "{value} {across:?}: {found} {truth}"
            );
        }
    }
}

#[test]
fn a_function_that_bends_is_in_doubt_where_it_may_vanish() {
    let doubt = |value: f64, bend: f64| {
        dispatch!(Level::new(), simd => {
            let splat = |number| f64x8::splat(simd, number);
            let across = [splat(1.0), splat(0.0)];
            HalfPlane::new(simd, splat(value), across, splat(bend)).doubt[0]
        })
    };
    assert_eq!(doubt(0.3, 0.0), 0.0);
    assert_eq!(doubt(0.7, 0.1), 0.0);
    assert!(doubt(0.55, 0.1) > 0.0);
    assert!((doubt(0.3, 0.03) - 0.02).abs() < 1e-6);
    assert_eq!(doubt(0.0, 1e3), 1.0);
}

#[test]
fn a_line_in_doubt_is_off_by_what_made_it_doubtful() {
    let across_corners = [
        (0.3, [1.0, 0.0]),
        (0.75, [1.0, 0.6]),
        (-0.9, [-1.0, 1.0]),
        (0.0, [0.5, -1.0]),
    ];
    for (value, across) in across_corners {
        for bend in [1e-4, 1e-2, 0.05] {
            let found = dispatch!(Level::new(), simd => {
                let splat = |number| f64x8::splat(simd, number);
                let part = HalfPlane::new(simd, splat(value), across.map(splat), splat(bend));
                part.bend(simd)[2]
            });
            assert!(
                found > 0.999 * bend && found < 1.6 * bend,
                "{value} {across:?}: {found} {bend}"
            );
        }
    }
}
