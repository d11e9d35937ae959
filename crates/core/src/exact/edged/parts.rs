//! The integral over a pixel by its quarters, where it is hard along all of its edges, and by theirs.

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

impl Workspace {
    /// The average by parts, each the quarter of another that claims too much, those first that cost most,
    /// until the budget is over. `why` tells what is known of the whole.
    pub(crate) fn by_parts<S: Simd>(
        &mut self,
        simd: S,
        pixel: &EdgedPixel<'_, '_>,
        why: GiveUp,
        cache: &mut OccluderCache,
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
        let mut left = BinaryHeap::from([Quarter::new(pixel.whole(), 0, whole)]);
        // What met the tolerance first, should more parts claim more.
        let mut met: Option<Part> = None;
        while let Some(worst) = left.pop() {
            is_over = is_over
                || self.budget.is_over(doubt, context.tolerance)
                || self.budget.left() < of_quarters;
            let is_met = doubt.error <= enough;
            if is_met || is_over || worst.depth == DEEPEST {
                best.add(&worst.part, worst.share());
                continue;
            }
            if met.is_none() && doubt.error <= context.tolerance {
                let mut part = best;
                for quarter in left.iter().chain([&worst]) {
                    part.add(&quarter.part, quarter.share());
                }
                met = Some(part);
            }
            doubt.add(&worst, -1.0);
            let depth = worst.depth + 1;
            for [x, y] in QUARTERS {
                let cell = worst.cell.part(x, y);
                self.contents
                    .see(&context.scene, &cell, pixel.spheres, cache);
                self.work.candidate_tests += pixel.spheres.len() as u64;
                let part = self.part(simd, pixel, &cell, (depth, cache));
                let quarter = Quarter::new(cell, depth, part.unwrap_or(unknown));
                doubt.add(&quarter, 1.0);
                left.push(quarter);
            }
        }
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

/// A part of a pixel that has been integrated, in the order of what it costs.
#[derive(Clone, Copy, Debug)]
struct Quarter {
    cell: Cell,
    depth: i32,
    part: Part,
    /// Its contribution to the pixel's error.
    cost: f64,
}

impl Quarter {
    fn new(cell: Cell, depth: i32, part: Part) -> Self {
        let mut quarter = Self {
            cell,
            depth,
            part,
            cost: 0.0,
        };
        quarter.cost = part.error * quarter.share();
        quarter
    }

    /// Its share of the pixel.
    fn share(&self) -> f64 {
        0.25_f64.powi(self.depth)
    }
}

impl Doubt {
    /// Adds what a part adds to the pixel's error, or its opposite.
    fn add(&mut self, quarter: &Quarter, sign: f64) {
        self.error += sign * quarter.cost;
        self.rounding += sign * quarter.part.rounding * quarter.share();
    }
}

impl PartialEq for Quarter {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other) == Ordering::Equal
    }
}

impl Eq for Quarter {}

impl PartialOrd for Quarter {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for Quarter {
    fn cmp(&self, other: &Self) -> Ordering {
        self.cost.total_cmp(&other.cost)
    }
}
