//! Two pictures that are compared.

use crate::base::size::Size;
use crate::formats::picture::Picture;

/// Two pictures of the same size.
pub(super) struct Pair {
    pub(super) a: Picture,
    pub(super) b: Picture,
}

/// The names of the four values of a pixel.
const CHANNELS: [&str; 4] = ["R", "G", "B", "A"];

impl Pair {
    /// The channels of red, green, blue and alpha that are compared: one of the colors where both
    /// pictures are grey, alpha where one has it.
    pub(super) fn channels(&self) -> &'static [usize] {
        let grey = self.a.grey && self.b.grey;
        match (grey, self.a.alpha || self.b.alpha) {
            (true, false) => &[0],
            (true, true) => &[0, 3],
            (false, false) => &[0, 1, 2],
            (false, true) => &[0, 1, 2, 3],
        }
    }

    /// The name of a channel that is compared.
    pub(super) fn name(&self, channel: usize) -> &'static str {
        if channel == 0 && self.a.grey && self.b.grey {
            "Y"
        } else {
            CHANNELS[channel]
        }
    }

    /// The absolute differences of all four values, infinite where one is no finite number.
    pub(super) fn differences(&self, col: u32, row: u32) -> [f64; 4] {
        let (a, b) = (self.a.samples.rgba(col, row), self.b.samples.rgba(col, row));
        [0, 1, 2, 3].map(|channel| {
            let difference = (a[channel] - b[channel]).abs();
            if difference.is_finite() {
                difference
            } else {
                f64::INFINITY
            }
        })
    }

    /// The difference of a pixel that has these: the largest one of the channels that are compared.
    pub(super) fn largest(&self, differences: &[f64; 4]) -> f64 {
        let compared = self.channels().iter();
        let compared = compared.map(|&channel| differences[channel]);
        compared.fold(0.0, f64::max)
    }

    /// The largest differences that the rounding of both files accounts for.
    pub(super) fn rounding(&self, col: u32, row: u32) -> [f64; 4] {
        let (a, b) = (
            self.a.samples.rounding(col, row),
            self.b.samples.rounding(col, row),
        );
        [0, 1, 2, 3].map(|channel| a[channel] + b[channel])
    }

    /// Returns for each value whether one of the files holds the largest number it can, and the other
    /// a larger one.
    pub(super) fn is_clipped(&self, col: u32, row: u32) -> [bool; 4] {
        let (a, b) = (self.a.samples.rgba(col, row), self.b.samples.rgba(col, row));
        let (full_a, full_b) = (
            self.a.samples.is_full(col, row),
            self.b.samples.is_full(col, row),
        );
        [0, 1, 2, 3].map(|channel| {
            let (a, b) = (a[channel], b[channel]);
            full_a[channel] && a < b || full_b[channel] && b < a
        })
    }

    /// The size of both.
    pub(super) fn size(&self) -> Size {
        self.a.size
    }
}
