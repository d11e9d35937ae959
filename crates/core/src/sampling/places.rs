//! The places in a tile whose samples are taken together.

use super::rays::Place;
use super::tile_balls::TileBall;
use crate::numeric::bits::set_bits;
use crate::picture::tile::Tile;

/// Rows of a tile, and the most places.
pub(super) const ROWS: usize = Tile::SIDE as usize;

/// Up to eight places in a tile, of eight samples each.
pub(super) struct Places {
    list: [Place; ROWS],
    count: usize,
    balls: BallsOf,
}

/// The places, as bits, at which a ball of the tile may be seen.
enum BallsOf {
    /// One place in each row of the tile.
    Rows,
    /// All places, of the only pixel.
    Pixel,
    /// Places in a row of the tile, counted from the first: those in each of its columns, as bits.
    Row { row: u32, of_column: [u8; ROWS] },
}

impl Places {
    /// The same cells of each pixel in so many rows.
    pub(super) fn rows(mut place: Place, height: u32) -> Self {
        let mut list = [place; ROWS];
        for of_row in &mut list {
            *of_row = place;
            place.row += 1;
        }
        Self {
            list,
            count: height as usize,
            balls: BallsOf::Rows,
        }
    }

    /// One place, in the only pixel of a tile.
    pub(super) fn one(place: Place) -> Self {
        Self {
            list: [place; ROWS],
            count: 1,
            balls: BallsOf::Pixel,
        }
    }

    /// No places yet, in a row of a tile.
    pub(super) fn in_row(place: Place, row: u32) -> Self {
        Self {
            list: [place; ROWS],
            count: 0,
            balls: BallsOf::Row {
                row,
                of_column: [0; ROWS],
            },
        }
    }

    /// Adds a place in a column of the tile, counted from the first.
    pub(super) fn add(&mut self, place: Place, column: u32) {
        if let BallsOf::Row { of_column, .. } = &mut self.balls {
            of_column[column as usize] |= 1 << self.count;
        }
        self.list[self.count] = place;
        self.count += 1;
    }

    /// Takes all places away.
    pub(super) fn clear(&mut self) {
        self.count = 0;
        if let BallsOf::Row { of_column, .. } = &mut self.balls {
            *of_column = [0; ROWS];
        }
    }

    /// The first place, which is also there if there are none.
    pub(super) fn first(&self) -> Place {
        self.list[0]
    }

    pub(super) fn as_slice(&self) -> &[Place] {
        &self.list[..self.count]
    }

    pub(super) fn is_full(&self) -> bool {
        self.count == ROWS
    }

    /// The places, as bits, that may see a ball.
    #[inline(always)]
    pub(super) fn of_ball(&self, ball: &TileBall) -> u8 {
        match &self.balls {
            BallsOf::Rows => ball.rows,
            BallsOf::Pixel => u8::MAX,
            BallsOf::Row { row, of_column } => {
                let mut places = 0;
                if ball.rows >> row & 1 == 1 {
                    for column in set_bits(u64::from(ball.columns)) {
                        places |= of_column[column % ROWS];
                    }
                }
                places
            }
        }
    }
}
