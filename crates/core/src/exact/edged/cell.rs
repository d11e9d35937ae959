//! The integral over a cell, along lines between known events.

use fearless_simd::prelude::*;

use super::boundary::Boundary;
use super::breaks::Break;
use super::cut::{Crowded, Cuts, Signature};
use super::piece::{Piece, Surroundings, Unlike};
use super::rule::Roots;
use crate::edges::cell::{Ball, Cell};
use crate::exact::classify::contents::Contents;
use crate::exact::classify::occluder_cache::OccluderCache;
use crate::exact::part::Part;
use crate::exact::scene::InCamera;
use crate::model::color::Color;
use crate::model::roughness::noise::NoiseCells;
use crate::picture::pixel::Work;

/// What the integral over cells works with, kept from cell to cell.
#[derive(Clone, Debug, Default)]
pub(crate) struct Workspace {
    pub(crate) contents: Contents,
    cuts: Cuts,
    pub(crate) boundary: Boundary,
    pub(crate) scratch: Vec<f64>,
    pub(crate) noise: Option<Box<NoiseCells>>,
    pub(crate) breaks: Vec<Break>,
    samples: Vec<Sample>,
    tasks: Vec<Task>,
    pub(crate) work: Work,
    /// What the pixel has cost, and may cost, in spheres and edges looked at along lines, and
    /// samples.
    effort: u64,
    sample_budget: u64,
}

/// A line whose signature is known.
#[derive(Clone, Copy, Debug)]
struct Sample {
    y: f64,
    signature: Signature,
}

/// Lines to be integrated.
#[derive(Clone, Copy, Debug)]
struct Task {
    start: f64,
    end: f64,
    roots: Roots,
    signature: Signature,
    /// How far from the start and from the end lines need not have the signature.
    loose: [f64; 2],
    division: u32,
    depth: u32,
}

/// The integral was not found; the parts of the cell may be easier.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Hard;

impl From<Crowded> for Hard {
    fn from(_: Crowded) -> Self {
        Self
    }
}

/// Batches of eight lines that a cell may cost before its parts are tried.
const MOST_BATCHES: u32 = 60;

/// Samples that a pixel may cost: only bumps much smaller than a pixel, or exponents that make steep
/// terminators of them, ask for so many.
const MOST_SAMPLES: u64 = 400_000;

/// Spheres and edges that a pixel may cost, each counted for every eight lines: crowds of hundreds
/// in one pixel ask for so many.
const MOST_EFFORT: u64 = 400_000;

/// How often something unexpected may happen between lines of a cell that were held to be alike.
const MOST_SURPRISES: u32 = 6;

/// How often lines are looked at between those that are alike.
const MOST_SUSPICIONS: u32 = 2;

/// How near to a break lines are looked at.
const INSET: f64 = 1e-7;

/// How exactly events are told apart.
#[derive(Clone, Copy, Debug)]
struct Precision {
    /// Between lines.
    width: f64,
    /// Along lines: what is narrower is left out.
    gap: f64,
}

/// How lines are looked at.
#[derive(Clone, Copy, Debug)]
struct Care {
    /// Lines between two breaks, at first.
    lines: usize,
    /// What is narrower than this share of the tolerance is left out.
    gap: f64,
}

impl Care {
    const EXACT: Self = Self { lines: 2, gap: 0.0 };
    const ROBUST: Self = Self {
        lines: 8,
        gap: 0.005,
    };
}

/// How much is asked of a cell.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Goal {
    pub(crate) tolerance: f64,
    pub(crate) background: Color,
    /// About the largest difference of light that an edge may make.
    pub(crate) contrast: f64,
}

impl Workspace {
    /// The integral over the cell that `contents` belongs to.
    #[inline(always)]
    pub(crate) fn integrate<S: Simd>(
        &mut self,
        simd: S,
        scene: &InCamera<'_>,
        cell: &Cell,
        goal: &Goal,
    ) -> Result<Part, Hard> {
        self.find_breaks(simd, scene, cell);
        // First everything, however narrow; then, where rounding makes it hopeless, without what does
        // not count.
        let fine = self.integrate_within(simd, scene, cell, goal, Care::EXACT);
        match fine {
            Err(Hard) if !self.is_over_budget() => {
                self.integrate_within(simd, scene, cell, goal, Care::ROBUST)
            }
            fine => fine,
        }
    }

    /// Takes in what a cell may see of some spheres.
    pub(crate) fn see(
        &mut self,
        scene: &InCamera<'_>,
        cell: &Cell,
        spheres: &[(usize, Ball)],
        cache: &mut OccluderCache,
    ) {
        self.work.candidate_tests += spheres.len() as u64;
        self.contents.see(scene, cell, spheres, cache);
    }

    /// Begins the work on a pixel.
    pub(crate) fn begin_pixel(&mut self) {
        self.effort = 0;
        self.sample_budget = self.work.samples + MOST_SAMPLES;
    }

