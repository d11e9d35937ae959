//! The pixels of a tile: which of them see one sphere and no edge, and which need lines.

use fearless_simd::prelude::*;

use super::Exact;
use super::classify::magnitude::is_ball_moderate;
use super::classify::occluder_cache::OccluderCache;
use super::classify::row::{Coverage, classify_row, visible_spheres};
use super::edged::cell::Workspace;
use super::interior::fill::fill;
use super::interior::filled::FilledRow;
use crate::edges::cell::Ball;
use crate::numeric::bits::set_bits;
use crate::picture::pixel::{Evidence, Pixel, Status, Work};
use crate::picture::tile::Tile;

impl Exact<'_> {
    #[inline(always)]
    pub(crate) fn tile<S: Simd>(
        &self,
        simd: S,
        tile: Tile,
        candidates: &[usize],
        workspace: &mut Workspace,
        pixels: &mut Vec<Pixel>,
    ) -> Work {
        workspace.balls.clear();
        for &sphere in candidates {
            workspace.balls.push(self.context.scene.ball(sphere));
        }
        let is_moderate = self.is_view_moderate && workspace.balls.iter().all(is_ball_moderate);
        if !is_moderate && !candidates.is_empty() {
            let count = tile.width as usize * tile.height as usize;
            pixels.extend(std::iter::repeat_n(Pixel::LOST, count));
            return Work::default();
        }
        let first = pixels.len();
        let count = tile.width as usize * tile.height as usize;
        pixels.extend(std::iter::repeat_n(self.empty(), count));
        if candidates.is_empty() {
            return Work::default();
        }
        let pixel = self
            .context
            .cell(Tile {
                width: 1,
                height: 1,
                ..tile
            })
            .size[0];
        let mut cache = OccluderCache::new(self.context.cell(tile), pixel);
        let mut coverages: Vec<Coverage> = Vec::with_capacity(candidates.len());
        let mut spheres: Vec<(usize, Ball)> = Vec::new();
        for row in 0..tile.height {
            for left in (0..tile.width).step_by(8) {
                let width = (tile.width - left).min(8);
                let start = Tile {
                    col: tile.col + left,
                    row: tile.row + row,
                    width: 1,
                    height: 1,
                };
                let at = first + (row * tile.width + left) as usize;
                let pixels = &mut pixels[at..at + width as usize];
                coverages.clear();
                workspace.work.candidate_tests += candidates.len() as u64 * u64::from(width);
                simd.vectorize(
                    #[inline(always)]
                    || {
                        let candidates = (candidates, workspace.balls.as_slice());
                        let (context, pixels) = (&self.context, (start, width));
                        classify_row(simd, context, pixels, candidates, &mut coverages);
                    },
                );
                let mut singles: Vec<(usize, u64)> = Vec::new();
                for (index, pixel) in pixels.iter_mut().enumerate() {
                    let seen = |coverage: &&Coverage| coverage.touched >> index & 1 == 1;
                    let mut touching = coverages.iter().filter(seen);
                    let Some(one) = touching.next() else { continue };
                    let is_single = touching.next().is_none() && one.covered >> index & 1 == 1;
                    spheres.clear();
                    if is_single {
                        spheres.push((one.sphere, one.ball));
                    } else {
                        let here = Tile {
                            col: start.col + index as u32,
                            ..start
                        };
                        let cell = self.context.cell(here);
                        visible_spheres(&cell, index, &coverages, &mut spheres);
                        let covers = |sphere: usize| {
                            coverages.iter().any(|coverage| {
                                coverage.sphere == sphere && coverage.covered >> index & 1 == 1
                            })
                        };
                        if spheres.len() != 1 || !covers(spheres[0].0) {
                            *pixel = self.pixel(simd, here, &spheres, &mut cache, workspace);
                            continue;
                        }
                    }
                    let sphere = spheres[0].0;
                    match singles.iter_mut().find(|single| single.0 == sphere) {
                        Some(single) => single.1 |= 1 << index,
                        None => singles.push((sphere, 1 << index)),
                    }
                }
                for (sphere, which) in singles {
                    let Some(coverage) = coverages.iter().find(|one| one.sphere == sphere) else {
                        continue;
                    };
                    let row = FilledRow {
                        start,
                        which,
                        coverage,
                    };
                    let noise = &mut workspace.noise;
                    let filled = fill(simd, &self.context, &row, &mut cache, noise, pixels);
                    workspace.work.samples += filled.samples;
                    for lane in set_bits(filled.hard) {
                        let here = Tile {
                            col: start.col + lane as u32,
                            ..start
                        };
                        let spheres = [(sphere, coverage.ball)];
                        pixels[lane] = self.pixel(simd, here, &spheres, &mut cache, workspace);
                    }
                }
            }
        }
        let mut work = std::mem::take(&mut workspace.work);
        work.candidate_tests += cache.tests;
        work
    }

    pub(crate) fn empty(&self) -> Pixel {
        Pixel {
            value: self.context.background,
            alpha: 0.0,
            error: 0.0,
            evidence: Evidence::Bound,
            status: Status::Met,
        }
    }
}
