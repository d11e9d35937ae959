//! Sums and products of doubles without loss: the result and its rounding error, both doubles.
//!
//! # Source
//! T. J. Dekker, A floating-point technique for extending the available precision, Numerische
//! Mathematik 18, 1971; D. E. Knuth, The Art of Computer Programming 2, 4.2.2.

use std::ops::{Add, Mul, Sub};

use super::lanes::f64x8;
use fearless_simd::{Simd, SimdFloat, f64x4};

/// Half the distance from 1 to the next double, 2⁻⁵³: the relative error of one rounding is at
/// most this.
pub(crate) const UNIT_ROUNDOFF: f64 = f64::EPSILON / 2.0;

/// More than rounding makes wrong in the geometry of a cell, relative to the sum of the terms' sizes.
///
/// That takes some dozens of operations, whose errors sum up to less than 100 roundoffs, 1.1e-14. The
/// hundredfold leaves room, and costs next to nothing: a curve that misses a cell by so little counts as one
/// that may cross it.
pub(crate) const GEOMETRY_SLACK: f64 = 1e-12;

/// A factor that makes up for the rounding of lengths and distances, where a few units in the last place
/// become more by a root of a difference; a bound that is looser by this costs nothing.
pub(crate) const WIDER: f64 = 1.0 + 1e-9;

/// A double, or several side by side.
pub(crate) trait Number:
    Copy + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self> + Mul<f64, Output = Self>
{
    /// `self · factor + term`, rounded once.
    fn multiply_add(self, factor: Self, term: Self) -> Self;
}

impl Number for f64 {
    #[inline(always)]
    fn multiply_add(self, factor: Self, term: Self) -> Self {
        self.mul_add(factor, term)
    }
}

impl<S: Simd> Number for f64x4<S> {
    #[inline(always)]
    fn multiply_add(self, factor: Self, term: Self) -> Self {
        self.mul_add_precise(factor, term)
    }
}

impl<S: Simd> Number for f64x8<S> {
    #[inline(always)]
    fn multiply_add(self, factor: Self, term: Self) -> Self {
        self.mul_add_precise(factor, term)
    }
}

/// The rounded sum and its error; exact unless the sum overflows.
#[inline(always)]
pub(crate) fn two_sum<T: Number>(a: T, b: T) -> (T, T) {
    let sum = a + b;
    let b_part = sum - a;
    (sum, (a - (sum - b_part)) + (b - b_part))
}

/// The rounded difference and its error; exact unless the difference overflows.
#[inline(always)]
pub(crate) fn two_difference<T: Number>(a: T, b: T) -> (T, T) {
    let difference = a - b;
    let b_part = difference - a;
    (difference, (a - (difference - b_part)) - (b + b_part))
}

/// The rounded sum and its error, exact where |a| ≥ |b| or a = 0.
#[inline(always)]
pub(crate) fn fast_two_sum<T: Number>(a: T, b: T) -> (T, T) {
    let sum = a + b;
    (sum, b - (sum - a))
}

/// The rounded product and its error; exact where the product neither overflows nor lies so
/// near to zero (below 2⁻⁹⁶⁹) that its error is lost.
///
/// With `FUSED` by a fused multiplication and addition, which is a slow function where the
/// processor has none; else by splitting the factors, which must lie below 2⁹⁹⁶. Where the error is
/// exact, the results are the same to the bit; below 2⁻⁹⁶⁹ they may differ in the last bits of a
/// subnormal error.
#[inline(always)]
pub(crate) fn two_product<const FUSED: bool, T: Number>(a: T, b: T) -> (T, T) {
    let product = a * b;
    if FUSED {
        return (product, a.multiply_add(b, product * -1.0));
    }
    let ((a_high, a_low), (b_high, b_low)) = (split(a), split(b));
    let error = ((a_high * b_high - product) + a_high * b_low + a_low * b_high) + a_low * b_low;
    (product, error)
}

/// The upper 26 bits of a double, and the rest.
#[inline(always)]
fn split<T: Number>(a: T) -> (T, T) {
    /// 2²⁷ + 1, after Veltkamp.
    const SPLITTER: f64 = 134_217_729.0;
    let shifted = a * SPLITTER;
    let high = shifted - (shifted - a);
    (high, a - high)
}

#[cfg(test)]
mod tests;
