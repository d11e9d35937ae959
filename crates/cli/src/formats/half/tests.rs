//! Tests of `half.rs`.

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
