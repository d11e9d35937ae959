//! Pairs.

/// What a function makes of both parts of a pair, in their order. The arrays' own `map` compiles to forty times as much code.
#[inline(always)]
pub(crate) fn both<T, U>([first, second]: [T; 2], mut of: impl FnMut(T) -> U) -> [U; 2] {
    let first = of(first);
    [first, of(second)]
}
