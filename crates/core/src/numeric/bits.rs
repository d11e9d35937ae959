//! Bits: those that are set in a mask, and those of doubles in the order of their values.

/// The places of the bits that are set, the lowest first.
#[inline(always)]
pub(crate) fn set_bits(mask: impl Into<u64>) -> SetBits {
    SetBits(mask.into())
}

/// The bits that are still to come. No adapter of closures: those are not compiled for the
/// processor's level (see [`crate::numeric::lanes`]).
#[derive(Clone, Copy, Debug)]
pub(crate) struct SetBits(u64);

impl Iterator for SetBits {
    type Item = usize;

    #[inline(always)]
    fn next(&mut self) -> Option<usize> {
        if self.0 == 0 {
            return None;
        }
        let place = self.0.trailing_zeros() as usize;
        self.0 &= self.0 - 1;
        Some(place)
    }
}

/// The sign of a double.
const SIGN: u64 = 1 << 63;

/// Bits that rise with the number.
pub(crate) fn rising_bits(value: f64) -> u64 {
    let bits = value.to_bits();
    if bits & SIGN == 0 { bits | SIGN } else { !bits }
}

/// The number with such bits.
pub(crate) fn of_rising_bits(bits: u64) -> f64 {
    f64::from_bits(if bits & SIGN == 0 { !bits } else { bits ^ SIGN })
}
