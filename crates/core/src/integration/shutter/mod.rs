//! The average of a pixel over the time that the shutter is open, too.

mod exact;
mod instants;
mod pace;
mod panel;
mod sampled;

pub(crate) use exact::ExactOverTime;
pub(crate) use instants::Instants;
pub(crate) use sampled::SampledOverTime;

use crate::Tile;

/// Columns that are worked on together: what is seen at a moment may have to be found out for each
/// of these anew.
const COLUMNS: u32 = 1024;

/// A rectangle in parts that are worked on together.
fn parts(area: Tile) -> impl Iterator<Item = Tile> {
    let end = area.col + area.width;
    let part = move |col| Tile {
        col,
        width: COLUMNS.min(end - col),
        ..area
    };
    (area.col..end).step_by(COLUMNS as usize).map(part)
}

#[cfg(test)]
mod tests;
