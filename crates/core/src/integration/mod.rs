//! The integral of light over a pixel.
//!
//! An [`Integrator`] answers for every pixel of a tile what its value is, how far that may be
//! from the exact area average, and how its work ended.

mod kronrod;
mod shutter;
mod supersampling;
mod tolerance;

pub(crate) use shutter::{ExactOverTime, Instants, SampledOverTime};
pub(crate) use supersampling::Supersampling;
pub(crate) use tolerance::Exact;

use std::ops::{AddAssign, ControlFlow};

use crate::image::Band;
use crate::{Cancelled, Radiance, Tile};

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
    /// What the error is worth.
    pub(crate) evidence: Evidence,
    /// How the work on the pixel ended.
    pub(crate) status: Status,
}

/// What stands behind an error.
#[derive(Clone, Copy, Debug, Eq, Ord, PartialEq, PartialOrd)]
pub enum Evidence {
    /// It is inferred from rules and samples that agree.
    Estimate,
    /// It is proved.
    Bound,
}

/// What pixels cost, counted.
#[derive(Clone, Copy, Debug, Default, Eq, PartialEq)]
#[non_exhaustive]
pub struct Work {
    /// Points at which light, or the normal of a rough surface, was computed.
    pub samples: u64,
    /// Lines that were cut where something happens on them.
    pub lines: u64,
    /// Spheres that were asked whether a pixel, or a ray, may see them, or whether they may keep a
    /// light from what a tile, a pixel or a part of one sees.
    pub candidate_tests: u64,
}

impl AddAssign for Work {
    fn add_assign(&mut self, other: Self) {
        self.samples += other.samples;
        self.lines += other.lines;
        self.candidate_tests += other.candidate_tests;
    }
}

/// How the work on a pixel ended.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
#[non_exhaustive]
pub enum Status {
    /// No tolerance was asked for; the error is an estimate.
    NoTolerance,
    /// The error is within the tolerance.
    Met,
    /// The tolerance is not met, and most of the error is that of rounding.
    AtRoundoff,
    /// The tolerance is not met: the work that a pixel may cost did not suffice, or numbers are so
    /// extreme that edges are not found in doubles. Where edges were given up, samples tell value and
    /// error: a guess, as they miss what lies between them.
    OutOfBudget,
}

impl Status {
    /// Whether a tolerance was asked for and not met.
    pub fn is_over_tolerance(self) -> bool {
        match self {
            Self::NoTolerance | Self::Met => false,
            Self::AtRoundoff | Self::OutOfBudget => true,
        }
    }
}

/// A way to average light over pixels.
pub(crate) trait Integrator<C: Radiance>: Send + Sync {
    /// Memory to work in, used again for tile after tile.
    type Room: Default;

    /// Appends the tile's pixels to `pixels`, in the order of [`Tile::pixels`]; what they cost.
    fn integrate(&self, tile: Tile, room: &mut Self::Room, pixels: &mut Vec<Pixel<C>>) -> Work;

    /// Writes the tile's pixels into the band of a picture that contains it; what they cost.
    fn paint(&self, tile: Tile, room: &mut Self::Room, band: &mut Band<'_>) -> Work {
        let mut pixels = Vec::with_capacity((tile.width * tile.height) as usize);
        let work = self.integrate(tile, room, &mut pixels);
        band.write(tile, &pixels);
        work
    }

    /// Writes all pixels of a band; what they cost. `progress` is told of pixels that are done, of none
    /// now and then; when it breaks the work ends.
    fn paint_band(
        &self,
        band: &mut Band<'_>,
        room: &mut Self::Room,
        progress: &(dyn Fn(u64) -> ControlFlow<()> + Sync),
    ) -> Result<Work, Cancelled> {
        let mut work = Work::default();
        for tile in band.area.tiles() {
            work += self.paint(tile, room, band);
            if progress(tile.count()).is_break() {
                return Err(Cancelled);
            }
        }
        Ok(work)
    }
}
