//! Terminators inside the bumps of rough surfaces, which samples may miss.

use fearless_simd::Simd;

use super::filled::{Filled, SIZE_OF_PARTS};
use super::light_cosines::{CosineRange, LightCosines};
use super::samples::Rule;
use crate::exact::context::NEGLIGIBLE;
use crate::numeric::lanes::{f64x8, mask64x8};

/// The half diagonal over a cell of the noise below which five samples of a pixel are enough to know bumps
/// by. By more samples, or in parts, larger pixels are known. It trades samples for false claims; not
/// tuned.
pub(super) const SMALL: f64 = 0.25;

/// The same for nine samples and more.
pub(super) const MEDIUM: f64 = SMALL / SIZE_OF_PARTS;

/// A light's cosines all over the pixels.
#[derive(Clone, Copy, Debug)]
struct Variation<S: Simd> {
    range: CosineRange<S>,
    /// The doubt in the ends of the range.
    doubt: f64x8<S>,
    /// A bound of the range's width.
    width: f64x8<S>,
}

impl<S: Simd> Filled<'_, S> {
    /// The pixels whose half diagonals are less than some cells of the noise.
    #[inline(always)]
    pub(super) fn is_within(&self, cells: f64) -> mask64x8<S> {
        (self.turn * self.finish.shading_normal.cells()).simd_lt(cells)
    }

    /// The light that the samples of a rule may miss where a rough surface faces a light here and averts itself from it
    /// there.
    #[inline(always)]
    pub(super) fn missed(&self, simd: S, rule: Rule, cosines: &LightCosines<S>) -> f64x8<S> {
        /// The doubt in n · h at its samples, over the range and the distance from samples, as
        /// [`Self::variation`] has it; and how much wider its range may be than that of the samples. Not
        /// tuned.
        const OF_HALF_RANGE: f64 = 1.9;
        const HALF_CAUTION: f64 = 1.5;
        let zero = f64x8::splat(simd, 0.0);
        let from_samples = rule.farthest();
        let scene = self.scene;
        let mut missed = zero;
        let negligible = NEGLIGIBLE * self.tolerance;
        let jumps = self
            .finish
            .jumps(simd, scene, &self.middle, self.size, negligible);
        for (index, light) in scene.lights.iter().enumerate() {
            let lit = mask64x8::from_bitmask(simd, self.lit[index]);
            let variation = self.variation(index, cosines, from_samples);
            let is_cut = variation.range.may_change_sign(variation.doubt) & lit;
            let highlight = jumps.select(cosines.halves.powers[index], zero);
            let most = self
                .finish
                .cost_of_turning(light, variation.width, highlight, rule);
            missed += is_cut.select(most, zero);
            if self.finish.has_blunt_highlight() {
                let range = cosines.half_range(index);
                let doubt = range.width() * (OF_HALF_RANGE * from_samples);
                let is_cut = range.may_change_sign(doubt) & lit;
                let width = range.width() * HALF_CAUTION;
                let most = self.finish.cost_of_highlight_end(light, width, rule);
                missed += is_cut.select(most, zero);
            }
        }
        missed
    }

    /// A light's cosines all over the pixels, when no point is farther from samples than `from_samples`
    /// half diagonals.
    ///
    /// By how fast the normals may turn; an estimate by the samples where a pixel is small beside its
    /// bumps.
    #[inline(always)]
    fn variation(
        &self,
        light: usize,
        cosines: &LightCosines<S>,
        from_samples: f64,
    ) -> Variation<S> {
        /// The error of corners, and of points at the sides, over the range of samples and corners, and
        /// over the bend of parabolas. Not tuned.
        const OF_RANGE: f64 = 0.4;
        const OF_BEND: f64 = 1.5;
        /// The error for each cell of the noise, over how far normals may turn. Not tuned.
        const OF_TURN: f64 = 0.1;
        /// The range of all points over that of samples and corners. Not tuned.
        const CAUTION: f64 = 1.2;
        let shading_normal = &self.finish.shading_normal;
        let slope = self.turn * shading_normal.slope_bound();
        let (samples, corners) = (cosines.of_samples(light), cosines.with_corners(light));
        let cells = self.turn * shading_normal.cells();
        let doubt = corners.width() * OF_RANGE + corners.bend * OF_BEND + slope * cells * OF_TURN;
        let width = corners.width() * CAUTION;
        let is_small = self.is_within(MEDIUM);
        let bound = slope * from_samples;
        Variation {
            range: CosineRange {
                lowest: is_small.select(corners.lowest, samples.lowest),
                highest: is_small.select(corners.highest, samples.highest),
                bend: corners.bend,
            },
            doubt: is_small.select(doubt * from_samples, bound).min(bound),
            width: is_small.select(width, slope * 2.0).min(slope * 2.0),
        }
    }
}
