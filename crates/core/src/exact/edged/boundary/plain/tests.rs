//! Tests of `plain.rs`.

use super::*;

/// What a rule is off by for a part of n·l along a chord, which is the integral of cos² φ, sin φ cos φ
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
