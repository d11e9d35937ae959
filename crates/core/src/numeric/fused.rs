//! Multiplication and addition in one operation, where the processor has it.

use fearless_simd::Simd;

/// True where code compiled for this level has fused multiplication and addition; known when it is
/// compiled.
#[inline(always)]
pub(crate) fn is_fused<S: Simd>(simd: S) -> bool {
    #[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
    return simd.level().as_avx2().is_some();
    #[cfg(not(any(target_arch = "x86", target_arch = "x86_64")))]
    return cfg!(target_arch = "aarch64") && !simd.level().is_fallback();
}
