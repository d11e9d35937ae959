//! The integral over a pixel, to a tolerance: a ladder of ways, from the cheapest.
//!
//! Eight pixels of a row climb the first rungs together, and a pixel with edges climbs alone. A rung
//! answers, or it gives up and says why ([`GiveUp`]); then the next one begins.
//!
//! | rung | answer | worth | leaves to the next rung |
//! |---|---|---|---|
//! | no sphere: [`classify`] | the background | bound | pixels that may see a sphere |
//! | one sphere without light: [`interior`] | the ambient light | bound | pixels that a light reaches |
//! | one sphere: [`interior`] | rules with 1, 5, 9 or 17 samples, of bumps in parts | bound on smooth spheres, as a rule; else estimate | edges, and light that bends too much |
//! | bumps far smaller than the pixel: [`interior`] | random samples in strata | estimate | nothing |
//! | boxes with straight edges, to tolerances from about 1e-3 on: [`edged`] | shares of half-planes | estimate | claims above the tolerance |
//! | along edges: [`edged`] | Green's theorem | estimate | narrow highlights, claims above the tolerance |
//! | parts of the pixel: [`edged`] | quarters, and theirs, until they cost too much | estimate | pixels of which less than samples see is known |
//! | 8 × 8 samples: [`integrator`] | the mean, off by the whole contrast | bound | nothing |
//!
//! [`budget`] limits what a pixel may cost. A pixel that ends over its tolerance says so.

pub(crate) mod areas;
pub(crate) mod budget;
mod classify;
mod context;
mod costs;
mod edged;
pub(crate) mod integrator;
mod interior;
mod part;
mod points;
mod scene;
mod surface;

use fearless_simd::prelude::*;

use self::budget::{FILLED, TileCosts};
use self::classify::magnitude::is_ball_moderate;
use self::classify::occluder_cache::OccluderCache;
use self::classify::row::{Coverage, Sight, classify_row, sight};
use self::context::Context;
use self::edged::cell::{EdgedPixel, Workspace};
use self::interior::fill::fill;
use self::interior::filled::FilledRow;
use self::part::GiveUp;
use crate::edges::cell::Ball;
use crate::numeric::bits::set_bits;
use crate::picture::pixel::{Pixel, Work};
use crate::picture::tile::Tile;

/// Memory that a thread works in, for tile after tile.
#[derive(Debug, Default)]
struct Scratch {
    /// The candidates of a tile.
    balls: Vec<Ball>,
    coverages: Vec<Coverage>,
    /// The spheres that a pixel may see.
    spheres: Vec<(usize, Ball)>,
    /// The spheres that fill pixels of a row, and these pixels bit by bit.
    filled: Vec<(usize, u64)>,
    edged: Workspace,
    costs: TileCosts,
}

