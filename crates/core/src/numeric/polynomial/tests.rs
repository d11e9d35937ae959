//! Conics whose zeros are known, and random ones that are asked at many points.

use super::*;
use crate::edges::tests::{at, coordinate, crossings, magnitude, slope, value};
use crate::search::tests::Random;

fn any_linear(random: &mut Random) -> Linear {
    let [one, x, y] = random.point().to_array();
    Linear { one, x, y }
}

/// Terms of different magnitudes, any of which may be absent.
fn any_conic(random: &mut Random) -> Quadratic {
    let [one, x, y, xx, xy, yy] = [0; 6].map(|_| {
        let size = magnitude(random, 1e-4, 10.0);
        if random.number() < 0.1 {
            0.0
        } else {
            size * (random.number() - 0.5)
        }
    });
    Quadratic {
        one,
        x,
        y,
        xx,
        xy,
        yy,
    }
}

/// a (x − one) (x − other), whatever y.
fn with_roots(factor: f64, one: f64, other: f64) -> Quadratic {
    Quadratic {
        one: factor * one * other,
        x: -factor * (one + other),
        xx: factor,
        ..Quadratic::default()
    }
}

#[test]
fn crossings_are_zeros_that_rise_and_fall() {
    let mut random = Random(1);
    let mut checked = 0;
    for _ in 0..3000 {
        let conic = any_conic(&mut random);
        let y = [0.0; 8].map(|_| coordinate(&mut random));
        let [rising, falling] = crossings(&conic, y);
        for (places, sign) in [(rising, 1.0), (falling, -1.0)] {
            for (x, y) in places.into_iter().zip(y).filter(|(x, _)| x.abs() < 1e3) {
                let (value, terms) = value(&conic, x, y);
                // Rounding of a double root moves it by the root of it, and makes the value wrong by
                // some units of the terms.
                assert!(value.abs() <= 1e-14 * terms, "{conic:?} at ({x}, {y})");
                let slope = sign * slope(&conic, x, y);
                assert!(
                    slope * slope >= -1e-14 && slope > -1e-7,
                    "{conic:?} at ({x}, {y})"
                );
                checked += 1;
            }
        }
    }
    assert!(checked > 10_000);
}

/// Every change of sign between many points of a line has its crossing.
#[test]
fn no_change_of_sign_is_without_its_crossing() {
    let mut random = Random(2);
    let mut changes = 0;
    for _ in 0..500 {
        let conic = any_conic(&mut random);
        let y = [0.0; 8].map(|_| coordinate(&mut random));
        let places = crossings(&conic, y);
        for (lane, &y) in y.iter().enumerate() {
            for step in 0..200 {
                let [low, high] = [step, step + 1].map(|step| f64::from(step) / 200.0 - 0.5);
                let [before, after] = [low, high].map(|x| value(&conic, x, y).0);
                if (before < 0.0) == (after < 0.0) {
                    continue;
                }
                let x = places[usize::from(before > 0.0)][lane];
                assert!(
                    low - 1e-9 <= x && x <= high + 1e-9,
                    "{conic:?}, y = {y}: {x}"
                );
                changes += 1;
            }
        }
    }
    assert!(changes > 1000);
}

/// The small root of b² − 4 a c would lose all of its digits.
#[test]
fn roots_of_very_different_size_are_both_exact() {
    for (factor, one, other) in [
        (1.0, 1e-9, 1e5),
        (-3.0, 1e-9, 1e5),
        (7.0, -1e-12, 0.3),
        (-0.1, 0.25, -1e9),
    ] {
        let [rising, falling] = crossings(&with_roots(factor, one, other), [0.0; 8]);
        let (low, high) = (f64::min(one, other), f64::max(one, other));
        let expected = if factor > 0.0 {
            [high, low]
        } else {
            [low, high]
        };
        for (found, expected) in [rising[0], falling[0]].into_iter().zip(expected) {
            assert!(
                (found / expected - 1.0).abs() < 1e-14,
                "{found} for {expected}"
            );
        }
    }
}

#[test]
fn lines_are_crossed_once() {
    let mut random = Random(3);
    for step in 0..300 {
        let mut conic = any_linear(&mut random)
            * Linear {
                one: 1.0,
                ..Linear::default()
            };
        // Not quite straight, or quite.
        conic.xx = [0.0, 1e-18, -1e-18, 1e-300][step % 4];
        let y = coordinate(&mut random);
        let [rising, falling] = crossings(&conic, [y; 8]);
        let (one, other) = if conic.x > 0.0 {
            (rising[0], falling[0])
        } else {
            (falling[0], rising[0])
        };
        let expected = -(conic.one + conic.y * y) / conic.x;
        assert!(
            (one - expected).abs() <= 1e-12 * (1.0 + expected.abs()),
            "{conic:?}"
        );
        assert!(other.is_nan() || other.abs() >= 1e9, "{conic:?}: {other}");
    }
}

