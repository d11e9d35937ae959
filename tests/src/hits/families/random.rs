//! Random numbers that are the same on all machines.

use glam::DVec3;

/// The generator SplitMix64.
///
/// # Source
/// G. L. Steele, D. Lea, C. H. Flood, Fast Splittable Pseudorandom Number Generators,
/// OOPSLA 2014.
pub struct Random(u64);

impl Random {
    /// A separate sequence for every seed.
    pub fn new(seed: u64) -> Self {
        Self(seed)
    }

    /// 64 random bits.
    pub fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mixed = (self.0 ^ self.0 >> 30).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let mixed = (mixed ^ mixed >> 27).wrapping_mul(0x94d0_49bb_1331_11eb);
        mixed ^ mixed >> 31
    }

    /// Uniform from 0 to below 1.
    pub fn unit(&mut self) -> f64 {
        (self.bits() >> 11) as f64 * (f64::EPSILON / 2.0)
    }

    /// Uniform between two numbers.
    pub fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.unit()
    }

    /// A number whose logarithm is uniform.
    pub fn magnitude(&mut self, low: f64, high: f64) -> f64 {
        libm::exp(self.between(libm::log(low), libm::log(high)))
    }

    /// A whole number between two numbers, both included.
    pub fn integer(&mut self, low: i64, high: i64) -> i64 {
        low + (self.bits() % (high - low + 1) as u64) as i64
    }

    /// A power of two whose exponent is between two numbers, both included.
    pub fn power_of_two(&mut self, low: i64, high: i64) -> f64 {
        libm::scalbn(1.0, self.integer(low, high) as i32)
    }

    /// True with a probability of one in `chances`.
    pub fn one_in(&mut self, chances: u64) -> bool {
        self.bits().is_multiple_of(chances)
    }

    /// 1 or −1.
    pub fn sign(&mut self) -> f64 {
        if self.one_in(2) { -1.0 } else { 1.0 }
    }

    /// The direction of an axis, positive or negative.
    pub fn axis(&mut self) -> DVec3 {
        DVec3::AXES[self.integer(0, 2) as usize] * self.sign()
    }

    /// A point of the cube around the origin.
    pub fn in_cube(&mut self, half_side: f64) -> DVec3 {
        let mut part = || self.between(-half_side, half_side);
        DVec3::new(part(), part(), part())
    }

    /// A point of the unit ball.
    pub fn in_unit_ball(&mut self) -> DVec3 {
        loop {
            let point = self.in_cube(1.0);
            if point.length_squared() <= 1.0 {
                return point;
            }
        }
    }

    /// A direction, unit up to rounding.
    pub fn unit_vector(&mut self) -> DVec3 {
        loop {
            let point = self.in_unit_ball();
            if point.length_squared() > 0.01 {
                return point.normalize();
            }
        }
    }

    /// Any finite double, including subnormal ones.
    pub fn any_finite(&mut self) -> f64 {
        loop {
            let value = f64::from_bits(self.bits());
            if value.is_finite() {
                return value;
            }
        }
    }
}
