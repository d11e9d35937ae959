//! The error of one sample in the middle of pixels with bumps.

use fearless_simd::Simd;

use super::estimate::{Estimate, MOST_NEARNESS};
use super::filled::Filled;
use super::light_cosines::LightCosines;
use super::terminators::SMALL;
use crate::exact::costs::highest_cosine;
use crate::exact::scene::Light;
use crate::numeric::lanes::{f64x8, mask64x8};

/// Tolerances from which on one sample of bumps may suffice: at lower ones hardly any pixel is smooth enough.
const LOOSE_ON_BUMPS: f64 = 5e-4;

/// The average of squares over a pixel, with the distance of its corners as the unit.
const OF_SQUARES: f64 = 1.0 / 3.0;

/// The factor on the square of the turn of half vectors for its addition to their second derivatives, where
/// |l + v| changes with it.
const OF_LENGTH: f64 = 1.5;

/// The least cosine that a highlight's derivatives are divided by.
const LEAST_COSINE: f64 = 1e-3;

/// The share of the range on either side of 0 that clamping at 0 adds at most to the average of something linear: that
/// of a ramp along one axis.
const OF_CLAMPING: f64 = 0.25;

/// The moves of normals from that of the middle, alone or relative to half vectors.
#[derive(Clone, Copy, Debug)]
struct Moves<S: Simd> {
    /// To the corners, where they turn as fast as they do as a rule; and where they turn as fast as they may.
    reach: f64x8<S>,
    farthest: f64x8<S>,
    /// On average.
    bend: f64x8<S>,
}

impl<S: Simd> Filled<'_, S> {
    /// Whether one sample of bumps is worth a try.
    pub(super) fn is_worth_a_middle(&self) -> bool {
        self.tolerance >= LOOSE_ON_BUMPS && self.finish.is_rough()
    }

    /// An estimate of the error of the middle, from its cosines alone.
    ///
    /// # Accuracy
    /// Normals are taken to turn twice as fast as the root of the mean square over bumps says, and at least as fast as
    /// the sphere's, and their second derivatives to be as large. Terminators and the tops of highlights are looked for
    /// twice as far. What could fool it is a place where bumps bend more than that all over a pixel; pixels that are not
    /// small beside the bumps are not known, nor those near the silhouette.
    #[inline(always)]
    pub(super) fn of_middle(&self, simd: S, cosines: &LightCosines<S>) -> Estimate<S> {
        let zero = f64x8::splat(simd, 0.0);
        let usual = self.finish.usual_slope().max(1.0);
        let slope = (0.5 * usual).max(1.0);
        let cells = self.finish.shading_normal.cells();
        let turn = self.turn;
        let moves = Moves {
            reach: turn * slope,
            farthest: turn * usual,
            bend: (turn * cells + self.nearness) * turn * (slope * 0.5 * OF_SQUARES),
        };
        let mut error = zero;
        for (index, light) in self.scene.lights.iter().enumerate() {
            let lit = mask64x8::from_bitmask(simd, self.lit[index]);
            let cosine = cosines.lowest[index];
            let mut of_light = self.of_diffuse(simd, light, cosine, &moves);
            if self.finish.reflectance.highlight.is_some() {
                let half_cosine = cosines.halves.lowest[index];
                let beside = self.beside_half_vectors(simd, light, &moves);
                of_light += self.of_highlight(simd, light, [cosine, half_cosine], &moves, &beside);
            }
            let may_be_lit = cosine.simd_gt(-moves.farthest) & lit;
            error += may_be_lit.select(of_light, zero);
        }
        let is_known = self.is_within(SMALL) & self.nearness.simd_lt(MOST_NEARNESS);
        Estimate {
            error,
            is_known,
            is_met: is_known & error.simd_le(self.tolerance),
        }
    }

    /// The moves of normals from half vectors, which move with the view.
    #[inline(always)]
    fn beside_half_vectors(&self, simd: S, light: &Light, moves: &Moves<S>) -> Moves<S> {
        let aside = self.half_turn(simd, light);
        // 2 |n'| |h'| + |h''|, where |v''| is 2 |v'|² at most, and |l + v| changes with v.
        let bend = (moves.reach + self.view_turn) * 2.0 + aside * OF_LENGTH;
        Moves {
            reach: moves.reach + aside,
            farthest: moves.farthest + aside,
            bend: moves.bend + aside * bend * (0.5 * OF_SQUARES),
        }
    }

    /// The error for the diffuse light.
    #[inline(always)]
    fn of_diffuse(&self, simd: S, light: &Light, cosine: f64x8<S>, moves: &Moves<S>) -> f64x8<S> {
        let zero = f64x8::splat(simd, 0.0);
        let one = f64x8::splat(simd, 1.0);
        let tiny = f64x8::splat(simd, f64::MIN_POSITIVE);
        let reflectance = &self.finish.reflectance;
        let [brightest, _] = reflectance.brightest(light.intensity);
        let diffuse = &reflectance.diffuse;
        let exponent = diffuse.exponent;
        let (reach, bend) = (moves.reach, moves.bend);
        let lowest = (cosine - reach).max(tiny).min(one);
        let highest = (cosine + reach).max(tiny).min(one);
        // e cᵉ⁻¹ c'' + e (e − 1) cᵉ⁻² c'², where they are largest.
        let steepest = if exponent < 1.0 { lowest } else { highest };
        let slope = diffuse.of_clamped(steepest) / steepest * exponent;
        let of_square = reach * reach * ((exponent - 1.0).abs() * 0.5 * OF_SQUARES);
        let smooth = slope * (bend + of_square / lowest);
        let clamped = if exponent < 1.0 {
            diffuse.of_clamped(highest)
        } else {
            ((cosine + moves.farthest) * OF_CLAMPING + bend) * exponent
        };
        let is_cut = cosine.simd_lt(moves.farthest);
        is_cut.select(clamped.max(zero), smooth) * brightest
    }

    /// The error for the highlight, which ends where the surface turns from the light.
    #[inline(always)]
    fn of_highlight(
        &self,
        simd: S,
        light: &Light,
        [cosine, half_cosine]: [f64x8<S>; 2],
        moves: &Moves<S>,
        beside: &Moves<S>,
    ) -> f64x8<S> {
        let zero = f64x8::splat(simd, 0.0);
        let one = f64x8::splat(simd, 1.0);
        let [_, brightest] = self.finish.reflectance.brightest(light.intensity);
        let [_, shininess] = self.finish.reflectance.exponents();
        let nearest = highest_cosine(simd, half_cosine, beside.farthest);
        let most = self.finish.highlight_of(nearest);
        let reach_sq = beside.reach * beside.reach;
        let sine_sq = (one - half_cosine * half_cosine).max(zero) + reach_sq;
        let by_cosine = one / nearest.max(zero + LEAST_COSINE);
        let of_square = reach_sq * sine_sq * (shininess * shininess * 0.5 * OF_SQUARES);
        let smooth = (beside.bend * shininess + of_square * by_cosine) * by_cosine;
        let smooth = smooth.min(one);
        let is_cut = cosine.simd_lt(moves.farthest);
        most * is_cut.select(one, smooth) * brightest
    }
}