#[test]
fn what_a_line_misses_has_no_crossing() {
    // x² + y² = 0.09
    let circle = Quadratic {
        one: -0.09,
        xx: 1.0,
        yy: 1.0,
        ..Quadratic::default()
    };
    let y = [0.0, 0.1, -0.2, 0.29, 0.31, -0.31, 0.4, 0.5];
    let [rising, falling] = crossings(&circle, y);
    for (lane, y) in y.into_iter().enumerate() {
        let half = (0.09 - y * y).sqrt();
        if half.is_nan() {
            assert!(rising[lane].is_nan() && falling[lane].is_nan());
        } else {
            assert!((rising[lane] - half).abs() < 1e-15 && (falling[lane] + half).abs() < 1e-15);
        }
    }
}

#[test]
fn circles_are_touched_at_top_and_bottom() {
    for (a, b, r) in [(0.0, 0.0, 0.3), (0.2, -0.1, 0.05), (-3.0, 1e-3, 1.0)] {
        let circle = Quadratic {
            one: a * a + b * b - r * r,
            x: -2.0 * a,
            y: -2.0 * b,
            xx: 1.0,
            xy: 0.0,
            yy: 1.0,
        };
        let mut extremes = circle.extremes();
        extremes.sort_by(|one, other| one.1.total_cmp(&other.1));
        for ((x, y), expected) in extremes.into_iter().zip([b - r, b + r]) {
            assert!(
                (x - a).abs() < 1e-13 && (y - expected).abs() < 1e-13,
                "{x}, {y}"
            );
        }
    }
}

#[test]
fn extremes_are_zeros_with_level_tangents() {
    let mut random = Random(4);
    let mut checked = 0;
    for _ in 0..3000 {
        let conic = any_conic(&mut random);
        for (x, y) in conic.extremes() {
            if !(x.abs() < 10.0 && y.abs() < 10.0) {
                continue;
            }
            let scale = conic.x.abs() + 2.0 * (conic.xx * x).abs() + (conic.xy * y).abs();
            assert!(slope(&conic, x, y).abs() <= 1e-14 * scale, "{conic:?}");
            // y is a root of a discriminant of products; where x x cancels it takes its part of them.
            let (value, terms) = value(&conic, x, y);
            let condition = terms + scale * scale / conic.xx.abs();
            assert!(value.abs() <= 1e-13 * condition, "{conic:?} at ({x}, {y})");
            checked += 1;
        }
    }
    assert!(checked > 500, "{checked}");
}

/// A zero is admitted where values of both signs are found, and denied elsewhere as a rule.
#[test]
fn no_zero_of_the_cell_is_denied() {
    let mut random = Random(5);
    let (mut without, mut denied) = (0, 0);
    for _ in 0..2000 {
        let conic = any_conic(&mut random);
        let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
        for row in -20..=20 {
            for col in -20..=20 {
                let (value, _) = value(&conic, f64::from(col) / 40.0, f64::from(row) / 40.0);
                assert!((value - conic.one).abs() <= conic.spread() * (1.0 + 1e-12));
                (low, high) = (low.min(value), high.max(value));
            }
        }
        if low <= 0.0 && high >= 0.0 {
            assert!(conic.may_vanish(), "{conic:?}");
        } else {
            without += 1;
            denied += u32::from(!conic.may_vanish());
        }
    }
    assert!(denied > without / 2, "{denied} of {without} denied");
}

#[test]
fn a_zero_in_the_very_corner_is_admitted_and_so_is_the_unknown() {
    let corner = Quadratic {
        one: 1.0,
        x: 1.0,
        y: -1.0,
        ..Quadratic::default()
    };
    assert!(corner.may_vanish());
    assert!((corner * f64::NAN).may_vanish());
    let beyond = Quadratic {
        one: 1.0 + 1e-9,
        ..corner
    };
    assert!(!beyond.may_vanish());
}

#[test]
fn polynomials_add_and_multiply_like_their_values() {
    let mut random = Random(6);
    for _ in 0..500 {
        let (a, b) = (any_linear(&mut random), any_linear(&mut random));
        let (p, q) = (any_conic(&mut random), any_conic(&mut random));
        let (x, y) = (coordinate(&mut random), coordinate(&mut random));
        let of = |conic: &Quadratic| value(conic, x, y).0;
        let is_near = |one: f64, other: f64| (one - other).abs() < 1e-14 * 40.0;
        assert!(is_near(of(&(a * b)), at(&a, x, y) * at(&b, x, y)));
        assert!(is_near(of(&(p + q)), of(&p) + of(&q)));
        assert!(is_near(of(&(p - q)), of(&p) - of(&q)));
        assert!(is_near(of(&(p * 3.0)), 3.0 * of(&p)));
        assert!(is_near(value(&p.transposed(), y, x).0, of(&p)));
    }
}
