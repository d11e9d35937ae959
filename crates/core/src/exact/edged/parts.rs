//! The integral over a pixel by its quarters, or halves, where it is hard along all of its edges, and by theirs.

use std::cmp::Ordering;
use std::collections::BinaryHeap;

use fearless_simd::Simd;

use super::cell::{DEEPEST, EdgedPixel, Workspace};
use crate::edges::cell::Cell;
use crate::exact::budget::Doubt;
use crate::exact::classify::occluder_cache::OccluderCache;
use crate::exact::part::{GiveUp, Part};

/// The error, from parts that were given up, above which samples know more, and rounding, which moves edges
/// but hides none.
const LOST: f64 = 0.01;
const LOST_TO_ROUNDING: f64 = 0.25;

/// The share of the tolerance that parts under point lights may claim together before no more of them are divided: one
/// pixel in a million, along a terminator beside a contour, was off by 7 % more than its parts claimed.
const ENOUGH_UNDER_POINTS: f64 = 0.8;

/// The factor on their claims where the budget ends before that, for the same reason: another pixel in ten millions was off
/// by 4 % more than it claimed. Moments need none: what few of them are off by more is a small part of their average.
const CAUTION_UNDER_POINTS: f64 = 1.0 / ENOUGH_UNDER_POINTS;

impl Workspace {
    /// The average by parts, each a quarter or a half of another that claims too much, those first that cost most,
    /// until the budget is over. `why` tells what is known of the whole.
    pub(crate) fn by_parts<S: Simd>(
        &mut self,
        simd: S,
        pixel: &EdgedPixel<'_, '_>,
        cache: &mut OccluderCache,
        why: GiveUp,
    ) -> Result<Part, GiveUp> {
        let context = pixel.context;
        let moved = pixel.moved(self.contrast);
        let unknown = Part {
            error: self.contrast,
            ..Part::NOTHING
        };
        let whole = match why {
            GiveUp::Claims(part) => part,
            _ => unknown,
        };
        let mut doubt = Doubt {
            error: whole.error + moved,
            rounding: whole.rounding,
        };
        let mut best = Part {
            error: moved,
            ..Part::NOTHING
        };
        // However small its parts are, all of the pixel is moved.
        let mut is_over = moved > context.tolerance;
        let enough = if context.scene.has_near_lights {
            ENOUGH_UNDER_POINTS * context.tolerance
        } else {
            context.tolerance
        };
        // In each quarter of a crowd all are asked again.
        let of_quarters = if self.is_crowd {
            (QUARTERS.len() * pixel.spheres.len()) as u64
        } else {
            0
        };
        let mut left = BinaryHeap::from([Subcell::new(pixel.whole(), whole)]);
        // What met the tolerance first, should more parts claim more.
        let mut met: Option<Part> = None;
        while let Some(worst) = left.pop() {
            is_over = is_over
                || self.budget.is_over(doubt, context.tolerance)
                || self.budget.left() < of_quarters;
            let is_met = doubt.error <= enough;
            if is_met || is_over || worst.is_last() {
                best.add(&worst.part, worst.share());
                continue;
            }
            if met.is_none() && doubt.error <= context.tolerance {
                let mut part = best;
                for subcell in left.iter().chain([&worst]) {
                    part.add(&subcell.part, subcell.share());
                }
                met = Some(part);
            }
            doubt.add(&worst, -1.0);
            for mut subcell in worst.subcells(unknown) {
                self.contents
                    .see(&context.scene, &subcell.cell, pixel.spheres, cache);
                self.work.candidate_tests += pixel.spheres.len() as u64;
                let part = self.part(simd, pixel, &subcell.cell, (subcell.quarterings, cache));
                let may_be_long = match &part {
                    Err(GiveUp::Narrow) => context.scene.has_near_lights,
                    Err(GiveUp::Unknown) => self.contents.is_mixed,
                    _ => false,
                };
                if may_be_long {
                    subcell.halved = self.contents.long_side(&subcell.cell);
                }
                let subcell = subcell.with(part.unwrap_or(unknown));
                doubt.add(&subcell, 1.0);
                left.push(subcell);
            }
        }
        let whole = whole.doubted_by(&best);
        if whole.error < best.error {
            best = whole;
        }
        if let Some(part) = met
            && best.error > context.tolerance
        {
            best = part;
        }
        // Samples at least see exactly.
        let lost = best.error - best.rounding;
        let is_known = best.value.is_finite()
            && lost <= context.tolerance.max(LOST)
            && best.rounding <= context.tolerance.max(LOST_TO_ROUNDING);
        if is_known {
            let is_of_moment = context.allowance.is_of_moment();
            if context.scene.has_near_lights && !is_of_moment && best.error > context.tolerance {
                best.error *= CAUTION_UNDER_POINTS;
            }
            Ok(best)
        } else {
            Err(GiveUp::Unknown)
        }
    }
}

