//! Multiplication and addition in one operation, where the processor has it.

use fearless_simd::{Simd, SimdBase};

/// Returns whether code that is compiled for this level has fused multiplication and addition.
///
/// A constant of the level: the compiler leaves out the branch that is not taken before it translates
/// what the branch calls.
#[inline(always)]
pub(crate) fn is_fused<S: Simd>(_: S) -> bool {
    S::IS_FUSED
}

/// The constant of [`is_fused`].
trait Fused {
    const IS_FUSED: bool;
}

impl<S: Simd> Fused for S {
    /// x86 has these operations from AVX2 on, whose registers hold four doubles; 64-bit ARM always does.
    const IS_FUSED: bool = cfg!(target_arch = "aarch64")
        || cfg!(any(target_arch = "x86", target_arch = "x86_64")) && S::f64s::LEN >= 4;
}
