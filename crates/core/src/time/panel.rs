//! A part of the time that the shutter is open, and the rule by which light is averaged over it.

use crate::model::color::Color;
use crate::numeric::kronrod::{self, ABSCISSAS, WEIGHTS};
use crate::numeric::pair::both;
use crate::picture::pixel::{Pixel, Status};

/// Moments of a panel.
pub(super) const MOMENTS: usize = kronrod::POINTS;

/// Shorter panels are not made: 2 to the power of minus this. Not tuned: jumps of the light are not
/// resolved further.
pub(super) const DEEPEST: u32 = 14;

/// The level of the shortest panels with which a pixel begins. Not tuned: it bounds the work on what
/// moves quickly.
pub(super) const FASTEST: u32 = 8;

/// The level of the panels of a pixel that anything may cross between two moments, however short panels are:
/// 56 moments for a mean whose error is all of the contrast. Not tuned.
pub(super) const BLIND: u32 = 3;

/// No two moments of a panel of length 1 are farther apart than this.
pub(super) const LONGEST_GAP: f64 = 0.5 * ABSCISSAS[4];

/// Two rules that are 0 for every polynomial of degree 4, and of degree 5: half of the weights of the
/// polynomials of degree 5 and 6 that are orthogonal, under Kronrod's weights, to those of lower
/// degree, and whose squares average 1.
///
/// The second is, nearly, half the difference between Kronrod's rule and Gauss's with three points. Where
/// light jumps or bends one number alone is small by accident too often.
const NULL: [[f64; MOMENTS]; 2] = [
    [
        -0.042_094_916_463_914_9,
        0.093_117_382_891_927_8,
        -0.072_992_679_718_858_6,
        0.0,
        0.072_992_679_718_858_6,
        -0.093_117_382_891_927_8,
        0.042_094_916_463_914_9,
    ],
    [
        0.025_834_368_778_088_4,
        -0.070_862_547_354_606_5,
        0.099_084_872_764_961_2,
        -0.108_113_388_376_886_1,
        0.099_084_872_764_961_2,
        -0.070_862_547_354_606_5,
        0.025_834_368_778_088_4,
    ],
];

/// One of the 2^level equal parts of the time.
#[derive(Clone, Copy, Debug, Eq, Ord, PartialEq, PartialOrd)]
pub(super) struct Panel {
    pub(super) level: u32,
    pub(super) index: u32,
}

impl Panel {
    /// Its share of the time.
    pub(super) fn length(self) -> f64 {
        1.0 / f64::from(1_u32 << self.level)
    }

    /// Its two halves; none for the shortest ones.
    pub(super) fn halves(self) -> Option<[Self; 2]> {
        let level = self.level + 1;
        let half = |index| Self { level, index };
        (level <= DEEPEST).then(|| [half(2 * self.index), half(2 * self.index + 1)])
    }

    /// Its place among all panels, longer ones first.
    pub(super) fn number(self) -> usize {
        (1 << self.level) - 1 + self.index as usize
    }

    /// Its moments, from −½ to ½.
    pub(super) fn times(self) -> [f64; MOMENTS] {
        let length = self.length();
        let middle = (f64::from(self.index) + 0.5) * length - 0.5;
        ABSCISSAS.map(|node| middle + 0.5 * length * node)
    }
}

/// The average of a pixel over a panel.
#[derive(Clone, Copy, Debug)]
pub(super) struct Part {
    pub(super) panel: Panel,
    pub(super) value: Color,
    pub(super) alpha: f64,
    /// The average of the errors of the moments.
    pub(super) area_error: f64,
    /// The error by the rule; of the whole time's average, as the panel's share of it.
    pub(super) time_error: f64,
    /// True where nothing certain is known of some moment.
    pub(super) is_lost: bool,
    /// The units of `exact::budget` that all moments have cost.
    pub(super) units: u64,
}

impl Part {
    /// From the pixel at the moments of a panel; an error of alpha counts as so much light.
    pub(super) fn new(panel: Panel, pixels: &[Pixel; MOMENTS], of_alpha: f64) -> Self {
        let middle = &pixels[MOMENTS / 2];
        // Differences from the middle, so that what never changes is itself.
        let mut value = Color::ZERO;
        let mut alpha = 0.0;
        let mut area_error = 0.0;
        let mut odd = [Color::ZERO; 2];
        let mut odd_alpha = [0.0; 2];
        let mut is_lost = false;
        for (place, pixel) in pixels.iter().enumerate() {
            let weight = 0.5 * WEIGHTS[place];
            let difference = pixel.value + middle.value * -1.0;
            let alpha_difference = pixel.alpha - middle.alpha;
            value += difference * weight;
            alpha += alpha_difference * weight;
            area_error += pixel.error * weight;
            for (rule, null) in NULL.iter().enumerate() {
                odd[rule] += difference * null[place];
                odd_alpha[rule] += alpha_difference * null[place];
            }
            is_lost |= pixel.status == Status::OutOfBudget;
        }
        let mut off = of_alpha * libm::hypot(odd_alpha[0], odd_alpha[1]);
        let [first, second] = both(odd, |odd| odd.to_array());
        for (first, second) in first.into_iter().zip(second) {
            off = off.max(libm::hypot(first, second));
        }
        Self {
            panel,
            value: middle.value + value,
            alpha: middle.alpha + alpha,
            area_error,
            time_error: panel.length() * off,
            is_lost,
            units: 0,
        }
    }
}

#[cfg(test)]
mod tests;
