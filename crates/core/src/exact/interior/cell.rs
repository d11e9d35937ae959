//! A cell that one sphere fills, and that lights reach all over, or nowhere.

use fearless_simd::Simd;

use super::filled::Filled;
use super::half_turns::{nearness_of_silhouette, view_turn};
use super::parts::{ALL, Average};
use super::reached::SHARPEST;
use super::terminators::SMALL;
use crate::edges::cell::Cell;
use crate::exact::budget::{Allowance, MOST};
use crate::exact::classify::contents::Contents;
use crate::exact::classify::patch::Patch;
use crate::exact::classify::reach::Reach;
use crate::exact::context::NEGLIGIBLE;
use crate::exact::points::Points;
use crate::exact::scene::{InCamera, MOST_LIGHTS};
use crate::exact::surface::Finish;
use crate::model::roughness::noise::NoiseCells;
use crate::numeric::lanes::f64x8;
use crate::numeric::vectors::Vectors;

/// Divisions that a cell is worth; each takes forty samples.
const MOST_DIVISIONS: usize = 128;

/// Parts, each for five samples, up to which bumps are only looked at in parts; and, at tolerances from `LOOSE` on, which
/// some parts may meet, up to which they are left to random samples where parts claim too much.
const FEW_PARTS: f64 = 4.0 * MOST_DIVISIONS as f64;
const MOST_PARTS: f64 = 16.0 * FEW_PARTS;
const LOOSE: f64 = 1e-4;

/// Divisions at tolerances for which rules along lines are better than rules of five samples.
const FEW_DIVISIONS: usize = 8;
const FINE: f64 = 1.2e-6;

/// The units of a pixel's budget for each division that it is worth.
const UNITS_OF_DIVISION: u64 = MOST / MOST_DIVISIONS as u64;

/// Strata on a side of a cell: those of one of many moments, those of a first look, and those by which a tolerance
/// may be met.
const FEW_STRATA: u32 = 4;
const FIRST_STRATA: u32 = 16;
const MOST_STRATA: u32 = 32;

impl<S: Simd> Filled<'_, S> {
    /// The average over one of the cells, if it has bumps: in parts, or by strata where bumps are too many.
    pub(crate) fn of_bumps(
        &self,
        simd: S,
        lane: usize,
        noise: &mut Option<Box<NoiseCells>>,
    ) -> Option<Average> {
        if !self.finish.is_bumpy() {
            return None;
        }
        // Parts as small as they must be for five samples.
        let across = self.turn[lane] * self.finish.shading_normal.cells() / SMALL;
        let mut best = None;
        let is_loose = self.tolerance >= LOOSE;
        if across * across < if is_loose { MOST_PARTS } else { FEW_PARTS } {
            let most = if self.tolerance < FINE {
                FEW_DIVISIONS
            } else {
                MOST_DIVISIONS
            };
            let most = most.min((self.allowance.bumpy / UNITS_OF_DIVISION) as usize);
            let average = self.in_parts(simd, lane, most, noise);
            if average.error <= self.tolerance || across * across < FEW_PARTS {
                return Some(average);
            }
            best = Some(average);
        }
        let random = self.of_random(simd, lane, noise);
        Some(match best {
            Some(best) if best.error <= random.error => Average {
                samples: best.samples + random.samples,
                ..best
            },
            Some(best) => Average {
                samples: best.samples + random.samples,
                ..random
            },
            None => random,
        })
    }

    /// The average over one of the cells by strata.
    fn of_random(&self, simd: S, lane: usize, noise: &mut Option<Box<NoiseCells>>) -> Average {
        // At a moment of many a look must do.
        if self.allowance.is_of_moment() {
            return self.by_strata(simd, lane, FEW_STRATA, noise);
        }
        let first = self.by_strata(simd, lane, FIRST_STRATA, noise);
        // With so many more samples the claim falls by that at most.
        let gain = f64::from(MOST_STRATA * MOST_STRATA) / f64::from(FIRST_STRATA * FIRST_STRATA);
        if first.error <= self.tolerance || first.error > gain * self.tolerance {
            return first;
        }
        let more = self.by_strata(simd, lane, MOST_STRATA, noise);
        Average {
            samples: first.samples + more.samples,
            ..more
        }
    }

    /// The average over the first of the cells, with these points in the middles, if its light is smooth enough.
    #[inline(always)]
    fn of_smooth(
        &self,
        simd: S,
        points: &Points<S>,
        noise: &mut Option<Box<NoiseCells>>,
    ) -> Option<Average> {
        let negligible = NEGLIGIBLE * self.tolerance;
        let mut turn = self.turn;
        if !self.ball.is_parallel() {
            turn += self.size[0].max(self.size[1]);
        }
        for (lit, light) in self.lit.iter().zip(&self.scene.lights) {
            let finish = self.finish;
            if *lit != 0 && finish.too_sharp(simd, points, light, turn, SHARPEST, negligible) != 0 {
                return None;
            }
        }
        let averages = self.averages(simd, noise);
        let error = averages.errors[0];
        (error <= self.tolerance).then(|| Average {
            value: averages.values[0],
            error,
            samples: averages.samples as u64,
            is_random: false,
        })
    }
}