impl Scratch {
    /// Brings the candidates of a tile into the camera's frame.
    fn prepare(&mut self, context: &Context<'_>, candidates: &[usize]) {
        let balls = candidates.iter().map(|&sphere| context.scene.ball(sphere));
        self.balls.clear();
        self.balls.extend(balls);
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

/// Appends the pixels of a tile under one group of lights; returns those of which nothing is known, bit by
/// bit in the order of [`Tile::pixels`].
#[inline(always)]
fn tile_pixels<S: Simd>(
    simd: S,
    context: &Context<'_>,
    tile: Tile,
    candidates: &[usize],
    scratch: &mut Scratch,
    pixels: &mut Vec<Pixel>,
) -> u64 {
    let first = pixels.len();
    pixels.extend(std::iter::repeat_n(
        context.empty_pixel(),
        tile.count() as usize,
    ));
    if candidates.is_empty() {
        return 0;
    }
    let pixel_size = context
        .cell(Tile {
            width: 1,
            height: 1,
            ..tile
        })
        .size[0];
    let mut cache = OccluderCache::new(context.cell(tile), pixel_size);
    let mut unknown = 0;
    for row in 0..tile.height {
        for left in (0..tile.width).step_by(8) {
            let place = row * tile.width + left;
            let start = Tile {
                col: tile.col + left,
                row: tile.row + row,
                width: (tile.width - left).min(8),
                height: 1,
            };
            let pixels = &mut pixels[first + place as usize..][..start.width as usize];
            let of_row = row_pixels(
                simd,
                context,
                (start, place as usize),
                candidates,
                (scratch, &mut cache),
                pixels,
            );
            unknown |= of_row << place;
        }
    }
    scratch.edged.work.candidate_tests += cache.tests;
    unknown
}

/// Writes up to eight pixels of a row, which are empty so far and begin at a place of their tile; returns those of
/// which nothing is known.
#[inline(always)]
fn row_pixels<S: Simd>(
    simd: S,
    context: &Context<'_>,
    (row, place): (Tile, usize),
    candidates: &[usize],
    (scratch, cache): (&mut Scratch, &mut OccluderCache),
    pixels: &mut [Pixel],
) -> u64 {
    let Scratch {
        balls,
        coverages,
        spheres,
        filled,
        edged,
        costs,
    } = scratch;
    edged.work.candidate_tests += candidates.len() as u64 * u64::from(row.width);
    coverages.clear();
    simd.vectorize(
        #[inline(always)]
        || classify_row(simd, context, row, (candidates, balls), coverages),
    );
    let pixel = |lane: usize| Tile {
        col: row.col + lane as u32,
        width: 1,
        ..row
    };
    let mut unknown = 0;

    // Pixels that see no sphere are empty already; those with edges climb alone.
    filled.clear();
    for (lane, target) in pixels.iter_mut().enumerate() {
        match sight(context, pixel(lane), lane, coverages, spheres) {
            Sight::Nothing => {}
            Sight::Filled(sphere) => match filled.iter_mut().find(|known| known.0 == sphere) {
                Some((_, lanes)) => *lanes |= 1 << lane,
                None => filled.push((sphere, 1 << lane)),
            },
            Sight::Edges => {
                match edged_pixel(simd, context, pixel(lane), spheres, cache, edged) {
                    Ok(known) => *target = known,
                    Err(_) => unknown |= 1 << lane,
                }
                costs.add(place + lane, edged.budget.spent());
            }
        }
    }

    // Pixels that one sphere fills climb together, until a light has an edge in them, or bends too much.
    for &(sphere, which) in &*filled {
        let Some(coverage) = coverages.iter().find(|one| one.sphere == sphere) else {
            continue;
        };
        // Rules for pixels that one sphere fills know no point lights.
        if context.scene.has_near_lights && coverage.ball.outside > 0.0 {
            for lane in set_bits(which) {
                let spheres = [(sphere, coverage.ball)];
                match edged_pixel(simd, context, pixel(lane), &spheres, cache, edged) {
                    Ok(known) => pixels[lane] = known,
                    Err(_) => unknown |= 1 << lane,
                }
                costs.add(place + lane, edged.budget.spent());
            }
            continue;
        }
        let of_sphere = FilledRow {
            start: pixel(0),
            which,
            coverage,
        };
        let done = fill(simd, context, &of_sphere, cache, &mut edged.noise, pixels);
        edged.work.samples += done.samples;
        let is_rough = context.scene.world.material(sphere).roughness.is_some();
        for lane in set_bits(which) {
            costs.add(
                place + lane,
                FILLED[usize::from(is_rough)] + done.of_bumps[lane],
            );
        }
        for lane in set_bits(done.hard) {
            let spheres = [(sphere, coverage.ball)];
            match edged_pixel(simd, context, pixel(lane), &spheres, cache, edged) {
                Ok(known) => pixels[lane] = known,
                Err(_) => unknown |= 1 << lane,
            }
            costs.add(place + lane, edged.budget.spent());
        }
    }
    unknown
}

/// The rungs for a pixel with edges.
fn edged_pixel<S: Simd>(
    simd: S,
    context: &Context<'_>,
    pixel: Tile,
    spheres: &[(usize, Ball)],
    cache: &mut OccluderCache,
    workspace: &mut Workspace,
) -> Result<Pixel, GiveUp> {
    let edged = EdgedPixel {
        context,
        cell: context.cell(pixel),
        key: context.key(pixel, 0),
        spheres,
    };
    // Along the edges of the whole pixel.
    let whole = workspace.along_edges(simd, &edged, cache);
    // Highlights are narrow, or the claim is too large: parts of the pixel.
    let part = match whole {
        Ok(part) => part,
        Err(why) => workspace.by_parts(simd, &edged, why, cache)?,
    };
    Ok(context.pixel_of(&part))
}
