//! The compilation of operations on lanes.

/// One operation on lanes, as a function of its own that is compiled for a level of the processor.
///
/// Below AVX-512 an operation on eight doubles is put together from such on two or four, which takes
/// hundreds of lines of intermediate code. Were these inlined from the start, each use of the operation
/// would have to be simplified anew. As a function the operation is simplified once. The compiler
/// inlines it afterwards, as one or a few instructions.
macro_rules! leaf {
    ($simd:expr, $operation:expr) => {
        fearless_simd::Simd::vectorize(
            $simd,
            #[inline(always)]
            || $operation,
        )
    };
}
