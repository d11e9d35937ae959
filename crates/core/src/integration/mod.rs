//! The integral of light over a pixel.
//!
//! An [`Integrator`] answers for every pixel of a tile what its value is, how far that may be
//! from the exact area average, and how its work ended.

mod lines;
mod supersampling;

pub(crate) use lines::Lines;
pub(crate) use supersampling::Supersampling;

use crate::{Radiance, Tile};

/// What is known of a pixel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Pixel<C> {
    /// Average of the light over the pixel's square.
    pub(crate) value: C,
    /// Fraction of the pixel's square that spheres cover.
    pub(crate) alpha: f64,
    /// How far value and alpha may be from the exact averages, in any channel; infinite where
    /// nothing is known.
    pub(crate) error: f64,
    /// How the work on the pixel ended.
    pub(crate) status: Status,
}

/// How the work on a pixel ended.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
#[non_exhaustive]
pub enum Status {
    /// No tolerance was asked for; the error is an estimate.
    NoTolerance,
    /// The error, an estimate, is within the tolerance.
    Met,
    /// The work that a pixel may cost did not suffice.
    OutOfBudget,
}

impl Status {
    /// Whether a tolerance was asked for and not met.
    pub fn is_over_tolerance(self) -> bool {
        match self {
            Self::NoTolerance | Self::Met => false,
            Self::OutOfBudget => true,
        }
    }
}

/// A way to average light over pixels.
pub(crate) trait Integrator<C: Radiance>: Sync {
    /// Appends the tile's pixels to `pixels`, in the order of [`Tile::pixels`].
    fn integrate(&self, tile: Tile, pixels: &mut Vec<Pixel<C>>);
}
