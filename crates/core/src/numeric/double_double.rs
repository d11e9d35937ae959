//! Numbers of twice the precision of a double.

use std::ops::{Add, Div, Mul, Neg, Sub};

use super::rounding::{fast_two_sum, two_product, two_sum};

/// An unevaluated sum of two doubles, the second at most half a unit in the last place of the
/// first: about 106 bits.
///
/// `FUSED` says how products are made, see [`two_product`]; it does not change any result, as long
/// as no product comes near to underflow.
///
/// # Accuracy
/// Relative errors, with u = 2⁻⁵³ and without over- or underflow: sums 3u² + 13u³, products 5u²,
/// quotients 15u² + 56u³, roots 4u².
///
/// # Source
/// M. Joldes, J.-M. Muller, V. Popescu, Tight and rigorous error bounds for basic building blocks
/// of double-word arithmetic, ACM TOMS 44, 2017: algorithms 6, 10 and 17. The root: V. Lefèvre,
/// N. Louvet, J.-M. Muller, J. Picot, L. Rideau, Accurate calculation of Euclidean norms using
/// double-word arithmetic, ACM TOMS 49, 2023.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct DoubleDouble<const FUSED: bool> {
    pub(crate) high: f64,
    pub(crate) low: f64,
}

impl<const FUSED: bool> DoubleDouble<FUSED> {
    /// The exact product of two doubles.
    #[inline(always)]
    pub(crate) fn product(a: f64, b: f64) -> Self {
        let (high, low) = two_product::<FUSED, f64>(a, b);
        Self { high, low }
    }

    /// Normalizes a sum of two doubles, the first the larger.
    #[inline(always)]
    pub(crate) fn from_parts((high, low): (f64, f64)) -> Self {
        let (high, low) = fast_two_sum(high, low);
        Self { high, low }
    }

    /// The square root of a number greater than 0.
    #[inline(always)]
    pub(crate) fn sqrt(self) -> Self {
        let root = self.high.sqrt();
        let rest = self - Self::product(root, root);
        Self::from_parts((root, rest.high / (2.0 * root)))
    }
}

impl<const FUSED: bool> From<f64> for DoubleDouble<FUSED> {
    #[inline(always)]
    fn from(high: f64) -> Self {
        Self { high, low: 0.0 }
    }
}

impl<const FUSED: bool> Neg for DoubleDouble<FUSED> {
    type Output = Self;

    #[inline(always)]
    fn neg(self) -> Self {
        Self {
            high: -self.high,
            low: -self.low,
        }
    }
}

impl<const FUSED: bool> Add for DoubleDouble<FUSED> {
    type Output = Self;

    #[inline(always)]
    fn add(self, other: Self) -> Self {
        let (high, error) = two_sum(self.high, other.high);
        let (low, low_error) = two_sum(self.low, other.low);
        let (high, error) = fast_two_sum(high, error + low);
        Self::from_parts((high, error + low_error))
    }
}

impl<const FUSED: bool> Sub for DoubleDouble<FUSED> {
    type Output = Self;

    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        self + -other
    }
}

impl<const FUSED: bool> Mul for DoubleDouble<FUSED> {
    type Output = Self;

    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        let (high, error) = two_product::<FUSED, f64>(self.high, other.high);
        let cross = self.high * other.low + self.low * other.high;
        Self::from_parts((high, error + cross))
    }
}

impl<const FUSED: bool> Div for DoubleDouble<FUSED> {
    type Output = Self;

    #[inline(always)]
    fn div(self, other: Self) -> Self {
        let quotient = self.high / other.high;
        let rest = self - other * Self::from(quotient);
        Self::from_parts((quotient, rest.high / other.high))
    }
}
