//! Pixels with edges.

use fearless_simd::prelude::*;

use super::Exact;
use super::cell::{Goal, Hard, Workspace};
use super::contents::CasterCache;
use super::cut::MOST_LIGHTS;
use super::piece::Part;
use crate::edges::Cell;
use crate::integration::{Evidence, Pixel, Status};
use crate::roughness::PixelKey;
use crate::{Radiance, Tile};

/// What rounding, or parts of a pixel that were given up, may cost before samples know more.
const LOST: f64 = 0.01;

/// How deep pixels are quartered.
const DEEPEST: u32 = 4;

impl Exact<'_> {
    pub(super) fn key(&self, start: Tile, lane: u32) -> PixelKey {
        PixelKey {
            col: start.col + lane,
            row: start.row,
            frame: self.view.frame,
        }
    }

    /// A pixel with edges.
    pub(super) fn pixel<S: Simd, C: Radiance>(
        &self,
        simd: S,
        here: Tile,
        spheres: &[usize],
        cache: &mut CasterCache,
        workspace: &mut Workspace,
    ) -> Pixel<C> {
        let key = self.key(here, 0);
        if self.scene.lights.len() > MOST_LIGHTS {
            return self.fallback.pixel_of_last_resort(key);
        }
        workspace.contents.pixel = Some(key);
        workspace.begin_pixel();
        let cell = self.cell(here);
        let part = simd.vectorize(
            #[inline(always)]
            || self.part::<S, C>(simd, &cell, spheres, cache, workspace, 0),
        );
        // Samples at least see exactly.
        let is_lost = !(part.error.is_finite() && part.value.is_finite())
            || part.error > self.tolerance.max(LOST);
        if is_lost || part.rounding > self.tolerance.max(LOST) {
            return self.fallback.pixel_of_last_resort(key);
        }
        let error = part.error;
        Pixel {
            value: C::from_color(part.value),
            alpha: part.covered,
            error,
            evidence: Evidence::Estimate,
            status: if error <= self.tolerance {
                Status::Met
            } else if part.rounding > 0.5 * error {
                Status::AtRoundoff
            } else {
                Status::OutOfBudget
            },
        }
    }

    /// The average over a cell, or over its quarters where that is hard.
    fn part<S: Simd, C: Radiance>(
        &self,
        simd: S,
        cell: &Cell,
        spheres: &[usize],
        cache: &mut CasterCache,
        workspace: &mut Workspace,
        depth: u32,
    ) -> Part {
        let goal = Goal {
            tolerance: self.tolerance,
            background: self.background(),
            contrast: self.contrast,
        };
        let part = simd.vectorize(
            #[inline(always)]
            || {
                workspace.contents.see(&self.scene, cell, spheres, cache);
                let negligible = 0.01 * goal.tolerance;
                if depth < DEEPEST
                    && workspace
                        .contents
                        .is_sharp(simd, &self.scene, cell, negligible)
                {
                    return Err(Hard);
                }
                let mut cell = *cell;
                if workspace.contents.prefers_transposed(&self.scene, &cell) {
                    cell = cell.transposed();
                    workspace.contents.transpose();
                }
                workspace.integrate::<S, C>(simd, &self.scene, &cell, &goal)
            },
        );
        match part {
            Ok(part) => part,
            Err(Hard) if depth == DEEPEST || workspace.is_over_budget() => Part {
                error: self.contrast,
                ..Part::NOTHING
            },
            Err(Hard) => {
                let mut sum = Part::NOTHING;
                for y in [[-0.5, 0.0], [0.0, 0.5]] {
                    for x in [[-0.5, 0.0], [0.0, 0.5]] {
                        let quarter = cell.part(x, y);
                        let part =
                            self.part::<S, C>(simd, &quarter, spheres, cache, workspace, depth + 1);
                        sum.add(&part, 0.25);
                    }
                }
                sum
            }
        }
    }
}
