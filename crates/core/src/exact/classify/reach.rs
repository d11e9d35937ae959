//! The part of a sphere in a cell that a light reaches.

use std::ops::Range;

/// The way of a light to a sphere in a cell.
#[derive(Clone, Debug)]
pub(crate) enum Reach {
    /// The light reaches it nowhere.
    Nowhere,
    /// The light reaches it where none of these occluders is in the way.
    Past(Range<usize>),
}
