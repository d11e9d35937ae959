//! Half-precision floats, rounded once.

use exr::prelude::f16;

/// The largest finite half.
pub(super) const LARGEST: f64 = 65504.0;

/// The half nearest to `value`; ties round to even.
///
/// `f16::from_f64` would round twice, and not in the same way on every machine.
pub(super) fn nearest(value: f64) -> f16 {
    /// The exponent that subnormal halves have as well.
    const LEAST_EXPONENT: i64 = -14;
    /// The number of mantissa bits of a half and of a double.
    const BITS: i64 = 10;
    const DOUBLE_BITS: i64 = 52;
    const DOUBLE_BIAS: i64 = 1023;

    if value.is_nan() || value.abs() >= 2.0 * LARGEST {
        // Too large, or not a number: nothing to round.
        return f16::from_f32(value as f32);
    }
    let exponent = (value.abs().to_bits() >> DOUBLE_BITS) as i64 - DOUBLE_BIAS;
    // A double of this size has no bits below the last one of the half, so that adding it
    // rounds there, and taking it away again is exact.
    let exponent = exponent.max(LEAST_EXPONENT) - BITS + DOUBLE_BITS;
    let large = 1.5 * f64::from_bits(((exponent + DOUBLE_BIAS) as u64) << DOUBLE_BITS);
    let rounded = (value + large) - large;
    // A float holds every half.
    f16::from_f32(rounded as f32)
}

#[cfg(test)]
mod tests;
