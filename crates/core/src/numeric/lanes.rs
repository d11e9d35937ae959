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

use std::ops::{Add, Mul, Sub};

use fearless_simd::{Select, Simd, SimdBase, SimdFloat, f64x8};

/// Bits of the mantissa that a double stores.
const MANTISSA_BITS: u32 = f64::MANTISSA_DIGITS - 1;

/// 2⁵² and all the bits of 2⁵²: its last mantissa bits count units.
const COUNTER: f64 = (1_u64 << MANTISSA_BITS) as f64;
const COUNTER_BITS: u64 = COUNTER.to_bits();

/// What is added to exponents where they are stored.
const EXPONENT_BIAS: f64 = 1023.0;

/// Numbers side by side.
pub(crate) const LANES: usize = 8;

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
        Self::splat(self.simd, number)
    }

    #[inline(always)]
    fn sqrt(self) -> Self {
        SimdFloat::sqrt(self)
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
        Self::from_bits(self.to_bits() & UPPER_HALF)
    }

    #[inline(always)]
    fn mantissa_and_exponent(self) -> (Self, Self) {
        let shifted = self.to_bits() + (1.0_f64.to_bits() - LOWEST_MANTISSA);
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
pub(crate) mod tests {
    use fearless_simd::{Level, SimdFrom, dispatch};

    use super::*;

    /// Every level that this processor has.
    pub(crate) fn levels() -> Vec<Level> {
        #[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
        {
            let best = Level::new();
            let of_x86 = [
                best.as_sse2().map(Level::Sse2),
                best.as_sse4_2().map(Level::Sse4_2),
                best.as_avx2().map(Level::Avx2),
                best.as_avx512().map(Level::Avx512),
            ];
            of_x86.into_iter().flatten().collect()
        }
        #[cfg(not(any(target_arch = "x86", target_arch = "x86_64")))]
        vec![Level::baseline(), Level::new()]
    }

    /// Calls `check` with each number's lane and double after a function of both.
    macro_rules! assert_same_bits {
        ($numbers:expr, $function:expr) => {
            for level in levels() {
                for chunk in $numbers.chunks_exact(8) {
                    let eight: [f64; 8] = chunk.try_into().unwrap();
                    let lanes: [f64; 8] = dispatch!(level, simd => {
                        let function = $function;
                        function(f64x8::simd_from(simd, eight)).into()
                    });
                    for (number, lane) in eight.into_iter().zip(lanes) {
                        let function = $function;
                        let double: f64 = function(number);
                        assert_eq!(lane.to_bits(), double.to_bits(), "{number:e} at {level:?}");
                    }
                }
            }
        };
    }

    fn numbers() -> Vec<f64> {
        let mut numbers = vec![
            0.0,
            -0.0,
            0.5,
            1.5,
            2.5,
            -0.5,
            -1.5,
            5e-324,
            f64::MIN_POSITIVE,
            1.0,
            1.0 + f64::EPSILON,
            1.0 - f64::EPSILON / 2.0,
            2_f64.powi(50) + 0.25,
            2_f64.powi(51) - 0.5,
            2_f64.powi(52) - 0.5,
            -2_f64.powi(52) + 0.5,
            2_f64.powi(62),
            -1e300,
            f64::MAX,
            f64::INFINITY,
            f64::NEG_INFINITY,
            0.5_f64.sqrt(),
            2_f64.sqrt(),
            0.5 - f64::EPSILON / 4.0,
        ];
        let mut bits = 7_u64;
        for _ in 0..4000 {
            bits = bits.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
            // Any sign and mantissa, exponents from −70 to 70.
            let exponent = 1023 - 70 + (bits >> 33) % 141;
            numbers.push(f64::from_bits(
                bits & 0x800f_ffff_ffff_ffff | exponent << 52,
            ));
        }
        numbers
    }

    #[test]
    fn lanes_hold_the_bits_of_doubles() {
        assert_same_bits!(numbers(), |x| Lanes::nearest_whole(x));
        assert_same_bits!(numbers(), |x| Lanes::upper_half(x));
        assert_same_bits!(numbers(), |x| Lanes::reciprocal(x));
        assert_same_bits!(numbers(), |x| Lanes::mantissa_and_exponent(x).0);
        assert_same_bits!(numbers(), |x| Lanes::mantissa_and_exponent(x).1);
        assert_same_bits!(numbers(), |x| polynomial(x, &[1.0, 0.3, -0.7, 1e-3]));
        let not_negative: Vec<f64> = numbers().into_iter().map(f64::abs).collect();
        assert_same_bits!(not_negative, |x| Lanes::sqrt(x));
    }

    #[test]
    fn nearest_whole_rounds_ties_to_even() {
        for number in numbers() {
            if number.abs() <= 2_f64.powi(51) {
                assert_eq!(number.nearest_whole(), number.round_ties_even());
            }
        }
    }

    #[test]
    fn mantissa_and_exponent_make_the_number() {
        for number in numbers() {
            let number = number.abs();
            if (f64::MIN_POSITIVE..=f64::MAX).contains(&number) {
                let (mantissa, exponent) = number.mantissa_and_exponent();
                assert!((0.707..1.415).contains(&mantissa), "{number:e}: {mantissa}");
                assert_eq!(libm::scalbn(mantissa, exponent as i32), number);
            }
        }
    }

    #[test]
    fn powers_of_two_are_exact() {
        for exponent in -1022..=1023 {
            assert_eq!(
                f64::from(exponent).power_of_two(),
                libm::scalbn(1.0, exponent)
            );
        }
    }
}
