//! Eight doubles side by side.

use std::ops::{
    Add, AddAssign, Deref, DerefMut, Div, DivAssign, Mul, MulAssign, Neg, Sub, SubAssign,
};

use fearless_simd as library;
use fearless_simd::{Simd, SimdBase, SimdFloat, SimdFrom};

/// Numbers side by side.
pub(crate) const LANES: usize = 8;

/// The number of each lane.
pub(crate) const LANE_NUMBERS: [f64; LANES] = [0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0];

/// Eight doubles, for the level `S` of the processor.
///
/// An operation does to each lane what it does to a double, rounded once. A formula is computed as it
/// is written; no product is fused with a sum, but by [`Self::mul_add_precise`]. So a lane holds the
/// same bits at every level. A double in the place of eight stands for eight alike. Lanes are read and
/// written by index.
///
/// The compiler simplifies each operation once, and then puts it where it is used: see
/// [`super::leaf`].
#[allow(
    non_camel_case_types,
    reason = "primitive types and those of std::simd are written like this"
)]
#[derive(Clone, Copy, Debug)]
#[repr(transparent)]
pub(crate) struct f64x8<S: Simd>(pub(super) library::f64x8<S>);

impl<S: Simd> f64x8<S> {
    /// This number in every lane.
    #[inline(always)]
    pub(crate) fn splat(simd: S, number: f64) -> Self {
        leaf!(simd, Self(library::f64x8::splat(simd, number)))
    }

    /// These numbers, the first one in lane 0.
    #[inline(always)]
    pub(crate) fn from_array(simd: S, numbers: [f64; LANES]) -> Self {
        leaf!(simd, Self(library::f64x8::simd_from(simd, numbers)))
    }

    /// The first eight numbers of a slice that has as many.
    #[inline(always)]
    pub(crate) fn from_slice(simd: S, numbers: &[f64]) -> Self {
        leaf!(
            simd,
            Self(library::f64x8::from_slice(simd, &numbers[..LANES]))
        )
    }

    /// The level of the processor.
    #[inline(always)]
    pub(crate) fn simd(self) -> S {
        self.0.simd
    }

    /// The square roots, correctly rounded.
    #[inline(always)]
    pub(crate) fn sqrt(self) -> Self {
        leaf!(self.simd(), Self(self.0.sqrt()))
    }

    #[inline(always)]
    pub(crate) fn abs(self) -> Self {
        leaf!(self.simd(), Self(self.0.abs()))
    }

    /// The greatest whole numbers that are not greater.
    #[inline(always)]
    pub(crate) fn floor(self) -> Self {
        leaf!(self.simd(), Self(self.0.floor()))
    }

    /// The least whole numbers that are not less.
    #[inline(always)]
    pub(crate) fn ceil(self) -> Self {
        leaf!(self.simd(), Self(self.0.ceil()))
    }

    /// The greater numbers; any of the two where one is no number.
    #[inline(always)]
    pub(crate) fn max(self, other: impl Operand<S>) -> Self {
        let other = other.operand(self.simd());
        leaf!(self.simd(), Self(self.0.max(other.0)))
    }

    /// The lesser numbers; any of the two where one is no number.
    #[inline(always)]
    pub(crate) fn min(self, other: impl Operand<S>) -> Self {
        let other = other.operand(self.simd());
        leaf!(self.simd(), Self(self.0.min(other.0)))
    }

    /// `self · factor + term`, rounded once; slow where the processor has no such operation.
    #[inline(always)]
    pub(crate) fn mul_add_precise(self, factor: Self, term: Self) -> Self {
        leaf!(self.simd(), Self(self.0.mul_add_precise(factor.0, term.0)))
    }

    /// Lanes `SHIFT` to 7, and behind them the first `SHIFT` lanes of `rest`.
    #[inline(always)]
    pub(crate) fn slide<const SHIFT: usize>(self, rest: Self) -> Self {
        leaf!(self.simd(), Self(self.0.slide::<SHIFT>(rest.0)))
    }
}

/// An operand of a comparison with eight doubles.
pub(crate) trait Operand<S: Simd> {
    fn operand(self, simd: S) -> f64x8<S>;
}

impl<S: Simd> Operand<S> for f64x8<S> {
    #[inline(always)]
    fn operand(self, _: S) -> Self {
        self
    }
}

impl<S: Simd> Operand<S> for f64 {
    #[inline(always)]
    fn operand(self, simd: S) -> f64x8<S> {
        f64x8::splat(simd, self)
    }
}

macro_rules! operations {
    ($($Operation:ident::$name:ident, $Assigning:ident::$assigning:ident;)*) => {
        $(
            impl<S: Simd> $Operation for f64x8<S> {
                type Output = Self;

                #[inline(always)]
                fn $name(self, other: Self) -> Self {
                    leaf!(self.simd(), Self(self.0.$name(other.0)))
                }
            }

            impl<S: Simd> $Operation<f64> for f64x8<S> {
                type Output = Self;

                #[inline(always)]
                fn $name(self, other: f64) -> Self {
                    leaf!(self.simd(), Self(self.0.$name(other)))
                }
            }

            impl<S: Simd> $Operation<f64x8<S>> for f64 {
                type Output = f64x8<S>;

                #[inline(always)]
                fn $name(self, other: f64x8<S>) -> f64x8<S> {
                    leaf!(other.simd(), f64x8(self.$name(other.0)))
                }
            }

            impl<S: Simd> $Assigning for f64x8<S> {
                #[inline(always)]
                fn $assigning(&mut self, other: Self) {
                    *self = self.$name(other);
                }
            }

            impl<S: Simd> $Assigning<f64> for f64x8<S> {
                #[inline(always)]
                fn $assigning(&mut self, other: f64) {
                    *self = self.$name(other);
                }
            }
        )*
    };
}
operations!(
    Add::add, AddAssign::add_assign;
    Sub::sub, SubAssign::sub_assign;
    Mul::mul, MulAssign::mul_assign;
    Div::div, DivAssign::div_assign;
);

impl<S: Simd> Neg for f64x8<S> {
    type Output = Self;

    #[inline(always)]
    fn neg(self) -> Self {
        leaf!(self.simd(), Self(-self.0))
    }
}

impl<S: Simd> Deref for f64x8<S> {
    type Target = [f64; LANES];

    #[inline(always)]
    fn deref(&self) -> &[f64; LANES] {
        &self.0
    }
}

impl<S: Simd> DerefMut for f64x8<S> {
    #[inline(always)]
    fn deref_mut(&mut self) -> &mut [f64; LANES] {
        &mut self.0
    }
}

impl<S: Simd> From<f64x8<S>> for [f64; LANES] {
    #[inline(always)]
    fn from(lanes: f64x8<S>) -> Self {
        *lanes
    }
}
