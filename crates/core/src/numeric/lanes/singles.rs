//! Eight single-precision numbers side by side.

use std::ops::{Add, BitAnd, BitAndAssign, BitOr, Mul, Not, Sub};

use fearless_simd as library;
use fearless_simd::{ExtractToken, Select, Simd, SimdBase, SimdFloat, SimdFrom, SimdMask};

use super::LANES;

/// Eight numbers in single precision, for the level `S` of the processor: as [`super::f64x8`].
#[allow(
    non_camel_case_types,
    reason = "primitive types and those of std::simd are written like this"
)]
#[derive(Clone, Copy, Debug)]
#[repr(transparent)]
pub(crate) struct f32x8<S: Simd>(library::f32x8<S>);

/// Lanes of [`f32x8`] in which something holds.
#[allow(
    non_camel_case_types,
    reason = "primitive types and those of std::simd are written like this"
)]
#[derive(Clone, Copy, Debug)]
#[repr(transparent)]
pub(crate) struct mask32x8<S: Simd>(library::mask32x8<S>);

impl<S: Simd> f32x8<S> {
    /// This number in every lane.
    #[inline(always)]
    pub(crate) fn splat(simd: S, number: f32) -> Self {
        leaf!(simd, Self(library::f32x8::splat(simd, number)))
    }

    /// These numbers, the first one in lane 0.
    #[inline(always)]
    pub(crate) fn from_array(simd: S, numbers: [f32; LANES]) -> Self {
        leaf!(simd, Self(library::f32x8::simd_from(simd, numbers)))
    }

    /// Eight numbers of a slice, from a place on.
    #[inline(always)]
    pub(crate) fn read(simd: S, numbers: &[f32], place: usize) -> Self {
        let numbers = &numbers[place..place + LANES];
        leaf!(simd, Self(library::f32x8::from_slice(simd, numbers)))
    }

    /// Writes them to a slice, from a place on.
    #[inline(always)]
    pub(crate) fn write(self, numbers: &mut [f32], place: usize) {
        let numbers = &mut numbers[place..place + LANES];
        leaf!(self.0.simd, self.0.store_slice(numbers));
    }

    /// The square roots, correctly rounded.
    #[inline(always)]
    pub(crate) fn sqrt(self) -> Self {
        leaf!(self.0.simd, Self(self.0.sqrt()))
    }

    #[inline(always)]
    pub(crate) fn abs(self) -> Self {
        leaf!(self.0.simd, Self(self.0.abs()))
    }

    /// 1 over the numbers, correctly rounded.
    #[inline(always)]
    pub(crate) fn reciprocal(self) -> Self {
        leaf!(self.0.simd, Self(1.0 / self.0))
    }

    /// The greater numbers; any of the two where one is no number.
    #[inline(always)]
    pub(crate) fn max(self, other: Self) -> Self {
        leaf!(self.0.simd, Self(self.0.max(other.0)))
    }

    /// The lesser numbers; any of the two where one is no number.
    #[inline(always)]
    pub(crate) fn min(self, other: Self) -> Self {
        leaf!(self.0.simd, Self(self.0.min(other.0)))
    }
}

impl<S: Simd> mask32x8<S> {
    /// One bit for each lane, lane 0 in the lowest; the others are 0.
    #[inline(always)]
    pub(crate) fn to_bitmask(self) -> u64 {
        leaf!(self.0.token(), self.0.to_bitmask())
    }

    #[inline(always)]
    pub(crate) fn any_true(self) -> bool {
        leaf!(self.0.token(), self.0.any_true())
    }

    /// `holds` in the lanes of the mask, `otherwise` in the others.
    #[inline(always)]
    pub(crate) fn select(self, holds: f32x8<S>, otherwise: f32x8<S>) -> f32x8<S> {
        leaf!(self.0.token(), f32x8(self.0.select(holds.0, otherwise.0)))
    }
}

/// An operand of a comparison with eight numbers.
pub(crate) trait Operand<S: Simd> {
    fn operand(self, simd: S) -> f32x8<S>;
}

impl<S: Simd> Operand<S> for f32x8<S> {
    #[inline(always)]
    fn operand(self, _: S) -> Self {
        self
    }
}

impl<S: Simd> Operand<S> for f32 {
    #[inline(always)]
    fn operand(self, simd: S) -> f32x8<S> {
        f32x8::splat(simd, self)
    }
}

macro_rules! operations {
    ($($Operation:ident::$name:ident;)*) => {
        $(
            impl<S: Simd> $Operation for f32x8<S> {
                type Output = Self;

                #[inline(always)]
                fn $name(self, other: Self) -> Self {
                    leaf!(self.0.simd, Self(self.0.$name(other.0)))
                }
            }

            impl<S: Simd> $Operation<f32> for f32x8<S> {
                type Output = Self;

                #[inline(always)]
                fn $name(self, other: f32) -> Self {
                    leaf!(self.0.simd, Self(self.0.$name(other)))
                }
            }
        )*
    };
}
operations!(
    Add::add;
    Sub::sub;
    Mul::mul;
);

macro_rules! comparisons {
    ($($name:ident: $of:literal),*) => {
        impl<S: Simd> f32x8<S> {
            $(
                #[doc = concat!("The lanes whose number is ", $of, " the other one.")]
                #[inline(always)]
                pub(crate) fn $name(self, other: impl Operand<S>) -> mask32x8<S> {
                    let other = other.operand(self.0.simd);
                    leaf!(self.0.simd, mask32x8(self.0.$name(other.0)))
                }
            )*
        }
    };
}
comparisons!(simd_lt: "less than", simd_gt: "greater than", simd_eq: "equal to");

macro_rules! choices {
    ($($Operation:ident::$name:ident;)*) => {
        $(
            impl<S: Simd> $Operation for mask32x8<S> {
                type Output = Self;

                #[inline(always)]
                fn $name(self, other: Self) -> Self {
                    leaf!(self.0.token(), Self(self.0.$name(other.0)))
                }
            }
        )*
    };
}
choices!(
    BitAnd::bitand;
    BitOr::bitor;
);

impl<S: Simd> BitAndAssign for mask32x8<S> {
    #[inline(always)]
    fn bitand_assign(&mut self, other: Self) {
        *self = *self & other;
    }
}

impl<S: Simd> Not for mask32x8<S> {
    type Output = Self;

    #[inline(always)]
    fn not(self) -> Self {
        leaf!(self.0.token(), Self(!self.0))
    }
}
