//! Estimates of powers against integrals in closed form.

use fearless_simd::{Level, dispatch};

use super::*;
use crate::exact::interior::samples::{GAUSS_SAMPLES, POINTS, STAR_SAMPLES};

/// The mean of (1 + a x + b y)^e over −1 ≤ x, y ≤ 1.
fn mean(exponent: f64, [a, b]: [f64; 2]) -> f64 {
    let power = |u: f64, exponent: f64| libm::pow(u.max(0.0), exponent);
    let (first, second) = (exponent + 1.0, exponent + 2.0);
    if b == 0.0 {
        return (power(1.0 + a, first) - power(1.0 - a, first)) / (2.0 * a * first);
    }
    let of_corners = [(1.0, 1.0), (1.0, -1.0), (-1.0, 1.0), (-1.0, -1.0)];
    let sum: f64 = of_corners
        .iter()
        .map(|(x, y)| x * y * power(1.0 + a * x + b * y, second))
        .sum();
    sum / (4.0 * a * b * first * second)
}

/// The error of a rule, and the estimate.
fn error_and_estimate(exponent: f64, [a, b]: [f64; 2], rule: Rule) -> [f64; 2] {
    let samples = match rule {
        Rule::Star => STAR_SAMPLES,
        Rule::Grid => GAUSS_SAMPLES,
    };
    let mut found = 0.0;
    for sample in &POINTS[..samples] {
        let weight = match rule {
            Rule::Star => sample.star,
            Rule::Grid => sample.gauss,
        };
        let cosine = 1.0 + 2.0 * (a * sample.u + b * sample.v);
        found += weight * libm::pow(cosine.max(0.0), exponent);
    }
    let reach = a.abs() + b.abs();
    let estimate = dispatch!(Level::new(), simd => {
        let range = CosineRange {
            lowest: f64x8::splat(simd, 1.0 - reach),
            highest: f64x8::splat(simd, 1.0 + reach),
            bend: f64x8::splat(simd, 0.0),
        };
        Power(exponent).share(rule, &range)[2]
    });
    [(found - mean(exponent, [a, b])).abs(), estimate]
}

#[test]
fn powers_are_within_their_estimates_and_not_far_below() {
    for exponent in [0.1, 0.3, 0.5, 0.8, 1.2, 1.5, 2.3, 2.5, 3.5] {
        for reach in [0.2, 0.4, 0.6, 0.8, 0.9, 0.94] {
            for rule in [Rule::Star, Rule::Grid] {
                let mut largest = 0.0_f64;
                let mut estimated = 0.0;
                for share in [0.0, 0.1, 0.2, 0.3, 0.4, 0.5] {
                    let slopes = [reach * (1.0 - share), reach * share];
                    let [error, estimate] = error_and_estimate(exponent, slopes, rule);
                    assert!(
                        error <= estimate + 1e-14,
                        "{exponent} {slopes:?} {rule:?}: {error:e} {estimate:e}"
                    );
                    largest = largest.max(error);
                    estimated = estimate;
                }
                assert!(
                    estimated < 30.0 * largest + 1e-9,
                    "{exponent} {reach} {rule:?}"
                );
            }
        }
    }
}

/// Whole powers are polynomials, which other estimates know.
#[test]
fn whole_powers_claim_nothing() {
    for exponent in [1.0, 2.0, 3.0] {
        let [_, estimate] = error_and_estimate(exponent, [0.5, 0.2], Rule::Grid);
        assert_eq!(estimate, 0.0, "{exponent}");
    }
}
