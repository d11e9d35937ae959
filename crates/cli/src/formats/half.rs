//! Half floats, rounded once.

use exr::prelude::f16;

/// The largest finite half.
pub(super) const LARGEST: f64 = 65504.0;

/// The half nearest to `value`, ties to even.
///
/// `f16::from_f64` would round twice, and not on every machine in the same way.
pub(super) fn nearest(value: f64) -> f16 {
    /// The exponent that subnormal halves have as well.
    const LEAST_EXPONENT: i64 = -14;
    /// The numbers of mantissa bits of a half and a double.
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
mod tests {
    use super::*;

    #[test]
    fn halves_stay() {
        for bits in 0..=u16::MAX {
            let half = f16::from_bits(bits);
            if half.is_finite() && bits != 0x8000 {
                assert_eq!(nearest(half.to_f64()).to_bits(), bits);
            }
        }
    }

    #[test]
    fn the_middle_goes_to_even_and_its_neighbors_do_not() {
        // Positive finite halves in order have consecutive bits.
        for bits in 0..f16::MAX.to_bits() {
            let (low, high) = (f16::from_bits(bits), f16::from_bits(bits + 1));
            let middle = 0.5 * (low.to_f64() + high.to_f64());
            let even = if bits % 2 == 0 { low } else { high };
            for sign in [1.0, -1.0] {
                assert_eq!(nearest(sign * middle).to_f64(), sign * even.to_f64());
                assert_eq!(
                    nearest(sign * middle.next_up()).to_f64(),
                    sign * high.to_f64()
                );
                assert_eq!(
                    nearest(sign * middle.next_down()).to_f64(),
                    sign * low.to_f64()
                );
            }
        }
    }

    #[test]
    fn what_is_no_finite_half_stays_so() {
        assert!(nearest(f64::NAN).is_nan());
        assert_eq!(nearest(65519.0), f16::MAX);
        for large in [65520.0, 1e5, 1e300, f64::INFINITY] {
            assert_eq!(nearest(large), f16::INFINITY);
        }
    }
}
