//! One formula for a double and for eight side by side.
//!
//! Code that is generic over [`Lanes`] uses only operations that IEEE 754 rounds correctly and
//! operations on bits, one lane at a time and in one order: a lane then holds the same bits as
//! the double, on every processor. Multiplication and addition in one rounding is absent for that
//! reason: it is not everywhere, and where it is missing its emulation is slow.
//!
//! Such code is inlined into kernels that are compiled for one level of the processor. It has no
//! closures: those are functions of their own, without the level's instructions and thirty times
//! slower.

#[macro_use]
mod leaf;
mod doubles;
mod masks;
mod singles;

use std::ops::{Add, Mul, Sub};

use fearless_simd::{Simd, SimdFloat};

pub(crate) use self::doubles::{LANE_NUMBERS, LANES, f64x8};
pub(crate) use self::masks::mask64x8;
pub(crate) use self::singles::{f32x8, mask32x8};

/// Bits of the mantissa that a double stores.
const MANTISSA_BITS: u32 = f64::MANTISSA_DIGITS - 1;

/// 2⁵² and all the bits of 2⁵²: its last mantissa bits count units.
const COUNTER: f64 = (1_u64 << MANTISSA_BITS) as f64;
const COUNTER_BITS: u64 = COUNTER.to_bits();

/// The number that is added to exponents where they are stored.
const EXPONENT_BIAS: f64 = 1023.0;

/// A double, or eight.
pub(crate) trait Lanes:
    Copy
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Add<f64, Output = Self>
    + Sub<f64, Output = Self>
    + Mul<f64, Output = Self>
{
    /// This number in every lane.
    fn like(self, number: f64) -> Self;

    /// The square root, correctly rounded.
    fn sqrt(self) -> Self;

    /// 1 / `self`, correctly rounded.
    fn reciprocal(self) -> Self;

    /// `below` where `self` is less than `limit`, `otherwise` elsewhere.
    fn select_below(self, limit: f64, below: Self, otherwise: Self) -> Self;

    /// The first 26 bits of the mantissa: products of two such numbers are exact.
    fn upper_half(self) -> Self;

    /// A mantissa from √½ to √2 and an exponent whose power of two times it is `self`, for normal
    /// numbers greater than 0; something harmless for others.
    fn mantissa_and_exponent(self) -> (Self, Self);

    /// 2 to the power of `self`, for whole numbers from −1022 to 1023; anything for others.
    fn power_of_two(self) -> Self;

    /// The nearest whole number, the even one of two, for numbers up to 2⁵¹ on either side of 0;
    /// anything for others. Never −0.
    #[inline(always)]
    fn nearest_whole(self) -> Self {
        // Doubles from 2⁵² to 2⁵³ have no fractions.
        const ROUNDER: f64 = 1.5 * COUNTER;
        (self + ROUNDER) - ROUNDER
    }
}

/// The bits of √½, rounded up: mantissas begin here.
const LOWEST_MANTISSA: u64 = 0x3fe6_a09e_667f_3bcd;
const MANTISSA_MASK: u64 = (1 << MANTISSA_BITS) - 1;
const UPPER_HALF: u64 = !((1 << 27) - 1);

impl Lanes for f64 {
    #[inline(always)]
    fn like(self, number: f64) -> Self {
        number
    }

    #[inline(always)]
    fn sqrt(self) -> Self {
        self.sqrt()
    }

    #[inline(always)]
    fn reciprocal(self) -> Self {
        1.0 / self
    }

    #[inline(always)]
    fn select_below(self, limit: f64, below: Self, otherwise: Self) -> Self {
        if self < limit { below } else { otherwise }
    }

    #[inline(always)]
    fn upper_half(self) -> Self {
        Self::from_bits(self.to_bits() & UPPER_HALF)
    }

    #[inline(always)]
    fn mantissa_and_exponent(self) -> (Self, Self) {
        let shifted = self
            .to_bits()
            .wrapping_add(1.0_f64.to_bits() - LOWEST_MANTISSA);
        let mantissa = (shifted & MANTISSA_MASK) + LOWEST_MANTISSA;
        let biased = Self::from_bits(shifted >> MANTISSA_BITS | COUNTER_BITS);
        (
            Self::from_bits(mantissa),
            biased - (COUNTER + EXPONENT_BIAS),
        )
    }

    #[inline(always)]
    fn power_of_two(self) -> Self {
        Self::from_bits((self + (COUNTER + EXPONENT_BIAS)).to_bits() << MANTISSA_BITS)
    }
}

impl<S: Simd> Lanes for f64x8<S> {
    #[inline(always)]
    fn like(self, number: f64) -> Self {
        Self::splat(self.simd(), number)
    }

    #[inline(always)]
    fn sqrt(self) -> Self {
        Self::sqrt(self)
    }

    #[inline(always)]
    fn reciprocal(self) -> Self {
        1.0 / self
    }

    #[inline(always)]
    fn select_below(self, limit: f64, below: Self, otherwise: Self) -> Self {
        self.simd_lt(limit).select(below, otherwise)
    }

    #[inline(always)]
    fn upper_half(self) -> Self {
        leaf!(self.simd(), {
            let upper = self.0.to_bits() & UPPER_HALF;
            Self(SimdFloat::from_bits(upper))
        })
    }

    #[inline(always)]
    fn mantissa_and_exponent(self) -> (Self, Self) {
        leaf!(self.simd(), {
            let shifted = self.0.to_bits() + (1.0_f64.to_bits() - LOWEST_MANTISSA);
            let mantissa = (shifted & MANTISSA_MASK) + LOWEST_MANTISSA;
            let biased = Self(SimdFloat::from_bits(
                shifted >> MANTISSA_BITS | COUNTER_BITS,
            ));
            (
                Self(SimdFloat::from_bits(mantissa)),
                biased - (COUNTER + EXPONENT_BIAS),
            )
        })
    }

    #[inline(always)]
    fn power_of_two(self) -> Self {
        leaf!(self.simd(), {
            let biased = (self.0 + (COUNTER + EXPONENT_BIAS)).to_bits();
            Self(SimdFloat::from_bits(biased << MANTISSA_BITS))
        })
    }
}

/// The polynomial with these coefficients, the constant first, an even number of them.
///
/// Even and odd powers apart: two sums side by side wait half as long as one.
#[inline(always)]
pub(crate) fn polynomial<L: Lanes, const COUNT: usize>(x: L, coefficients: &[f64; COUNT]) -> L {
    const { assert!(COUNT >= 2 && COUNT.is_multiple_of(2)) };
    let square = x * x;
    let mut even = x.like(coefficients[COUNT - 2]);
    let mut odd = x.like(coefficients[COUNT - 1]);
    for pair in coefficients[..COUNT - 2].rchunks_exact(2) {
        even = even * square + pair[0];
        odd = odd * square + pair[1];
    }
    even + odd * x
}

#[cfg(test)]
pub(crate) mod tests;
