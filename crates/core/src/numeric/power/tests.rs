use fearless_simd::dispatch;

use super::*;
use crate::numeric::lanes::f64x8;
use crate::numeric::lanes::tests::levels;

/// Whole ones, halves, general ones; small, usual, large and absurd.
const EXPONENTS: [f64; 28] = [
    1.0,
    2.0,
    3.0,
    7.0,
    40.0,
    127.0,
    255.0,
    512.0,
    0.5,
    1.5,
    2.5,
    100.5,
    1.2,
    0.1,
    2.2,
    33.3,
    512.1,
    513.0,
    1e3,
    1234.5,
    1e4,
    1e-3,
    1e-300,
    5e-324,
    1e6,
    1e17,
    1e300,
    f64::MAX,
];

/// From 0 to 1.1: all magnitudes, those near 1, and those near the ends of intervals.
fn bases() -> Vec<f64> {
    let mut bases = vec![
        0.0,
        -0.0,
        5e-324,
        1e-310,
        f64::MIN_POSITIVE,
        1e-200,
        0.5,
        0.5_f64.sqrt(),
        0.5_f64.sqrt() - f64::EPSILON / 2.0,
        0.25,
        1.0 - f64::EPSILON / 2.0,
        1.0,
        1.0 + f64::EPSILON,
        1.0 + 4.0 * f64::EPSILON,
        1.1,
        -1e-17,
    ];
    let mut bits = 3_u64;
    let mut next = || {
        bits = bits.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
        (bits >> 11) as f64 / (1_u64 << 53) as f64
    };
    for _ in 0..4000 {
        bases.push(next());
        bases.push(libm::exp(-700.0 * next()));
        bases.push(1.0 - libm::exp(-37.0 * next()));
        bases.push(1.0 + 0.1 * next());
    }
    bases
}

/// The largest relative error where the power is no smaller than 1e-306, and the largest absolute
/// one for bases up to 1; both against `libm::pow`, which is off by less than one unit in the last
/// place.
fn largest_errors(exponent: f64) -> (f64, f64) {
    let power = Power::new(exponent);
    let (mut relative, mut absolute) = (0.0_f64, 0.0_f64);
    for base in bases() {
        let (found, exact) = (power.scalar(base), libm::pow(base.max(0.0), exponent));
        let error = (found - exact).abs();
        if (1e-306..1e306).contains(&exact) {
            relative = relative.max(error / exact);
        }
        if base <= 1.0 {
            absolute = absolute.max(error);
        }
    }
    (relative, absolute)
}

#[test]
fn powers_are_accurate() {
    let mut largest = (0.0_f64, 0.0_f64);
    for exponent in EXPONENTS {
        let (relative, absolute) = largest_errors(exponent);
        let (relative_bound, absolute_bound) =
            if matches!(Power::new(exponent).kind, Kind::Chain { .. }) {
                let bound = 2e-16 + 1.2e-16 * exponent;
                (bound, bound)
            } else {
                largest = (largest.0.max(relative), largest.1.max(absolute));
                (5e-15, 1e-15)
            };
        assert!(relative < relative_bound, "{exponent:e}: {relative:e}");
        assert!(absolute < absolute_bound, "{exponent:e}: {absolute:e}");
    }
    // What is claimed is not far from what is.
    assert!(largest.0 > 5e-16 && largest.1 > 1e-16, "{largest:?}");
}

#[test]
fn lanes_hold_the_bits_of_the_scalar_power() {
    for exponent in EXPONENTS {
        let power = Power::new(exponent);
        for level in levels() {
            for chunk in bases().chunks_exact(8) {
                let eight: [f64; 8] = chunk.try_into().unwrap();
                let lanes: [f64; 8] =
                    dispatch!(level, simd => power.lanes(f64x8::from_array(simd, eight)).into());
                for (base, lane) in eight.into_iter().zip(lanes) {
                    let scalar = power.scalar(base);
                    assert_eq!(
                        lane.to_bits(),
                        scalar.to_bits(),
                        "{base:e} to {exponent:e} at {level:?}"
                    );
                }
            }
        }
    }
}

#[test]
fn exponent_one_is_the_identity() {
    let power = Power::new(1.0);
    for base in bases() {
        assert_eq!(power.scalar(base), base.max(0.0));
    }
}

#[test]
fn ends_are_exact() {
    for exponent in EXPONENTS {
        let power = Power::new(exponent);
        assert_eq!(power.scalar(0.0).to_bits(), 0);
        assert_eq!(power.scalar(-1e-17), 0.0);
        assert_eq!(power.scalar(1.0), 1.0);
        for base in bases() {
            let value = power.scalar(base);
            assert!(value >= 0.0, "{base:e} to {exponent:e}: {value}");
            assert!(
                value <= 1.0 || base > 1.0,
                "{base:e} to {exponent:e}: {value}"
            );
        }
    }
    assert_eq!(Power::new(1e300).scalar(0.999), 0.0);
    assert_eq!(Power::new(1e300).scalar(1.0 + f64::EPSILON), f64::INFINITY);
    assert_eq!(Power::new(f64::MAX).scalar(5e-324), 0.0);
    assert!(Power::new(5e-324).scalar(5e-324) == 1.0);
}
