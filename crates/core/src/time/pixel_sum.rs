//! The average of a pixel over panels of time, and the choice of those that are halved.

use super::contrast::Contrast;
use super::panel::{Panel, Part};
use super::panel_levels::FirstPanels;
use crate::exact::budget::MOST_OVER_TIME;
use crate::model::color::Color;
use crate::picture::pixel::{Evidence, Pixel, Status};

/// The share of the tolerance that the integral over area may take at each moment. Not tuned: the
/// rest is left to time.
pub(super) const SHARE_OF_AREA: f64 = 0.5;

/// A pixel is given up when it has been integrated over so many panels, and four times as many as it
/// began with. Not tuned: it bounds the time that a pixel may take.
const MOST_PANELS: usize = 256;

/// The sums over a pixel's panels.
pub(super) struct PixelSum {
    /// The first panel's, from which differences are taken, so that what never changes is itself.
    first: Option<(Color, f64)>,
    /// The sum over the panels that will not be halved.
    value: Color,
    alpha: f64,
    area_error: f64,
    time_error: f64,
    is_lost: bool,
    /// The error by what is missed between all moments, a part of that over time.
    missed: f64,
    /// Those that may be.
    open: Vec<Part>,
    /// The number of panels that it was integrated over, and the most that it may be.
    panels: usize,
    most_panels: usize,
    /// The units that they have cost.
    units: u64,
    /// True where its first panels are as short as they should be.
    is_fine: bool,
}

impl PixelSum {
    /// Nothing is known yet of a pixel that begins with such panels.
    pub(super) fn new(first: FirstPanels, contrast: &Contrast) -> Self {
        let missed = if first.missed < 1.0 {
            contrast.ordinary * first.missed
        } else {
            contrast.most
        };
        Self {
            first: None,
            value: Color::ZERO,
            alpha: 0.0,
            area_error: 0.0,
            time_error: missed,
            is_lost: false,
            missed,
            open: Vec::new(),
            panels: 0,
            units: 0,
            most_panels: MOST_PANELS + (4 << first.level),
            is_fine: first.is_fine,
        }
    }

    /// Adds the average over a panel.
    pub(super) fn add(&mut self, part: Part) {
        self.first.get_or_insert((part.value, part.alpha));
        self.panels += 1;
        self.units += part.units;
        self.open.push(part);
    }

    /// Counts a panel that will not be halved.
    fn settle(&mut self, part: &Part) {
        let (value, alpha) = self.first.unwrap_or((Color::ZERO, 0.0));
        let length = part.panel.length();
        self.value += (part.value + value * -1.0) * length;
        self.alpha += (part.alpha - alpha) * length;
        self.area_error += part.area_error * length;
        self.time_error += part.time_error;
        self.is_lost |= part.is_lost;
    }

    /// Decides which panels are halved, and calls `request` for the halves; for none once the tolerance
    /// is met, or no more can be done.
    pub(super) fn halve(&mut self, tolerance: f64, mut request: impl FnMut(Panel)) {
        /// The part of the error that may be claimed which panels that are not halved may claim. Not
        /// tuned: the rest is left to the halves.
        const SHARE_OF_REST: f64 = 0.5;
        /// A panel whose claim is as small as this part of its share of the tolerance is not halved. Not
        /// tuned.
        const SMALL: f64 = 0.125;
        if self.open.is_empty() {
            return;
        }
        let mut open = std::mem::take(&mut self.open);
        let of_area = |part: &Part| part.area_error * part.panel.length();
        let area: f64 = self.area_error + open.iter().map(of_area).sum::<f64>();
        let of_time = |parts: &[Part]| parts.iter().map(|part| part.time_error).sum::<f64>();
        let is_done = area + self.time_error + of_time(&open) <= tolerance;
        let is_lost = self.is_lost || open.iter().any(|part| part.is_lost);
        // What was cut off at some moment is not known better at more of them.
        let is_hopeless = !self.is_fine || is_lost && area > tolerance;
        let is_dear = self.panels >= self.most_panels || self.units >= MOST_OVER_TIME;
        let is_over = is_dear || is_hopeless;
        if is_done || is_over || !area.is_finite() {
            for part in &open {
                self.settle(part);
            }
            return;
        }
        // Where area claims too much, time need not.
        let left = (tolerance - area).max(SHARE_OF_AREA * tolerance) - self.missed;
        let allowed = self.missed + SHARE_OF_REST * left;
        open.sort_by(|one, other| {
            let order = other.time_error.total_cmp(&one.time_error);
            order.then(one.panel.cmp(&other.panel))
        });
        let mut rest = self.time_error + of_time(&open);
        // Panels that may still be added, at the mean cost of those so far.
        let cost = (self.units / self.panels.max(1) as u64).max(1);
        let mut affordable = MOST_OVER_TIME.saturating_sub(self.units) / cost;
        let mut is_halved = false;
        for part in open {
            let is_small = part.time_error <= SMALL * tolerance * part.panel.length();
            match part.panel.halves() {
                Some(halves) if rest > allowed && !is_small && affordable >= 2 => {
                    rest -= part.time_error;
                    affordable -= 2;
                    is_halved = true;
                    halves.into_iter().for_each(&mut request);
                }
                _ if is_small => self.settle(&part),
                Some(_) => self.open.push(part),
                None => self.settle(&part),
            }
        }
        if !is_halved {
            let open = std::mem::take(&mut self.open);
            open.iter().for_each(|part| self.settle(part));
        }
    }

    /// The pixel, once no panel is left to be halved.
    pub(super) fn pixel(&self, tolerance: f64) -> Pixel {
        let (value, alpha) = self.first.unwrap_or((Color::ZERO, 0.0));
        let error = self.area_error + self.time_error;
        Pixel {
            value: value + self.value,
            alpha: alpha + self.alpha,
            error,
            evidence: Evidence::Estimate,
            status: if error <= tolerance {
                Status::Met
            } else if !self.is_lost && self.is_fine && self.area_error > tolerance {
                Status::AtRoundoff
            } else {
                Status::OutOfBudget
            },
        }
    }
}

#[cfg(test)]
mod tests;
