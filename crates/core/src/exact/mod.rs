//! The integral over a pixel, to a tolerance: a ladder of ways, from the cheapest ([`ladder`]).

pub(crate) mod areas;
pub(crate) mod budget;
mod classify;
mod context;
mod costs;
mod crowd;
mod crowd_blocks;
mod edged;
pub(crate) mod integrator;
mod interior;
mod ladder;
#[cfg(test)]
mod only_pixel;
mod parallel_begin;
mod part;
mod points;
mod scene;
mod surface;

use fearless_simd::Simd;

use self::budget::{FILLED, MOST_SPHERES, TileCosts};
use self::classify::magnitude::is_ball_moderate;
use self::classify::occluder_cache::OccluderCache;
use self::classify::seen::SeenRow;
use self::context::Context;
use self::crowd::{CrowdWork, FEWEST, Looks};
use self::edged::cell::Workspace;
use self::interior::fill::fill;
use self::interior::filled::FilledRow;
use self::interior::reached::Extents;
use crate::edges::cell::Ball;
use crate::numeric::bits::set_bits;
use crate::picture::pixel::{Pixel, Work};
use crate::picture::tile::Tile;

/// Memory that a thread works in, for tile after tile.
#[derive(Debug, Default)]
struct Scratch {
    /// The candidates of a tile.
    balls: Vec<Ball>,
    seen: SeenRow,
    edged: Workspace,
    /// The pixels of the last tile that are known without, bit by bit.
    known: u64,
    /// The last tile, under one group of lights after the other.
    lit: Vec<LitTile>,
}

/// A tile under one group of lights.
#[derive(Debug)]
struct LitTile {
    cache: OccluderCache,
    /// In the order of [`Tile::pixels`].
    pixels: Vec<Pixel>,
    costs: TileCosts,
    crowds: CrowdWork,
    /// Whether it may see so many spheres that those of each pixel are a crowd, however few.
    is_dense: bool,
    /// The pixels of which nothing is known, bit by bit.
    unknown: u64,
}

impl Scratch {
    /// Brings the candidates of a tile into the camera's frame.
    fn prepare(&mut self, context: &Context<'_>, candidates: &[usize]) {
        let balls = candidates.iter().map(|&sphere| context.scene.ball(sphere));
        self.balls.clear();
        self.balls.extend(balls);
    }

    /// Begins with a tile that may see so many spheres under some groups of lights: with empty pixels, in the memory of
    /// the last tile.
    fn begin(&mut self, contexts: &[&Context<'_>], tile: Tile, candidates: usize) {
        self.lit.truncate(contexts.len());
        for (lit, context) in self.lit.iter_mut().zip(contexts) {
            lit.begin(context, tile, candidates);
        }
        let others = contexts[self.lit.len()..].iter();
        self.lit
            .extend(others.map(|context| LitTile::new(context, tile, candidates)));
    }

    /// Takes note of a tile whose pixels cost nothing.
    fn leave_out(&mut self, tile: Tile) {
        for lit in &mut self.lit {
            lit.costs.clear(tile.count());
        }
    }

    /// Whether the numbers of all candidates are moderate enough for edges in doubles.
    fn are_balls_moderate(&self) -> bool {
        self.balls.iter().all(is_ball_moderate)
    }

    /// The work since this was asked the last time.
    fn take_work(&mut self) -> Work {
        std::mem::take(&mut self.edged.work)
    }
}

impl LitTile {
    fn new(context: &Context<'_>, tile: Tile, candidates: usize) -> Self {
        let mut lit = Self {
            cache: OccluderCache::new(context.cell(tile), 0.0),
            pixels: Vec::new(),
            costs: TileCosts::default(),
            crowds: CrowdWork::default(),
            is_dense: false,
            unknown: 0,
        };
        lit.begin(context, tile, candidates);
        lit
    }

