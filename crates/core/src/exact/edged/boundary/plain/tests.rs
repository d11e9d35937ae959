//! Tests of `plain.rs`.

use fearless_simd::{Level, dispatch};
use glam::DVec2;

use super::*;
use crate::edges::silhouette::silhouette;
use crate::exact::edged::boundary::chord::Reference;
use crate::numeric::lanes::f64x8;

/// The error of a rule for a part of n·l along a chord, which is the integral of cos² φ, sin φ cos φ
/// or cos φ around some angle, on a way of 2 tan(φ / 2).
fn error(rule: &[(f64, f64)], around: f64, way: f64, part: usize) -> f64 {
    let light = |sigma: f64| {
        let tau = 0.5 * way * sigma;
        let angle = around + 2.0 * libm::atan(tau);
        let (cos, sin) = (libm::cos(angle), libm::sin(angle));
        [cos * cos, sin * cos, cos][part] * way / (1.0 + tau * tau)
    };
    let integral = |side: f64| {
        let angle = around + 2.0 * libm::atan(0.5 * way * side);
        let (cos, sin) = (libm::cos(angle), libm::sin(angle));
        [0.5 * (angle + sin * cos), 0.5 * sin * sin, sin][part]
    };
    let nodes = rule.iter();
    let sum: f64 = nodes
        .map(|(node, weight)| 2.0 * weight * light(2.0 * node - 1.0))
        .sum();
    (sum - (integral(1.0) - integral(-1.0))).abs()
}

#[test]
fn rules_are_off_by_no_more_than_they_are_said_to() {
    for (rule, off) in RULES.into_iter().zip(OFF) {
        for way in [1.0, 0.8, 0.6, 0.4] {
            let mut worst = 0.0_f64;
            let room = std::f64::consts::FRAC_PI_2 - 2.0 * libm::atan(0.5 * way);
            for step in 0..=100 {
                let around = room * (f64::from(step) / 50.0 - 1.0);
                for part in 0..3 {
                    worst = worst.max(error(rule, around, way, part));
                }
            }
            let said = off * libm::pow(way, 2.0 * rule.len() as f64 + 1.0);
            assert!(worst <= said, "{} {way}: {worst:e} {said:e}", rule.len());
            assert!(
                worst > 0.1 * said,
                "{} {way}: {worst:e} {said:e}",
                rule.len()
            );
        }
    }
}

/// Chords of spheres up to the nearest that count as far, up to the widest cells: as long as they are, and
/// wherever they lie.
#[test]
fn sums_are_off_by_no_more_than_they_doubt() {
    const TOWARD: [DVec3; 3] = [DVec3::X, DVec3::Y, DVec3::Z];
    let mut chords = 0;
    let mut closest = 0.0_f64;
    for radius in [1e-3, 0.3, 0.7, 0.89] {
        for side in [1e-3, 0.02, 0.099] {
            for middle in 0..40 {
                let center = DVec3::new(0.2, -0.1, 1.0);
                let place = f64::from(middle) / 20.0 - 1.0;
                let middle = DVec2::new(place, 0.3 * place) * 1.3 * radius + center.truncate();
                let cell = Cell {
                    middle: middle.extend(1.0),
                    size: [side; 2],
                    projection: crate::model::camera::Projection::Central,
                };
                let radius = radius * center.length();
                let ball = Ball {
                    center,
                    radius,
                    outside: center.length_squared() - radius * radius,
                    power: center.length_squared() - radius * radius,
                    projection: crate::model::camera::Projection::Central,
                };
                assert!(is_far(&cell, &ball));
                let q = silhouette(&cell, &ball);
                let [falling, rising] = q.crossings(0.1);
                let (left, right) = (falling.min(rising), falling.max(rising));
                let (left, right) = (left.max(-0.5), right.min(0.5));
                let there = 0.5 * (left + right);
                let seen =
                    (q.xx * there + q.xy * 0.1 + q.x) * there + (q.yy * 0.1 + q.y) * 0.1 + q.one;
                if left >= right || seen <= 0.0 {
                    continue;
                }
                let parts = 16;
                let at = |part: i32| left + (right - left) * f64::from(part) / f64::from(parts);
                dispatch!(Level::new(), simd => {
                    let lanes = |value: f64| f64x8::splat(simd, value);
                    let sum = |from: f64, to: f64, rule: &[(f64, f64)]| {
                        let from = Reference::upright(from);
                        let chord = Chord::new(simd, &q, &from, lanes(to), lanes(0.1));
                        let found = normals(simd, (&cell, &ball), &chord, lanes(0.1), rule);
                        (found.lane(0), chord)
                    };
                    let mut exact = DVec3::ZERO;
                    for part in 0..parts {
                        exact += sum(at(part), at(part + 1), RULES[3]).0;
                    }
                    for (index, rule) in RULES.into_iter().enumerate() {
                        let (found, chord) = sum(left, right, rule);
                        let way_sq = chord.way_sq()[0];
                        let power = chord.size_of_way()[0] * libm::pow(way_sq, rule.len() as f64 - 1.0);
                        for toward in TOWARD {
                            let off = (found - exact).dot(toward).abs();
                            let doubt = power * OFF[index] + 1e-13;
                            assert!(off <= doubt, "{cell:?} {ball:?} {index}: {off:e} {doubt:e}");
                            closest = closest.max(off / doubt);
                        }
                    }
                    chords += 1;
                });
            }
        }
    }
    assert!(chords > 200, "{chords}");
    assert!(closest > 0.1, "{closest}");
}
