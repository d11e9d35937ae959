//! Yes or no, eight times.

use std::ops::{BitAnd, BitAndAssign, BitOr, BitOrAssign, BitXor, BitXorAssign, Not};

use fearless_simd as library;
use fearless_simd::{ExtractToken, Select, Simd, SimdBase, SimdMask};

use super::doubles::{Operand, f64x8};

/// Lanes of [`f64x8`] in which something holds.
#[allow(
    non_camel_case_types,
    reason = "primitive types and those of std::simd are written like this"
)]
#[derive(Clone, Copy, Debug)]
#[repr(transparent)]
pub(crate) struct mask64x8<S: Simd>(pub(super) library::mask64x8<S>);

impl<S: Simd> mask64x8<S> {
    /// All lanes, or none.
    #[inline(always)]
    pub(crate) fn splat(simd: S, holds: bool) -> Self {
        leaf!(simd, Self(library::mask64x8::splat(simd, holds)))
    }

    /// The lanes of these bits, lane 0 in the lowest.
    #[inline(always)]
    pub(crate) fn from_bitmask(simd: S, bits: u64) -> Self {
        leaf!(simd, Self(library::mask64x8::from_bitmask(simd, bits)))
    }

    /// The level of the processor.
    #[inline(always)]
    fn simd(self) -> S {
        self.0.token()
    }

    /// One bit for each lane, lane 0 in the lowest; the others are 0.
    #[inline(always)]
    pub(crate) fn to_bitmask(self) -> u64 {
        leaf!(self.simd(), self.0.to_bitmask())
    }

    #[inline(always)]
    pub(crate) fn any_true(self) -> bool {
        leaf!(self.simd(), self.0.any_true())
    }

    #[inline(always)]
    pub(crate) fn all_true(self) -> bool {
        leaf!(self.simd(), self.0.all_true())
    }

    /// `holds` in the lanes of the mask, `otherwise` in the others.
    #[inline(always)]
    pub(crate) fn select<T: Selectable<S>>(self, holds: T, otherwise: T) -> T {
        T::select(self, holds, otherwise)
    }
}

/// Values that a mask can choose from, lane by lane.
pub(crate) trait Selectable<S: Simd> {
    fn select(mask: mask64x8<S>, holds: Self, otherwise: Self) -> Self;
}

impl<S: Simd> Selectable<S> for f64x8<S> {
    #[inline(always)]
    fn select(mask: mask64x8<S>, holds: Self, otherwise: Self) -> Self {
        leaf!(mask.simd(), Self(mask.0.select(holds.0, otherwise.0)))
    }
}

impl<S: Simd> Selectable<S> for mask64x8<S> {
    #[inline(always)]
    fn select(mask: Self, holds: Self, otherwise: Self) -> Self {
        leaf!(mask.simd(), Self(mask.0.select(holds.0, otherwise.0)))
    }
}

macro_rules! comparisons {
    ($($name:ident: $of:literal),*) => {
        impl<S: Simd> f64x8<S> {
            $(
                #[doc = concat!("The lanes whose number is ", $of, " the other one.")]
                #[inline(always)]
                pub(crate) fn $name(self, other: impl Operand<S>) -> mask64x8<S> {
                    let other = other.operand(self.simd());
                    leaf!(self.simd(), mask64x8(self.0.$name(other.0)))
                }
            )*
        }
    };
}
comparisons!(
    simd_lt: "less than",
    simd_le: "not greater than",
    simd_gt: "greater than",
    simd_ge: "not less than",
    simd_eq: "equal to",
    simd_ne: "not equal to"
);

macro_rules! operations {
    ($($Operation:ident::$name:ident, $Assigning:ident::$assigning:ident;)*) => {
        $(
            impl<S: Simd> $Operation for mask64x8<S> {
                type Output = Self;

                #[inline(always)]
                fn $name(self, other: Self) -> Self {
                    leaf!(self.simd(), Self(self.0.$name(other.0)))
                }
            }

            impl<S: Simd> $Assigning for mask64x8<S> {
                #[inline(always)]
                fn $assigning(&mut self, other: Self) {
                    *self = self.$name(other);
                }
            }
        )*
    };
}
operations!(
    BitAnd::bitand, BitAndAssign::bitand_assign;
    BitOr::bitor, BitOrAssign::bitor_assign;
    BitXor::bitxor, BitXorAssign::bitxor_assign;
);

impl<S: Simd> Not for mask64x8<S> {
    type Output = Self;

    #[inline(always)]
    fn not(self) -> Self {
        leaf!(self.simd(), Self(!self.0))
    }
}
