//! The order of numbers.

/// Sorts pairs by their numbers, and those with equal ones by what comes with them.
///
/// One function for all: each kind of elements that is sorted compiles to some 4,000 lines of generated code.
pub(crate) fn sort_by_number(pairs: &mut [(f64, usize)]) {
    pairs.sort_unstable_by(|one, other| one.0.total_cmp(&other.0).then(one.1.cmp(&other.1)));
}
