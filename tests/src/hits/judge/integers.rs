//! Doubles as integers times powers of two, and back.

use num_bigint::{BigInt, Sign};

/// Finite doubles as integers in a common unit, and the binary exponent of this unit.
pub(super) fn integers<const COUNT: usize>(values: [f64; COUNT]) -> ([BigInt; COUNT], i64) {
    let parts = values.map(mantissa_and_exponent);
    let unit = parts
        .iter()
        .filter(|part| part.0 != 0)
        .map(|part| part.1)
        .min()
        .unwrap_or(0);
    (
        parts.map(|(mantissa, exponent)| BigInt::from(mantissa) << (exponent - unit).max(0)),
        unit,
    )
}

/// A finite double as an odd integer (or zero) times a power of two.
pub(super) fn mantissa_and_exponent(value: f64) -> (i64, i64) {
    assert!(value.is_finite());
    if value == 0.0 {
        return (0, 0);
    }
    // The fraction lies between ½ and 1, of subnormal numbers too.
    let (fraction, exponent) = libm::frexp(value);
    let digits = i64::from(f64::MANTISSA_DIGITS);
    let mantissa = libm::scalbn(fraction, f64::MANTISSA_DIGITS as i32) as i64;
    let zeros = i64::from(mantissa.trailing_zeros());
    (mantissa >> zeros, i64::from(exponent) - digits + zeros)
}

/// The integer times 2^exponent, with a relative error of about 2⁻⁵³.
pub(super) fn to_float(integer: &BigInt, exponent: i64) -> f64 {
    let surplus = i64::try_from(integer.bits()).unwrap().saturating_sub(64);
    let magnitude = integer.magnitude() >> surplus.max(0);
    let leading = magnitude.iter_u64_digits().next().unwrap_or(0) as f64;
    // Beyond what an i32 holds the result is zero or infinite anyway.
    let shift = (surplus.max(0) + exponent).clamp(-10_000, 10_000) as i32;
    let value = libm::scalbn(leading, shift);
    if integer.sign() == Sign::Minus {
        -value
    } else {
        value
    }
}

/// `value` · 2^`places`, truncated to an integer if `places` is negative.
pub(super) fn shifted(value: &BigInt, places: i64) -> BigInt {
    if places >= 0 {
        value << places
    } else {
        value >> -places
    }
}

/// The inner product.
pub(super) fn dot(a: &[BigInt; 3], b: &[BigInt; 3]) -> BigInt {
    &a[0] * &b[0] + &a[1] * &b[1] + &a[2] * &b[2]
}

/// The outer product.
pub(super) fn cross(a: &[BigInt; 3], b: &[BigInt; 3]) -> [BigInt; 3] {
    [
        &a[1] * &b[2] - &a[2] * &b[1],
        &a[2] * &b[0] - &a[0] * &b[2],
        &a[0] * &b[1] - &a[1] * &b[0],
    ]
}
