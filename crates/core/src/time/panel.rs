//! A part of the time that the shutter is open, and the rule by which light is averaged over it.

use crate::model::color::Color;
use crate::numeric::kronrod;
use crate::numeric::kronrod::{ABSCISSAS, WEIGHTS};
use crate::picture::pixel::Pixel;
use crate::picture::pixel::Status;

/// Moments of a panel.
pub(super) const MOMENTS: usize = kronrod::POINTS;

/// Shorter panels are not made: 2 to the power of minus this.
pub(super) const DEEPEST: u32 = 14;

/// The shortest panels with which a pixel begins.
pub(super) const FASTEST: u32 = 8;

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

/// What a pixel sees in a panel, on average.
#[derive(Clone, Copy, Debug)]
pub(super) struct Part {
    pub(super) panel: Panel,
    pub(super) value: Color,
    pub(super) alpha: f64,
    /// What the errors of the moments amount to.
    pub(super) area_error: f64,
    /// What may happen between them; of the whole time's average, as the panel's share of it.
    pub(super) time_error: f64,
    /// Whether nothing certain is known of some moment.
    pub(super) is_lost: bool,
}

impl Part {
    /// From the pixel at the moments of a panel.
    pub(super) fn new(panel: Panel, pixels: &[Pixel; MOMENTS]) -> Self {
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
        let mut off = libm::hypot(odd_alpha[0], odd_alpha[1]);
        let [first, second] = odd.map(|odd| odd.to_array());
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
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::picture::pixel::Evidence;

    fn part(panel: Panel, light: impl Fn(f64) -> f64) -> Part {
        let pixels = panel.times().map(|time| Pixel {
            value: Color::splat(light(time)),
            alpha: 1.0,
            error: 1e-4,
            evidence: Evidence::Bound,
            status: Status::Met,
        });
        Part::new(panel, &pixels)
    }

    const WHOLE: Panel = Panel { level: 0, index: 0 };

    #[test]
    fn polynomials_are_averaged_and_low_ones_claim_nothing() {
        for degree in 0..=11 {
            let found = part(WHOLE, |time| libm::pow(time + 0.5, f64::from(degree)));
            let expected = 1.0 / f64::from(degree + 1);
            assert!((found.value.x - expected).abs() < 1e-15, "degree {degree}");
            assert_eq!(found.time_error < 1e-14, degree < 5, "degree {degree}");
            assert!((found.area_error - 1e-4).abs() < 1e-18);
        }
    }

    #[test]
    fn what_never_changes_is_itself() {
        let found = part(WHOLE, |_| 0.1);
        assert_eq!((found.value.x, found.time_error), (0.1, 0.0));
    }

    #[test]
    fn halves_are_the_whole() {
        let light = |time: f64| libm::exp(3.0 * time);
        let whole = part(WHOLE, light);
        let [first, second] = WHOLE.halves().unwrap().map(|half| part(half, light));
        let halves = 0.5 * (first.value.x + second.value.x);
        let exact = 2.0 / 3.0 * libm::sinh(1.5);
        assert!((halves - exact).abs() < 1e-13);
        assert!((whole.value.x - exact).abs() < whole.time_error);
        assert!(first.time_error + second.time_error < 0.1 * whole.time_error);
        assert_eq!(
            [0, 1, 2],
            [WHOLE.number(), first.panel.number(), second.panel.number()]
        );
    }

    /// But for one before the first moment or after the last.
    #[test]
    fn a_jump_claims_about_what_it_costs() {
        let outside = 0.5 - 0.5 * ABSCISSAS[MOMENTS - 1];
        for place in 0..1000 {
            let jump = f64::from(place) / 1000.0 - 0.5;
            let found = part(WHOLE, |time| f64::from(u8::from(time > jump)));
            let off = (found.value.x - (0.5 - jump)).abs();
            let claimed = found.time_error;
            assert!(off <= 2.0 * claimed + outside, "{place}: {off}, {claimed}");
        }
    }
}
