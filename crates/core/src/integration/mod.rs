//! The integral of light over a pixel.
//!
//! An [`Integrator`] answers for every pixel of a tile what its value is, how far that may be
//! from the exact area average, and how its work ended.

mod supersampling;

pub(crate) use supersampling::Supersampling;

use crate::Radiance;

/// A rectangle of pixels that are worked on together.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub struct Tile {
    /// First column.
    pub col: u32,
    /// First row.
    pub row: u32,
    /// Number of columns.
    pub width: u32,
    /// Number of rows.
    pub height: u32,
}

impl Tile {
    /// The pixels of the tile as (column, row), row by row.
    pub fn pixels(self) -> impl Iterator<Item = (u32, u32)> {
        (self.row..self.row + self.height)
            .flat_map(move |row| (self.col..self.col + self.width).map(move |col| (col, row)))
    }
}

/// What is known of a pixel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pixel<C> {
    /// Average of the light over the pixel's square.
    pub value: C,
    /// Fraction of the pixel's square that spheres cover.
    pub alpha: f64,
    /// How far value and alpha may be from the exact averages, in any channel; infinite where
    /// nothing is known.
    pub error: f64,
    /// How the work on the pixel ended.
    pub status: Status,
}

/// How the work on a pixel ended.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
#[non_exhaustive]
pub enum Status {
    /// No tolerance was asked for; the error is an estimate.
    NoTolerance,
}

impl Status {
    /// Whether a tolerance was asked for and not met.
    pub fn is_over_tolerance(self) -> bool {
        match self {
            Self::NoTolerance => false,
        }
    }
}

/// A way to average light over pixels.
pub trait Integrator<C: Radiance>: Sync {
    /// Appends the tile's pixels to `pixels`, in the order of [`Tile::pixels`].
    fn integrate(&self, tile: Tile, pixels: &mut Vec<Pixel<C>>);
}
