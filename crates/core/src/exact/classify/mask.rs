//! Coverage masks: a square in seven by seven smaller ones, a bit each, a byte a row.

/// Squares on a side: their corners, eight a row, fill the lanes and the bytes.
pub(super) const SIDE: usize = 7;

/// All squares.
pub(super) const ALL: u64 = 0x007f_7f7f_7f7f_7f7f;

/// The squares all of whose corners are in a set; of these there are eight a row, a bit each.
pub(super) fn between(corners: u64) -> u64 {
    let pairs = corners & corners >> 1;
    pairs & pairs >> 8 & ALL
}