    /// Counts what it costs to see a cell: about as much as a few lines.
    pub(crate) fn spend_on_cell(&mut self) {
        self.effort += 4 * self.contents.extent();
    }

    /// Whether the pixel has cost as much as a pixel may.
    pub(crate) fn is_over_budget(&self) -> bool {
        self.effort > MOST_EFFORT || self.work.samples > self.sample_budget
    }

    /// The integral between the breaks.
    #[inline(always)]
    fn integrate_within<S: Simd>(
        &mut self,
        simd: S,
        scene: &InCamera<'_>,
        cell: &Cell,
        goal: &Goal,
        care: Care,
    ) -> Result<Part, Hard> {
        let mut batches = 0;
        // An event that is located to within a width w costs w^1.5 where a pair of edges begins, less
        // elsewhere.
        let root = libm::cbrt(0.02 * goal.tolerance);
        let precision = Precision {
            width: (root * root).clamp(1e-9, 1e-2),
            gap: (care.gap * goal.tolerance / goal.contrast).max(1e-12),
        };
        self.cuts.has_dropped();
        self.sample_lines(simd, scene, cell, care.lines, &precision, &mut batches)?;
        self.tasks.clear();
        let mut sum = Part::NOTHING;
        self.resolve(simd, scene, cell, &precision, &mut batches)?;
        sum.error += goal.contrast * self.make_tasks(&Task::WHOLE);
        while let Some(task) = self.tasks.pop() {
            batches += 1;
            self.effort += self.contents.extent();
            if batches > MOST_BATCHES || self.is_over_budget() {
                return Err(Hard);
            }
            self.work.lines += 8;
            let share = task.end - task.start;
            let piece = Piece {
                start: task.start,
                end: task.end,
                roots: task.roots,
                signature: &task.signature,
                division: task.division,
                loose: task.loose,
                gap: precision.gap,
                is_suspicious: task.depth <= MOST_SUSPICIONS,
            };
            let surroundings = Surroundings {
                scene,
                cell,
                contents: &self.contents,
                background: goal.background,
                tolerance: goal.tolerance,
            };
            let part = surroundings.integrate(
                simd,
                &piece,
                &mut self.cuts,
                &mut self.scratch,
                &mut self.noise,
                &mut self.work.samples,
            );
            let part = match part {
                Ok(part) => part,
                Err(Unlike { at }) if task.depth < MOST_SURPRISES => {
                    // Something happens that the lines at the ends knew nothing of.
                    self.sample_between(simd, scene, cell, &task, at, &precision, &mut batches)?;
                    self.resolve(simd, scene, cell, &precision, &mut batches)?;
                    sum.error += goal.contrast * self.make_tasks(&task);
                    continue;
                }
                Err(Unlike { .. }) => return Err(Hard),
            };
            let is_good =
                part.error <= 0.5 * goal.tolerance || part.error * share <= 0.02 * goal.tolerance;
            if is_good {
                sum.add(&part, share);
                continue;
            }
            const FINEST: u32 = 16;
            if part.along > 0.5 * part.error && task.division < FINEST {
                self.tasks.push(Task {
                    division: 2 * task.division,
                    ..task
                });
                continue;
            }
            self.tasks.extend(task.halves());
        }
        if self.cuts.has_dropped() {
            sum.error += goal.contrast * precision.gap;
        }
        sum.rounding = goal.contrast * self.contents.rounding;
        sum.error += sum.rounding;
        Ok(sum)
    }

    /// Finds the signatures on both sides of the breaks.
    #[inline(always)]
    fn sample_lines<S: Simd>(
        &mut self,
        simd: S,
        scene: &InCamera<'_>,
        cell: &Cell,
        count: usize,
        precision: &Precision,
        batches: &mut u32,
    ) -> Result<(), Hard> {
        /// Intervals that are not worth it.
        const LEAST: f64 = 1e-11;
        let mut lines: Vec<f64> = Vec::with_capacity(count * (self.breaks.len() + 1));
        let mut start = -0.5;
        for end in self.breaks.iter().map(|at| at.y).chain([0.5]) {
            let length = end - start;
            if length > LEAST {
                let inset = INSET.min(0.01 * length);
                let step = (length - 2.0 * inset) / (count - 1) as f64;
                lines.extend((0..count).map(|index| start + inset + index as f64 * step));
                start = end;
            }
        }
        self.samples.clear();
        for chunk in lines.chunks(8) {
            let mut y = [chunk[chunk.len() - 1]; 8];
            y[..chunk.len()].copy_from_slice(chunk);
            self.look(simd, scene, cell, &y, precision, batches)?;
            for (&y, &signature) in chunk.iter().zip(self.cuts.signatures()) {
                self.samples.push(Sample { y, signature });
            }
        }
        Ok(())
    }

