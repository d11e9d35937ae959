//! Tiles of a picture.

use crate::model::color::Color;
use crate::numeric::pair::three;

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
    /// Columns and rows of a tile, but for those at the right and lower edge of a picture, which
    /// may be smaller.
    pub(crate) const SIDE: u32 = 8;

    /// The number of its pixels.
    pub(crate) fn count(self) -> u64 {
        u64::from(self.width) * u64::from(self.height)
    }

    /// The rectangle cut into tiles from the left, for one as high as a tile.
    pub(crate) fn tiles(self) -> impl Iterator<Item = Self> {
        let end = self.col + self.width;
        let tile = move |col| Self {
            col,
            width: Self::SIDE.min(end - col),
            ..self
        };
        (self.col..end).step_by(Self::SIDE as usize).map(tile)
    }

    /// The pixels of the tile as (column, row), row by row.
    pub(crate) fn pixels(self) -> impl Iterator<Item = (u32, u32)> {
        (self.row..self.row + self.height)
            .flat_map(move |row| (self.col..self.col + self.width).map(move |col| (col, row)))
    }
}

/// [`Tile::SIDE`] as the length of a row.
const SIDE: usize = Tile::SIDE as usize;

/// The light of a tile's pixels, number by number.
#[derive(Clone, Debug)]
pub(crate) struct TileLight {
    rows: [RowLight; SIDE],
}

/// The light of a row of a tile's pixels.
#[derive(Clone, Copy, Debug)]
pub(crate) struct RowLight {
    /// Red, green, blue; gray has only the first.
    pub(crate) channels: [[f64; SIDE]; 3],
    /// Covered fractions.
    pub(crate) alpha: [f64; SIDE],
    pub(crate) errors: [f64; SIDE],
}

/// No light.
impl Default for TileLight {
    fn default() -> Self {
        let dark = RowLight {
            channels: [[0.0; SIDE]; 3],
            alpha: [0.0; SIDE],
            errors: [0.0; SIDE],
        };
        Self { rows: [dark; SIDE] }
    }
}

impl TileLight {
    /// Makes all pixels alike, and nothing cover them.
    pub(crate) fn fill(&mut self, color: Color, error: f64) {
        let row = RowLight {
            channels: three(color.to_array(), |channel| [channel; SIDE]),
            alpha: [0.0; SIDE],
            errors: [error; SIDE],
        };
        self.rows = [row; SIDE];
    }

    /// A row of pixels, counted from the tile's first.
    pub(crate) fn row(&self, row: u32) -> &RowLight {
        &self.rows[row as usize]
    }

    /// A row of pixels, to be written.
    pub(crate) fn row_mut(&mut self, row: u32) -> &mut RowLight {
        &mut self.rows[row as usize]
    }
}
