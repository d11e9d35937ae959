//! The bits that are set in a mask.

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