    /// Looks at lines inside a task, one of them at `at`.
    #[expect(
        clippy::too_many_arguments,
        reason = "all of it is at hand where it is called"
    )]
    #[inline(always)]
    fn sample_between<S: Simd>(
        &mut self,
        simd: S,
        scene: &InCamera<'_>,
        cell: &Cell,
        task: &Task,
        at: Option<f64>,
        precision: &Precision,
        batches: &mut u32,
    ) -> Result<(), Hard> {
        let start = task.start + task.loose[0];
        let step = (task.end - task.loose[1] - start) / 7.0;
        let mut y = [start; 8];
        for (index, y) in y.iter_mut().enumerate() {
            *y += index as f64 * step;
        }
        if let Some(at) = at {
            // In the place of its neighbor before it, but for the first.
            let before = y.iter().filter(|&&y| y < at).count();
            y[before.clamp(2, 7) - 1] = at;
        }
        self.look(simd, scene, cell, &y, precision, batches)?;
        self.samples.clear();
        for (&y, &signature) in y.iter().zip(self.cuts.signatures()) {
            self.samples.push(Sample { y, signature });
        }
        Ok(())
    }

    /// Looks between lines that are not alike, until they are near enough to each other.
    #[inline(always)]
    fn resolve<S: Simd>(
        &mut self,
        simd: S,
        scene: &InCamera<'_>,
        cell: &Cell,
        precision: &Precision,
        batches: &mut u32,
    ) -> Result<(), Hard> {
        let mut index = 0;
        while index + 1 < self.samples.len() {
            let (low, high) = (self.samples[index], self.samples[index + 1]);
            let straddles = self.breaks.iter().any(|at| low.y < at.y && at.y < high.y);
            if low.signature == high.signature || straddles || high.y - low.y <= precision.width {
                index += 1;
                continue;
            }
            let step = (high.y - low.y) / 9.0;
            let mut y = [low.y; 8];
            for (index, y) in y.iter_mut().enumerate() {
                *y += (index + 1) as f64 * step;
            }
            self.look(simd, scene, cell, &y, precision, batches)?;
            let new = y.iter().zip(self.cuts.signatures());
            let new = new.map(|(&y, &signature)| Sample { y, signature });
            self.samples.splice(index + 1..index + 1, new);
        }
        Ok(())
    }

    #[inline(always)]
    fn look<S: Simd>(
        &mut self,
        simd: S,
        scene: &InCamera<'_>,
        cell: &Cell,
        y: &[f64; 8],
        precision: &Precision,
        batches: &mut u32,
    ) -> Result<(), Hard> {
        *batches += 1;
        self.work.lines += 8;
        self.effort += self.contents.extent();
        if *batches > MOST_BATCHES || self.is_over_budget() {
            return Err(Hard);
        }
        Ok(self
            .cuts
            .look(simd, scene, cell, &self.contents, y, precision.gap)?)
    }

    /// Makes tasks of the lines of a task between changes; what those changes may cost whose place
    /// is not quite known.
    fn make_tasks(&mut self, whole: &Task) -> f64 {
        let mut cost = 0.0;
        let mut start = whole.start;
        let mut at_start = whole.roots.at_start;
        let mut loose_start = whole.loose[0];
        for index in 0..self.samples.len() {
            let here = self.samples[index];
            let mut loose_end = INSET;
            let (end, at_end) = match self.samples.get(index + 1) {
                None => {
                    loose_end = whole.loose[1];
                    (whole.end, whole.roots.at_end)
                }
                Some(next) if next.signature == here.signature => continue,
                Some(next) => {
                    let known = self
                        .breaks
                        .iter()
                        .filter(|at| here.y < at.y && at.y < next.y);
                    match known.reduce(|one, other| if one.is_extreme { one } else { other }) {
                        Some(at) => (at.y, at.is_extreme),
                        None => {
                            loose_end = next.y - here.y;
                            cost += loose_end * loose_end.sqrt();
                            let changes = [here, *next].map(|sample| sample.signature.changes);
                            (0.5 * (here.y + next.y), changes[0].abs_diff(changes[1]) > 1)
                        }
                    }
                }
            };
            self.tasks.push(Task {
                start,
                end,
                roots: Roots { at_start, at_end },
                signature: here.signature,
                loose: [loose_start, loose_end],
                division: whole.division,
                depth: whole.depth + 1,
            });
            (start, at_start, loose_start) = (end, at_end, loose_end);
        }
        cost
    }
}

impl Task {
    /// All lines of a cell, of which nothing is known.
    const WHOLE: Self = Self {
        start: -0.5,
        end: 0.5,
        roots: Roots {
            at_start: false,
            at_end: false,
        },
        signature: Signature::EMPTY,
        loose: [INSET; 2],
        division: 1,
        depth: 0,
    };

    /// The lines of either half.
    fn halves(&self) -> [Self; 2] {
        let middle = 0.5 * (self.start + self.end);
        let mut halves = [*self; 2];
        halves[0].end = middle;
        halves[0].roots.at_end = false;
        halves[0].loose[1] = 0.0;
        halves[1].start = middle;
        halves[1].roots.at_start = false;
        halves[1].loose[0] = 0.0;
        halves
    }
}