/// Between which x and y the quarters of a cell lie.
const QUARTERS: [[[f64; 2]; 2]; 4] = [
    [[-0.5, 0.0], [-0.5, 0.0]],
    [[0.0, 0.5], [-0.5, 0.0]],
    [[-0.5, 0.0], [0.0, 0.5]],
    [[0.0, 0.5], [0.0, 0.5]],
];

/// The same for the halves along x, and along y.
const HALVES: [[[[f64; 2]; 2]; 2]; 2] = [
    [[[-0.5, 0.0], [-0.5, 0.5]], [[0.0, 0.5], [-0.5, 0.5]]],
    [[[-0.5, 0.5], [-0.5, 0.0]], [[-0.5, 0.5], [0.0, 0.5]]],
];

/// How often cells are halved along their long sides. What is left of a horizon then is less than 2⁻²⁴ of the contrast,
/// at the cost of two cells each time.
const MOST_HALVINGS: i32 = 24;

/// A part of a pixel that has been integrated, in the order of what it costs.
#[derive(Clone, Copy, Debug)]
struct Subcell {
    cell: Cell,
    quarterings: i32,
    halvings: i32,
    /// The side along which it is to be halved, where quarters would do no better.
    halved: Option<usize>,
    part: Part,
    /// Its contribution to the pixel's error.
    cost: f64,
}

impl Subcell {
    /// The whole pixel.
    fn new(cell: Cell, part: Part) -> Self {
        let whole = Self {
            cell,
            quarterings: 0,
            halvings: 0,
            halved: None,
            part,
            cost: 0.0,
        };
        whole.with(part)
    }

    /// The same with another integral.
    fn with(self, part: Part) -> Self {
        let cost = part.error * self.share();
        Self { part, cost, ..self }
    }

    /// Its share of the pixel.
    fn share(&self) -> f64 {
        0.25_f64.powi(self.quarterings) * 0.5_f64.powi(self.halvings)
    }

    /// Returns whether it is not divided any more.
    fn is_last(&self) -> bool {
        match self.halved {
            Some(_) => self.halvings == MOST_HALVINGS,
            None => self.quarterings == DEEPEST,
        }
    }

    /// Its quarters, or halves, of which nothing is known yet.
    fn subcells(self, unknown: Part) -> impl Iterator<Item = Self> {
        let (quarterings, halvings, parts) = match self.halved {
            None => (1, 0, QUARTERS.as_slice()),
            Some(axis) => (0, 1, HALVES[axis].as_slice()),
        };
        parts.iter().map(move |&[x, y]| Self {
            cell: self.cell.part(x, y),
            quarterings: self.quarterings + quarterings,
            halvings: self.halvings + halvings,
            halved: None,
            part: unknown,
            cost: 0.0,
        })
    }
}

impl Doubt {
    /// Adds what a part adds to the pixel's error, or its opposite.
    fn add(&mut self, subcell: &Subcell, sign: f64) {
        self.error += sign * subcell.cost;
        self.rounding += sign * subcell.part.rounding * subcell.share();
    }
}

impl PartialEq for Subcell {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other) == Ordering::Equal
    }
}

impl Eq for Subcell {}

impl PartialOrd for Subcell {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for Subcell {
    fn cmp(&self, other: &Self) -> Ordering {
        self.cost.total_cmp(&other.cost)
    }
}
