//! The exact average of light over a pixel, computed by other means than the renderer's.
//!
//! Written from the model in `docs/scenes.md` alone, to check the promise of the renderer. Hits, shadows and shading
//! are computed in plain double precision, and every point checks all spheres that may matter. The integral over a
//! pixel is computed along lines and across them, by Gauss–Kronrod rules between the places where the view changes.
//! Formulas suggest such places; rays on both sides confirm them, and every node of every rule checks again. Lines run
//! once to the right and once up; if the two results differ, the pixel is divided into quarters.
//!
//! # Accuracy
//! A [`Truth`] states its possible error: the difference between the two directions, and their own estimates.
//! `checks.rs` measures both against pixels in `tests/truth/pixels` and closed forms.

mod across;
mod ball;
mod beam;
mod lamp;
mod light;
mod line;
mod noise;
mod patch;
mod quadrature;
mod seeds;
mod soft;
mod strata;

use glam::{DVec2, DVec4};
use marbles_core::{View, World};

use across::Way;
use patch::{Patch, Stage};
use seeds::Seeds;
pub use soft::Center;

/// The difference between both directions above which a pixel is divided into quarters.
const TOLERANCE: f64 = 1e-10;
/// The largest number of times that quarters are divided again, and the largest number of lines per pixel.
const DEPTH: u32 = 5;
const BUDGET: u32 = 40_000;
/// The same under soft light, whose lines take much longer.
const SOFT_TOLERANCE: f64 = 1e-5;
const SOFT_DEPTH: u32 = 2;
const SOFT_BUDGET: u32 = 3_000;
/// The rounding error of lines and edges if everything else agrees.
const ROUNDING: f64 = 1e-12;

/// The four quarters of a patch.
const SIDES: [DVec2; 4] = [DVec2::ZERO, DVec2::X, DVec2::Y, DVec2::ONE];

/// The average of light and coverage over a pixel.
#[derive(Clone, Copy, Debug)]
pub struct Truth {
    /// Red, green and blue of the spheres' light, without the background, and the covered fraction.
    pub value: DVec4,
    /// The largest error of any channel.
    pub error: f64,
    /// Whether there is an edge inside the pixel: a sphere's contour, a shadow, a terminator.
    pub has_edge: bool,
    /// The number of lines that it took.
    pub lines: u32,
}

/// A world and a view, whose exact pixels can be computed.
pub struct Reference<'world> {
    stage: Stage<'world>,
}

impl<'world> Reference<'world> {
    /// For pixels of a view of a world.
    pub fn new(world: &'world World, view: &View) -> Self {
        let stage = Stage::new(world, view);
        Self { stage }
    }

    /// The exact value of a pixel.
    pub fn pixel(&self, col: u32, row: u32) -> Truth {
        self.pixel_to(col, row, self.finest())
    }

    /// The smallest error that is aimed at.
    fn finest(&self) -> f64 {
        match self.stage.softness.is_any() {
            true => SOFT_TOLERANCE,
            false => TOLERANCE,
        }
    }

    /// The largest number of times that quarters are divided again, and the largest number of lines.
    fn most(&self) -> (u32, u32) {
        match self.stage.softness.is_any() {
            true => (SOFT_DEPTH, SOFT_BUDGET),
            false => (DEPTH, BUDGET),
        }
    }

    /// The value of a pixel with at most about this error.
    pub fn pixel_to(&self, col: u32, row: u32, tolerance: f64) -> Truth {
        let tolerance = tolerance.max(self.finest());
        let patch = Patch::of_pixel(&self.stage, col, row, tolerance);
        let (depth, mut budget) = self.most();
        let mut truth = patch_truth(&patch, depth, tolerance, &mut budget);
        truth.error += ROUNDING + patch.noise;
        assert!(
            truth.value.is_finite(),
            "column {col}, row {row}: not a number"
        );
        truth
    }

    /// The value as the sum of four quarters: details that one misses are hardly missed by both.
    pub fn pixel_by_quarters(&self, col: u32, row: u32) -> Truth {
        let tolerance = self.finest();
        let patch = Patch::of_pixel(&self.stage, col, row, tolerance);
        let (depth, mut budget) = self.most();
        let mut sum = Truth {
            value: DVec4::ZERO,
            error: 4.0 * (ROUNDING + patch.noise),
            has_edge: false,
            lines: 0,
        };
        for side in SIDES {
            let quarter = patch_truth(&patch.quarter(side), depth, tolerance, &mut budget);
            sum.value += quarter.value;
            sum.error += quarter.error;
            sum.has_edge |= quarter.has_edge;
            sum.lines += quarter.lines;
        }
        assert!(
            sum.value.is_finite(),
            "column {col}, row {row}: not a number"
        );
        sum
    }

    /// Whether any sphere may be seen in a pixel.
    pub fn sees_anything(&self, col: u32, row: u32) -> bool {
        !Patch::of_pixel(&self.stage, col, row, TOLERANCE)
            .candidates
            .is_empty()
    }

    /// Whether the views at corners and center of a pixel, and a few points more, differ.
    pub fn seems_to_change(&self, col: u32, row: u32) -> bool {
        let patch = Patch::of_pixel(&self.stage, col, row, TOLERANCE);
        let look = |x: i32, y: i32| {
            let point = DVec2::new(f64::from(x), f64::from(y)) * 0.25;
            patch.signature(patch.direction(point))
        };
        let middle = look(0, 0);
        let mut points = (-2..=2).flat_map(|x| (-2..=2).map(move |y| (x, y)));
        points.any(|(x, y)| look(x, y) != middle)
    }

    /// The mean of N × N midpoints: slow and imprecise, but hard to get wrong.
    pub fn midpoints(&self, col: u32, row: u32, count: u32) -> DVec4 {
        let patch = Patch::of_pixel(&self.stage, col, row, TOLERANCE);
        let place = |index: u32| (f64::from(index) + 0.5) / f64::from(count) - 0.5;
        let mut sum = DVec4::ZERO;
        for y in 0..count {
            for x in 0..count {
                let direction = patch.direction(DVec2::new(place(x), place(y)));
                sum += patch.look(direction, true).1;
            }
        }
        sum / f64::from(count).powi(2)
    }
}

fn patch_truth(patch: &Patch<'_>, depth: u32, tolerance: f64, budget: &mut u32) -> Truth {
    let seeds = Seeds::of(patch);
    let right = across::integral(patch, &seeds, Way::Right);
    let up = across::integral(patch, &seeds, Way::Up);
    let apart = (right.integral.value - up.integral.value)
        .abs()
        .max_element();
    let better = if right.integral.error < up.integral.error {
        right.integral
    } else {
        up.integral
    };
    let own = right.integral.error.max(up.integral.error);
    let mut truth = Truth {
        value: better.value,
        error: apart + own,
        has_edge: right.has_edge || up.has_edge,
        lines: right.lines + up.lines,
    };
    *budget = budget.saturating_sub(truth.lines);
    if truth.error <= tolerance.max(4.0 * patch.noise) || depth == 0 || *budget == 0 {
        return truth;
    }
    (truth.value, truth.error) = (DVec4::ZERO, 0.0);
    for side in SIDES {
        let quarter = patch_truth(&patch.quarter(side), depth - 1, 0.5 * tolerance, budget);
        truth.value += quarter.value;
        truth.error += quarter.error;
        truth.lines += quarter.lines;
    }
    truth
}
