//! A pixel with edges: along the edges of the whole pixel, or by its parts.

use std::collections::VecDeque;

use fearless_simd::prelude::*;

use super::cell::{Goal, Workspace};
use crate::edges::cell::{Ball, Cell};
use crate::exact::classify::occluder_cache::OccluderCache;
use crate::exact::context::Context;
use crate::exact::part::{GiveUp, Part};
use crate::model::material::Material;

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

/// A pixel with edges.
#[derive(Clone, Copy, Debug)]
pub(crate) struct EdgedPixel<'a, 'scene> {
    pub(crate) context: &'a Context<'scene>,
    pub(crate) cell: Cell,
    /// The spheres that may be seen.
    pub(crate) spheres: &'a [(usize, Ball)],
}

impl EdgedPixel<'_, '_> {
    fn goal(&self, tolerance: f64) -> Goal {
        Goal {
            tolerance,
            background: self.context.background,
            contrast: self.context.contrast,
        }
    }

    /// The average along the edges, where spheres are smooth and highlights broad.
    pub(crate) fn along_edges<S: Simd>(
        &self,
        simd: S,
        cache: &mut OccluderCache,
        workspace: &mut Workspace,
    ) -> Result<Part, GiveUp> {
        let scene = &self.context.scene;
        let tolerance = self.context.tolerance;
        workspace.see(scene, &self.cell, self.spheres, cache);
        let contents = &workspace.contents;
        if contents.conics.len() + contents.occluders.len() <= FEW {
            return Err(GiveUp::FewEdges);
        }
        let materials = contents.active.iter().map(|active| active.sphere);
        let mut materials = materials.map(|sphere| scene.world.material(sphere));
        let is_narrow = |material: &Material| {
            let shininess = material
                .highlight
                .map_or(0.0, |highlight| highlight.shininess);
            material.exponent.max(shininess) > BROAD
        };
        if materials.any(is_narrow) {
            let negligible = 0.01 * tolerance;
            let is_sharp = simd.vectorize(
                #[inline(always)]
                || contents.is_sharp(simd, scene, &self.cell, negligible),
            );
            if is_sharp {
                return Err(GiveUp::Narrow);
            }
        }
        let mut best = GiveUp::NoPrimitive;
        for finer in FINER {
            let part = simd.vectorize(
                #[inline(always)]
                || {
                    let Workspace {
                        contents, boundary, ..
                    } = workspace;
                    boundary.parts = finer;
                    boundary.integrate(simd, scene, &self.cell, contents, &self.goal(tolerance))
                },
            );
            workspace.work.samples += std::mem::take(&mut workspace.boundary.samples);
            let Some(part) = part else { return Err(best) };
            if part.error <= tolerance {
                return Ok(part);
            }
            match best {
                GiveUp::Claims(known) if !(part.error < known.error) => {}
                _ => best = GiveUp::Claims(part),
            }
        }
        Err(best)
    }

    /// The average by parts, to a looser tolerance where that costs too much: what is given up is better known
    /// to a tolerance that can be met. `why` tells what is known so far.
    pub(crate) fn by_parts<S: Simd>(
        &self,
        simd: S,
        why: GiveUp,
        cache: &mut OccluderCache,
        workspace: &mut Workspace,
    ) -> Result<Part, GiveUp> {
        let mut best = match why {
            GiveUp::Claims(part) => part,
            _ => Part {
                error: f64::INFINITY,
                ..Part::NOTHING
            },
        };
        for (attempt, looser) in LOOSER.into_iter().enumerate() {
            workspace.begin_pixel();
            let tolerance = looser * self.context.tolerance;
            let found = simd.vectorize(
                #[inline(always)]
                || self.parts(simd, attempt > 0, cache, workspace, tolerance),
            );
            if found.error < best.error || found.error.is_nan() {
                best = found;
            }
            if !workspace.is_over_budget() {
                break;
            }
        }
        // Samples at least see exactly.
        let most = self.context.tolerance.max(LOST);
        let is_known = best.value.is_finite() && best.error <= most && best.rounding <= most;
        if is_known {
            Ok(best)
        } else {
            Err(GiveUp::Unknown)
        }
    }

    /// The average by that over its quarters where it is hard, and over theirs: large ones first, until the
    /// pixel has cost enough. `is_anew` tells that the workspace does not hold the contents of the whole pixel.
    fn parts<S: Simd>(
        &self,
        simd: S,
        is_anew: bool,
        cache: &mut OccluderCache,
        workspace: &mut Workspace,
        tolerance: f64,
    ) -> Part {
        let mut sum = Part::NOTHING;
        let mut left = VecDeque::from([(self.cell, 0)]);
        while let Some((cell, depth)) = left.pop_front() {
            let share = 0.25_f64.powi(depth);
            let part = if workspace.is_over_budget() {
                None
            } else {
                if is_anew || depth > 0 {
                    workspace.see(&self.context.scene, &cell, self.spheres, cache);
                }
                self.part(simd, &cell, depth, workspace, tolerance)
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

    /// The average over a part, whose contents the workspace holds, unless that is hard.
    fn part<S: Simd>(
        &self,
        simd: S,
        cell: &Cell,
        depth: i32,
        workspace: &mut Workspace,
        tolerance: f64,
    ) -> Option<Part> {
        let scene = &self.context.scene;
        let goal = self.goal(tolerance);
        simd.vectorize(
            #[inline(always)]
            || {
                workspace.spend_on_cell();
                let negligible = 0.01 * goal.tolerance;
                let is_sharp = workspace.contents.is_sharp(simd, scene, cell, negligible);
                if is_sharp && depth < DEEPEST {
                    return None;
                }
                let mut cell = *cell;
                if workspace.contents.prefers_transposed(scene, &cell) {
                    cell = cell.transposed();
                    workspace.contents.transpose();
                }
                workspace.integrate(simd, scene, &cell, &goal).ok()
            },
        )
    }
}
