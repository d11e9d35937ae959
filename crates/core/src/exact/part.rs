//! Integrals over parts of a pixel, and the reasons for which there is none.

use crate::model::color::Color;

/// An integral over a part of a cell whose area is 1.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Part {
    pub(crate) value: Color,
    pub(crate) covered: f64,
    pub(crate) error: f64,
    /// The share of the error that comes from rounding.
    pub(crate) rounding: f64,
}

impl Part {
    pub(crate) const NOTHING: Self = Self {
        value: Color::ZERO,
        covered: 0.0,
        error: 0.0,
        rounding: 0.0,
    };

    pub(crate) fn add(&mut self, other: &Self, share: f64) {
        self.value += other.value * share;
        self.covered += other.covered * share;
        self.error += other.error * share;
        self.rounding += other.rounding * share;
    }

    /// The distance of another integral over the same cell from this one.
    fn distance_from(&self, other: &Self) -> f64 {
        let off = (self.value - other.value).abs().max_element();
        off.max((self.covered - other.covered).abs())
    }

    /// Whether another integral over the same is farther away than both claim.
    pub(crate) fn differs_from(&self, other: &Self) -> bool {
        self.distance_from(other) > self.error + other.error
    }

    /// The same, which claims at least to be as far off as another one is.
    pub(crate) fn or_as_far_as(&self, other: &Self) -> Self {
        Self {
            error: self.error.max(self.distance_from(other)),
            ..*self
        }
    }

    /// The same, which claims as much more as another one by smaller parts is away: the larger claim of these is then no
    /// argument for this one.
    pub(crate) fn doubted_by(&self, finer: &Self) -> Self {
        Self {
            error: self.error + self.distance_from(finer),
            ..*self
        }
    }
}

/// The reason for which a rung leaves a pixel, or a part of one, to the next rung.
#[derive(Clone, Copy, Debug)]
pub(crate) enum GiveUp {
    /// A highlight is so narrow that a rule along a chord may step over it.
    Narrow,
    /// Bumps are so fine that rules overlook some of them.
    Bumps,
    /// Something is not a finite number.
    NotFinite,
    /// More may be wrong than the tolerance allows; this is known.
    Claims(Part),
    /// Less is known than samples see.
    Unknown,
}
