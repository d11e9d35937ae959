//! Random numbers by SplitMix64, the same on all machines.

/// A generator with its state, which is its seed at first.
#[derive(Clone, Debug)]
pub struct Numbers(pub u64);

impl Numbers {
    /// A number from 0, included, to 1, not included.
    pub fn uniform(&mut self) -> f64 {
        let bits = self.bits() >> (64 - f64::MANTISSA_DIGITS);
        bits as f64 / (1_u64 << f64::MANTISSA_DIGITS) as f64
    }

    /// A number between two numbers.
    pub fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.uniform()
    }

    /// A whole number from 0, below this one.
    pub fn below(&mut self, bound: usize) -> usize {
        (self.uniform() * bound as f64) as usize
    }

    /// One of some items.
    pub fn either<T: Copy>(&mut self, of: &[T]) -> T {
        of[self.below(of.len())]
    }

    /// A unit vector.
    pub fn direction(&mut self) -> [f64; 3] {
        loop {
            let [x, y, z] = [(); 3].map(|()| self.between(-1.0, 1.0));
            let size = (x * x + y * y + z * z).sqrt();
            if 0.1 < size && size < 1.0 {
                return [x / size, y / size, z / size];
            }
        }
    }

    /// All 64 bits of a number.
    pub fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut bits = self.0;
        bits = (bits ^ (bits >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        bits = (bits ^ (bits >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        bits ^ (bits >> 31)
    }
}
