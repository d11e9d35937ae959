//! Tests of `chord.rs`.

use fearless_simd::{Level, dispatch};

use super::*;
use crate::numeric::lanes::f64x8;

const ALONG: Linear = Linear {
    one: 1.0,
    x: 0.0,
    y: 0.0,
};

/// A circle, a parabola and a hyperbola, of which cells see a part.
fn conics() -> [Quadratic; 3] {
    let conic = |one: f64, x: f64, xx: f64, yy: f64| Quadratic {
        one,
        x,
        y: 0.1,
        xx,
        xy: 0.0,
        yy,
    };
    [
        conic(0.2, 0.3, -1.0, -1.0),
        conic(0.05, 0.6, 0.0, -0.4),
        conic(0.02, 0.7, 0.3, -0.9),
    ]
}

fn root(q: &Quadratic, x: f64, y: f64) -> f64 {
    let value = (q.xx * x + q.xy * y + q.x) * x + (q.yy * y + q.y) * y + q.one;
    value.max(0.0).sqrt()
}

/// The right end of what is seen on a line of a cell.
fn ends(q: &Quadratic, y: f64) -> Option<[f64; 2]> {
    let seen = (0..=2000).map(|step| f64::from(step) / 2000.0 - 0.5);
    let seen: Vec<f64> = seen.filter(|&x| root(q, x, y) > 0.0).collect();
    Some([*seen.first()?, *seen.last()?])
}

#[test]
fn references_lie_in_what_is_seen() {
    for q in conics() {
        let reference = Reference::new(&q, &ALONG);
        let mut lines = 0;
        for step in 0..200 {
            let y = f64::from(step) / 200.0 - 0.4975;
            let Some([left, right]) = ends(&q, y) else {
                continue;
            };
            let x = reference.start + reference.slope * y;
            assert!(left - 1e-3 <= x && x <= right + 1e-3, "{q:?} at {y}: {x}");
            lines += 1;
        }
        assert!(lines > 100, "{lines}");
    }
}

/// The root of the discriminant is smooth along chords to the very contour: few points integrate it.
#[test]
fn roots_are_smooth_along_chords() {
    const GAUSS: [(f64, f64); 4] = [
        (-0.861_136_311_594_052_6, 0.347_854_845_137_453_85),
        (-0.339_981_043_584_856_3, 0.652_145_154_862_546_1),
        (0.339_981_043_584_856_3, 0.652_145_154_862_546_1),
        (0.861_136_311_594_052_6, 0.347_854_845_137_453_85),
    ];
    for q in conics() {
        let reference = Reference::new(&q, &ALONG);
        for step in 1..40 {
            let y = f64::from(step) / 40.0 - 0.5;
            let Some([_, right]) = ends(&q, y) else {
                continue;
            };
            let found = dispatch!(Level::new(), simd => {
                let lanes = |value: f64| f64x8::splat(simd, value);
                let chord = Chord::new(simd, &q, &reference, lanes(right), lanes(y));
                let mut sum = 0.0;
                for (sigma, weight) in GAUSS {
                    let (x, slope) = chord.at(lanes(sigma));
                    sum += weight * slope[0] * root(&q, x[0], y);
                }
                sum
            });
            let start = reference.start + reference.slope * y;
            let width = (right - start) / 20_000.0;
            let middles = (0..20_000).map(|at| start + (f64::from(at) + 0.5) * width);
            let expected: f64 = middles.map(|x| root(&q, x, y) * width).sum();
            let off = (found - expected).abs();
            assert!(off < 2e-5, "{q:?} at {y}: {found} instead of {expected}");
        }
    }
}

/// Rounding may put a short chord outside of its contour: it is the same in all units of length.
#[test]
fn chords_beside_their_contour_have_no_unit() {
    let size_of_way = |unit: f64| {
        let q = Quadratic {
            one: -1e-9 * unit * unit,
            x: 8e-5 * unit * unit,
            xx: -unit * unit,
            ..Quadratic::default()
        };
        let reference = Reference {
            start: -1e-5,
            slope: 0.0,
        };
        dispatch!(Level::new(), simd => {
            let splat = |number| f64x8::splat(simd, number);
            let chord = Chord::new(simd, &q, &reference, splat(1e-5), splat(0.0));
            chord.size_of_way()[3]
        })
    };
    let expected = size_of_way(1.0);
    assert!(expected > 0.0 && expected < 1.0, "{expected}");
    for exponent in [-20, 20] {
        assert_eq!(size_of_way(libm::scalbn(1.0, exponent)), expected);
    }
}
