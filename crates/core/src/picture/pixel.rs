//! Pixels, the ways to average them, and what is known of them.

use std::num::NonZeroU32;
use std::ops::AddAssign;

use crate::model::color::Color;

/// The way to average pixels.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Method {
    /// Over the midpoints of an N × N division of every pixel.
    Samples(NonZeroU32),
    /// Between known edges, until every channel of every pixel is within this of the exact average.
    Tolerance(f64),
}

/// The tolerance 1e-3.
impl Default for Method {
    fn default() -> Self {
        Self::Tolerance(1e-3)
    }
}

/// The average of a pixel, and how well it is known.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Pixel {
    /// Average of the light over the pixel's square; in a world without color all channels are the same.
    pub(crate) value: Color,
    /// Fraction of the pixel's square that spheres cover.
    pub(crate) alpha: f64,
    /// The largest distance of value and alpha from the exact averages, in any channel; infinite
    /// where nothing is known.
    pub(crate) error: f64,
    /// The worth of the error.
    pub(crate) evidence: Evidence,
    /// The end of the work on the pixel.
    pub(crate) status: Status,
}

/// The foundation of an error.
#[derive(Clone, Copy, Debug, Eq, Ord, PartialEq, PartialOrd)]
pub enum Evidence {
    /// It is inferred from rules and samples that agree.
    Estimate,
    /// It is proved.
    Bound,
}

/// The work on pixels, counted.
#[derive(Clone, Copy, Debug, Default, Eq, PartialEq)]
#[non_exhaustive]
pub struct Work {
    /// Points at which light, or the normal of a rough surface, was computed.
    pub samples: u64,
    /// Lines through pixels with edges that light was summed up along.
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

/// The end of the work on a pixel.
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
    /// extreme that edges are not found in doubles. Where edges were given up, samples tell the
    /// value, and the error is the contrast of all that the pixel may show.
    OutOfBudget,
}

impl Status {
    /// True where a tolerance was asked for and not met.
    pub fn is_over_tolerance(self) -> bool {
        match self {
            Self::NoTolerance | Self::Met => false,
            Self::AtRoundoff | Self::OutOfBudget => true,
        }
    }
}
