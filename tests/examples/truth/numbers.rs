//! Random numbers by SplitMix64, the same everywhere.

pub(crate) struct Numbers(pub(crate) u64);

impl Numbers {
    /// From 0 to, not including, 1.
    pub(crate) fn uniform(&mut self) -> f64 {
        let bits = self.bits() >> (64 - f64::MANTISSA_DIGITS);
        bits as f64 / (1_u64 << f64::MANTISSA_DIGITS) as f64
    }

    /// Between two numbers.
    pub(crate) fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.uniform()
    }

    /// A whole number below this one.
    pub(crate) fn below(&mut self, bound: usize) -> usize {
        (self.uniform() * bound as f64) as usize
    }

    /// One of some.
    pub(crate) fn either<T: Copy>(&mut self, of: &[T]) -> T {
        of[self.below(of.len())]
    }

    /// A unit vector.
    pub(crate) fn direction(&mut self) -> [f64; 3] {
        loop {
            let [x, y, z] = [(); 3].map(|()| self.between(-1.0, 1.0));
            let size = (x * x + y * y + z * z).sqrt();
            if 0.1 < size && size < 1.0 {
                return [x / size, y / size, z / size];
            }
        }
    }

    pub(crate) fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut bits = self.0;
        bits = (bits ^ (bits >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        bits = (bits ^ (bits >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        bits ^ (bits >> 31)
    }
}
