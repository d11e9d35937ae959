//! Tiles of a picture.

/// A rectangle of pixels that are worked on together.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub(crate) struct Tile {
    /// First column.
    pub(crate) col: u32,
    /// First row.
    pub(crate) row: u32,
    /// Number of columns.
    pub(crate) width: u32,
    /// Number of rows.
    pub(crate) height: u32,
}

impl Tile {
    /// The pixels of the tile as (column, row), row by row.
    pub(crate) fn pixels(self) -> impl Iterator<Item = (u32, u32)> {
        (self.row..self.row + self.height)
            .flat_map(move |row| (self.col..self.col + self.width).map(move |col| (col, row)))
    }
}
