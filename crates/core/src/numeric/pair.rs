//! Pairs and triples.

/// What a function makes of both parts of a pair, in their order. The arrays' own `map` compiles to forty times as much code.
#[inline(always)]
pub(crate) fn both<T, U>([first, second]: [T; 2], mut of: impl FnMut(T) -> U) -> [U; 2] {
    let first = of(first);
    [first, of(second)]
}

/// The same of all parts of a triple.
#[inline(always)]
pub(crate) fn three<T, U>([first, second, third]: [T; 3], mut of: impl FnMut(T) -> U) -> [U; 3] {
    let first = of(first);
    let second = of(second);
    [first, second, of(third)]
}
