//! The integral over lines side by side.

use super::line::{Line, distance};
use crate::Radiance;

/// An integral over a part of a pixel.
#[derive(Clone, Copy, Debug)]
pub(super) struct Part<C> {
    pub(super) value: C,
    pub(super) covered: f64,
    pub(super) error: f64,
    /// Places where lines are not alike; 0 where all are.
    pub(super) changes: usize,
}

impl<C: Radiance> Part<C> {
    pub(super) const NOTHING: Self = Self {
        value: C::ZERO,
        covered: 0.0,
        error: 0.0,
        changes: 0,
    };

    pub(super) fn add(&mut self, other: Self) {
        self.value += other.value;
        self.covered += other.covered;
        self.error += other.error;
        self.changes += other.changes;
    }
}

/// The integral over the lines between two places.
///
/// Where the lines are not alike, the changes between them are located and the parts between are
/// integrated each for itself; where the rule has not converged, the halves.
pub(super) fn between<C: Radiance>(
    line: &impl Fn(f64) -> Line<C>,
    start: f64,
    end: f64,
    tolerance: f64,
    lines: &mut u32,
) -> Part<C> {
    let length = end - start;
    let places = RULE.map(|(s, ..)| start + length * (s * s * (3.0 - 2.0 * s)));
    let at = places.map(line);
    *lines = lines.saturating_sub(RULE.len() as u32);
    let (mut fine, mut coarse) = (C::ZERO, C::ZERO);
    let (mut fine_covered, mut coarse_covered) = (0.0, 0.0);
    for (line, (s, kronrod, gauss)) in at.iter().zip(RULE) {
        let slope = 6.0 * s * (1.0 - s) * length;
        fine += line.value * (kronrod * slope);
        coarse += line.value * (gauss * slope);
        fine_covered += line.covered * kronrod * slope;
        coarse_covered += line.covered * gauss * slope;
    }
    let (mean, mean_covered) = (fine * (1.0 / length), fine_covered / length);
    let mut spread = 0.0;
    for (line, (s, kronrod, _)) in at.iter().zip(RULE) {
        let away = distance(line.value, mean).max((line.covered - mean_covered).abs());
        spread += away * kronrod * 6.0 * s * (1.0 - s) * length;
    }
    let difference = distance(fine, coarse).max((fine_covered - coarse_covered).abs());
    let alike = at
        .windows(2)
        .all(|pair| pair[0].signature == pair[1].signature);
    // With the easing Gauss's rule is exact for straight lines and Kronrod's for cubics: for
    // analytic functions the error of the latter is about the square of the former's.
    let error = if !alike {
        difference
    } else if spread > 0.0 {
        spread * (EASED * difference / spread).min(1.0).powi(2)
    } else {
        0.0
    };
    let fits = Part {
        value: fine,
        covered: fine_covered,
        error,
        changes: usize::from(!alike),
    };
    // Where the lines differ so little, whatever happens cannot matter.
    let hopeless = *lines == 0 || !spread.is_finite();
    if (alike && error <= tolerance) || hopeless || spread <= 0.1 * tolerance {
        return Part {
            error: error.min(spread),
            ..fits
        };
    }
    let mut breaks = vec![start];
    if alike {
        breaks.push(0.5 * (start + end));
    } else {
        for (index, pair) in at.windows(2).enumerate() {
            if pair[0].signature != pair[1].signature {
                let width = 0.01 * tolerance / spread.max(tolerance) * length;
                let (low, high) = (places[index], places[index + 1]);
                breaks.push(locate(line, low, high, pair[0].signature, width, lines));
            }
        }
    }
    breaks.push(end);
    let mut sum = Part {
        changes: fits.changes,
        ..Part::NOTHING
    };
    for pair in breaks.windows(2) {
        let share = tolerance * (pair[1] - pair[0]) / length;
        sum.add(between(line, pair[0], pair[1], share, lines));
    }
    sum
}

/// Where between two lines something changes, the lower of which has this signature.
fn locate<C: Radiance>(
    line: &impl Fn(f64) -> Line<C>,
    mut low: f64,
    mut high: f64,
    signature: u64,
    width: f64,
    lines: &mut u32,
) -> f64 {
    while high - low > width && *lines > 0 {
        *lines -= 1;
        let middle = 0.5 * (low + high);
        if line(middle).signature == signature {
            low = middle;
        } else {
            high = middle;
        }
    }
    0.5 * (low + high)
}

/// How much larger than the ratio of the rules' errors their difference is taken to be.
const EASED: f64 = 5.0;

/// Nodes on 0 to 1, weights of Kronrod's rule with 7 points, weights of Gauss's with 3.
const RULE: [(f64, f64, f64); 7] = {
    const NODES: [f64; 3] = [
        0.960_491_268_708_020_3,
        0.774_596_669_241_483_4,
        0.434_243_749_346_802_6,
    ];
    const KRONROD: [f64; 4] = [
        0.104_656_226_026_467_3,
        0.268_488_089_868_333_4,
        0.401_397_414_775_962_2,
        0.450_916_538_658_474_1,
    ];
    const GAUSS: [f64; 2] = [5.0 / 9.0, 8.0 / 9.0];
    [
        (0.5 - 0.5 * NODES[0], 0.5 * KRONROD[0], 0.0),
        (0.5 - 0.5 * NODES[1], 0.5 * KRONROD[1], 0.5 * GAUSS[0]),
        (0.5 - 0.5 * NODES[2], 0.5 * KRONROD[2], 0.0),
        (0.5, 0.5 * KRONROD[3], 0.5 * GAUSS[1]),
        (0.5 + 0.5 * NODES[2], 0.5 * KRONROD[2], 0.0),
        (0.5 + 0.5 * NODES[1], 0.5 * KRONROD[1], 0.5 * GAUSS[0]),
        (0.5 + 0.5 * NODES[0], 0.5 * KRONROD[0], 0.0),
    ]
};