/// The average over a cell, if one sphere is all that is seen in it, and no edge of a shadow: with bumps, or with
/// smooth light that rules follow to the tolerance.
#[inline(never)]
pub(crate) fn of_filled_cell<S: Simd>(
    simd: S,
    scene: &InCamera<'_>,
    cell: &Cell,
    contents: &Contents,
    (tolerance, allowance): (f64, Allowance),
    noise: &mut Option<Box<NoiseCells>>,
) -> Option<Average> {
    let [active] = contents.active.as_slice() else {
        return None;
    };
    let finish = &Finish::new(scene, active.sphere, contents.pixel);
    let ball = &active.ball;
    let is_smooth = !finish.is_rough() && finish.has_whole_exponent();
    let has_edges = !contents.conics.is_empty() || contents.has_outlines();
    if has_edges || ball.outside <= 0.0 || !(is_smooth || finish.is_bumpy()) {
        return None;
    }
    if active.discriminant.one <= 0.0 {
        return None;
    }
    let mut lit = [0; MOST_LIGHTS];
    for (lit, reach) in lit.iter_mut().zip(&contents.reach) {
        match reach {
            Reach::Nowhere => {}
            Reach::Past(casters) if casters.is_empty() => *lit = ALL,
            Reach::Past(_) => return None,
        }
    }
    simd.vectorize(
        #[inline(always)]
        || {
            let zero = f64x8::splat(simd, 0.0);
            let middle = Vectors::splat(simd, cell.middle);
            let points = Points::new(simd, ball, middle);
            let patch = Patch::new(cell, ball, &active.discriminant, &active.along);
            let length = cell.ray_length();
            let at = points.t[0] * length;
            let ends = patch.ends.map(|end| match cell.is_parallel() {
                true => (end.z - at).abs(),
                false => (end.length() - at).abs(),
            });
            let turn = (ends[0].max(ends[1]) + patch.around) / ball.radius;
            let grazing = -points.normal.dot(&points.ray)[0] / length;
            let [width, height] = cell.size;
            let half_diagonal = 0.5 * (width * width + height * height).sqrt();
            let view_turn = view_turn(ball, zero + length, half_diagonal);
            let filled = Filled {
                scene,
                ball,
                finish,
                middle,
                size: cell.size,
                lit: &lit,
                turn: zero + turn,
                view_turn,
                nearness: nearness_of_silhouette(zero + turn, view_turn, zero + grazing.max(0.0)),
                which: 1,
                tolerance,
                allowance,
                is_proved: false,
            };
            if !is_smooth {
                return filled.of_bumps(simd, 0, noise);
            }
            filled.of_smooth(simd, &points, noise)
        },
    )
}
