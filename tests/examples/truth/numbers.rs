//! Random numbers by SplitMix64, the same everywhere.

pub(crate) struct Numbers(pub(crate) u64);

impl Numbers {
    /// From 0 to, not including, 1.
    pub(crate) fn uniform(&mut self) -> f64 {
        let bits = self.bits() >> (64 - f64::MANTISSA_DIGITS);
        bits as f64 / (1_u64 << f64::MANTISSA_DIGITS) as f64
    }

    pub(crate) fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut bits = self.0;
        bits = (bits ^ (bits >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        bits = (bits ^ (bits >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        bits ^ (bits >> 31)
    }
}
