//! The order of numbers.

/// Sorts pairs by their numbers, and those with equal ones by what comes with them.
///
/// Sorting each kind of elements compiles to as much code as a thousand lines of this crate.
pub(crate) fn sort_by_number(pairs: &mut [(f64, usize)]) {
    pairs.sort_unstable_by(|one, other| one.0.total_cmp(&other.0).then(one.1.cmp(&other.1)));
}