    /// Begins with the empty pixels of a tile that may see so many spheres.
    fn begin(&mut self, context: &Context<'_>, tile: Tile, candidates: usize) {
        let one = Tile {
            width: 1,
            height: 1,
            ..tile
        };
        let [width, height] = context.cell(one).size;
        let of_crowds = context.of_crowds.of(candidates);
        self.is_dense = candidates > MOST_SPHERES;
        self.cache
            .begin(context.cell(tile), width.min(height), of_crowds);
        self.pixels.clear();
        self.pixels
            .resize(tile.count() as usize, context.empty_pixel());
        self.costs.clear(tile.count());
        self.crowds = CrowdWork::new(of_crowds);
        if self.is_dense {
            // All of them were asked what they cover and whether they are hidden, in the tile and in blocks around it.
            self.crowds.spend(candidates as u64);
        }
        self.unknown = 0;
    }
}

/// Computes the pixels of a tile that was begun, under all groups of lights: these have the view in common, and what
/// it sees is found out once.
#[inline(always)]
fn tile_pixels<S: Simd>(
    simd: S,
    contexts: &[&Context<'_>],
    tile: Tile,
    candidates: &[usize],
    scratch: &mut Scratch,
) {
    let Scratch {
        balls,
        seen,
        edged,
        lit,
        known,
    } = scratch;
    let (Some(first), Some(first_lit)) = (contexts.first(), lit.first()) else {
        return;
    };
    if candidates.is_empty() {
        return;
    }
    let of_crowds = first_lit.crowds.left();
    let is_analytic = contexts.iter().any(|context| context.normals.is_some());
    seen.crowds = CrowdWork::new(of_crowds);
    for row in 0..tile.height {
        for left in (0..tile.width).step_by(8) {
            let start = Tile {
                col: tile.col + left,
                row: tile.row + row,
                width: (tile.width - left).min(8),
                height: 1,
            };
            let place = (row * tile.width + left) as usize;
            let known = *known >> place & ((1 << start.width) - 1);
            if known == (1 << start.width) - 1 {
                continue;
            }
            if candidates.len() > MOST_SPHERES && seen.crowds.left() == 0 {
                for lit in &mut *lit {
                    lit.unknown |= (((1 << start.width) - 1) & !known) << place;
                }
                continue;
            }
            edged.work.candidate_tests += candidates.len() as u64 * u64::from(start.width);
            let before = seen.crowds.left();
            seen.see(simd, first, start, (candidates, balls));
            let looking = before - seen.crowds.left();
            edged.normals.clear();
            for (context, lit) in contexts.iter().zip(&mut *lit) {
                lit.crowds.spend(looking);
                // Pixels that see no sphere are empty already; those with edges climb alone.
                for (lane, spheres) in seen.edged() {
                    if known >> lane & 1 == 1 {
                        continue;
                    }
                    lit.climb(simd, context, (start, place), (lane, spheres), edged);
                }
            }
            for (coverage, which) in seen.filled() {
                let which = which & !known;
                if which == 0 {
                    continue;
                }
                let row = FilledRow {
                    start: Tile { width: 1, ..start },
                    which,
                    coverage,
                };
                let mut extents = None;
                if coverage.ball.outside > 0.0 {
                    simd.vectorize(
                        #[inline(always)]
                        || extents = Some(Extents::new(simd, first, &row, is_analytic)),
                    );
                }
                for (context, lit) in contexts.iter().zip(&mut *lit) {
                    let of_row = (&row, extents.as_ref());
                    lit.fill(simd, context, of_row, (start, place), edged);
                }
            }
        }
    }
    for lit in lit {
        edged.work.candidate_tests += lit.cache.tests;
    }
}

impl LitTile {
    /// Writes a pixel that climbs alone, in a row of up to eight that begins at a place of the tile.
    fn climb<S: Simd>(
        &mut self,
        simd: S,
        context: &Context<'_>,
        (row, place): (Tile, usize),
        (lane, spheres): (usize, &[(usize, Ball)]),
        edged: &mut Workspace,
    ) {
        let pixel = Tile {
            col: row.col + lane as u32,
            width: 1,
            ..row
        };
        edged.left_by_tile = self.crowds.of_pixel();
        edged.is_crowd = spheres.len() > if self.is_dense { 1 } else { FEWEST };
        let (asked, units) = (edged.work.candidate_tests, self.cache.units);
        match ladder::climb(simd, context, pixel, spheres, &mut self.cache, edged) {
            Ok(known) => self.pixels[place + lane] = known,
            Err(_) => self.unknown |= 1 << (place + lane),
        }
        let looks = Looks {
            asked: edged.work.candidate_tests - asked,
            units: self.cache.units - units,
            is_crowd: edged.is_crowd,
        };
        self.crowds.spend_on_pixel(&edged.budget, looks);
        self.costs.add(place + lane, edged.budget.spent());
    }

    /// Writes the pixels of such a row that one sphere fills: they climb together, until a light has an edge in them, or
    /// bends too much.
    #[inline(always)]
    fn fill<S: Simd>(
        &mut self,
        simd: S,
        context: &Context<'_>,
        (of_sphere, extents): (&FilledRow<'_>, Option<&Extents<'_, S>>),
        (row, place): (Tile, usize),
        edged: &mut Workspace,
    ) {
        let FilledRow {
            which, coverage, ..
        } = *of_sphere;
        let spheres = [(coverage.sphere, coverage.ball)];
        // Rules for pixels that one sphere fills know no point lights.
        if context.scene.has_near_lights && coverage.ball.outside > 0.0 {
            for lane in set_bits(which) {
                self.climb(simd, context, (row, place), (lane, &spheres), edged);
            }
            return;
        }
        let memory = (&mut edged.noise, &mut edged.normals.filled);
        let pixels = &mut self.pixels[place..][..row.width as usize];
        let of_row = (of_sphere, extents);
        let units = self.cache.units;
        let done = fill(simd, context, of_row, &mut self.cache, memory, pixels);
        self.crowds.spend(self.cache.units - units);
        edged.work.samples += done.samples;
        let material = context.scene.world.material(coverage.sphere);
        let is_rough = material.roughness.is_some();
        for lane in set_bits(which) {
            let cost = FILLED[usize::from(is_rough)] + done.of_bumps[lane];
            self.costs.add(place + lane, cost);
        }
        for lane in set_bits(done.hard) {
            self.climb(simd, context, (row, place), (lane, &spheres), edged);
        }
    }
}
