//! Pixels with edges.

use std::collections::VecDeque;

use fearless_simd::prelude::*;

use super::Exact;
use super::classify::occluder_cache::OccluderCache;
use super::edged::cell::{Goal, Workspace};
use super::edged::piece::Part;
use crate::edges::cell::{Ball, Cell};
use crate::model::material::Material;
use crate::picture::pixel::{Evidence, Pixel, Status};
use crate::picture::tile::Tile;

/// What rounding, or parts of a pixel that were given up, may cost before samples know more.
const LOST: f64 = 0.01;

/// The tolerances that a pixel is tried with, in its own: further ones where it costs too much.
const LOOSER: [f64; 3] = [1.0, 10.0, 100.0];

/// Into how many parts pieces of edges are cut before events are looked for on them: into more where
/// something does not fit.
const FINER: [usize; 3] = [1, 2, 4];

/// So few edges are crossed by lines sooner than they are followed.
const FEW: usize = 2;

/// Powers that no rule along a chord overlooks.
const BROAD: f64 = 60.0;

/// How deep pixels are quartered.
const DEEPEST: i32 = 12;

impl Exact<'_> {
    /// A pixel with edges.
    pub(crate) fn pixel<S: Simd>(
        &self,
        simd: S,
        here: Tile,
        spheres: &[(usize, Ball)],
        cache: &mut OccluderCache,
        workspace: &mut Workspace,
    ) -> Pixel {
        workspace.contents.pixel = self.context.key(here, 0);
        let cell = self.context.cell(here);
        let mut part = Part {
            error: f64::INFINITY,
            ..Part::NOTHING
        };
        if let Some(found) = self.along_edges(simd, &cell, spheres, cache, workspace) {
            part = found;
            if part.error <= self.context.tolerance {
                return self.of_part(&part);
            }
        }
        // What is given up is better known to a tolerance that can be met.
        for looser in LOOSER {
            workspace.begin_pixel();
            let tolerance = looser * self.context.tolerance;
            let found = simd.vectorize(
                #[inline(always)]
                || self.parts(simd, cell, spheres, cache, workspace, tolerance),
            );
            if found.error < part.error || found.error.is_nan() {
                part = found;
            }
            if !workspace.is_over_budget() {
                break;
            }
        }
        // Samples at least see exactly.
        let is_lost = !(part.error.is_finite() && part.value.is_finite())
            || part.error > self.context.tolerance.max(LOST);
        if is_lost || part.rounding > self.context.tolerance.max(LOST) {
            return Pixel::LOST;
        }
        self.of_part(&part)
    }

    fn of_part(&self, part: &Part) -> Pixel {
        let error = part.error;
        Pixel {
            value: self.context.scene.spread(part.value),
            alpha: part.covered,
            error,
            evidence: Evidence::Estimate,
            status: if error <= self.context.tolerance {
                Status::Met
            } else if part.rounding > 0.5 * error {
                Status::AtRoundoff
            } else {
                Status::OutOfBudget
            },
        }
    }

    /// The average over a cell along the edges in it, where spheres are smooth and highlights broad.
    fn along_edges<S: Simd>(
        &self,
        simd: S,
        cell: &Cell,
        spheres: &[(usize, Ball)],
        cache: &mut OccluderCache,
        workspace: &mut Workspace,
    ) -> Option<Part> {
        let goal = Goal {
            tolerance: self.context.tolerance,
            background: self.context.background,
            contrast: self.context.contrast,
        };
        let mut found = None;
        workspace.work.candidate_tests += spheres.len() as u64;
        workspace
            .contents
            .see(&self.context.scene, cell, spheres, cache);
        workspace.is_seen = true;
        let contents = &workspace.contents;
        if contents.conics.len() + contents.occluders.len() <= FEW {
            return None;
        }
        let materials = contents.active.iter().map(|active| active.sphere);
        let mut materials = materials.map(|sphere| self.context.scene.world.material(sphere));
        let is_narrow = |material: &Material| {
            let shininess = material
                .highlight
                .map_or(0.0, |highlight| highlight.shininess);
            material.exponent.max(shininess) > BROAD
        };
        if materials.any(is_narrow) {
            let negligible = 0.01 * self.context.tolerance;
            let is_sharp = simd.vectorize(
                #[inline(always)]
                || contents.is_sharp(simd, &self.context.scene, cell, negligible),
            );
            if is_sharp {
                return None;
            }
        }
        for finer in FINER {
            let part = simd.vectorize(
                #[inline(always)]
                || {
                    let Workspace {
                        contents, boundary, ..
                    } = workspace;
                    boundary.parts = finer;
                    boundary.integrate(simd, &self.context.scene, cell, contents, &goal)
                },
            );
            workspace.work.samples += std::mem::take(&mut workspace.boundary.samples);
            let part = part?;
            let is_met = part.error <= self.context.tolerance;
            if found.is_none_or(|known: Part| part.error < known.error) {
                found = Some(part);
            }
            if is_met {
                break;
            }
        }
        found
    }

    /// The average over a cell, by the averages over its quarters where it is hard, and over theirs:
    /// large ones first, until the pixel has cost enough.
    fn parts<S: Simd>(
        &self,
        simd: S,
        cell: Cell,
        spheres: &[(usize, Ball)],
        cache: &mut OccluderCache,
        workspace: &mut Workspace,
        tolerance: f64,
    ) -> Part {
        let mut sum = Part::NOTHING;
        let mut left = VecDeque::from([(cell, 0)]);
        while let Some((cell, depth)) = left.pop_front() {
            let share = 0.25_f64.powi(depth);
            let part = if workspace.is_over_budget() {
                None
            } else {
                self.part(simd, &cell, spheres, cache, workspace, tolerance, depth)
            };
            match part {
                Some(part) => sum.add(&part, share),
                None if depth == DEEPEST || workspace.is_over_budget() => {
                    sum.error += self.context.contrast * share;
                }
                None => {
                    for y in [[-0.5, 0.0], [0.0, 0.5]] {
                        for x in [[-0.5, 0.0], [0.0, 0.5]] {
                            left.push_back((cell.part(x, y), depth + 1));
                        }
                    }
                }
            }
        }
        sum
    }

    /// The average over a cell, unless that is hard.
    #[expect(
        clippy::too_many_arguments,
        reason = "all of it is at hand where it is called"
    )]
    fn part<S: Simd>(
        &self,
        simd: S,
        cell: &Cell,
        spheres: &[(usize, Ball)],
        cache: &mut OccluderCache,
        workspace: &mut Workspace,
        tolerance: f64,
        depth: i32,
    ) -> Option<Part> {
        let goal = Goal {
            tolerance,
            background: self.context.background,
            contrast: self.context.contrast,
        };
        simd.vectorize(
            #[inline(always)]
            || {
                // The whole pixel was seen when its edges were counted.
                if !std::mem::take(&mut workspace.is_seen) {
                    workspace.work.candidate_tests += spheres.len() as u64;
                    workspace
                        .contents
                        .see(&self.context.scene, cell, spheres, cache);
                }
                workspace.spend_on_cell();
                let negligible = 0.01 * goal.tolerance;
                let is_sharp =
                    workspace
                        .contents
                        .is_sharp(simd, &self.context.scene, cell, negligible);
                if is_sharp && depth < DEEPEST {
                    return None;
                }
                let mut cell = *cell;
                if workspace
                    .contents
                    .prefers_transposed(&self.context.scene, &cell)
                {
                    cell = cell.transposed();
                    workspace.contents.transpose();
                }
                workspace
                    .integrate(simd, &self.context.scene, &cell, &goal)
                    .ok()
            },
        )
    }
}
