//! The cosines of the angles between shading normals and lights, at the samples of pixels that one
//! sphere fills.

use fearless_simd::Simd;

use super::samples::{GRID, STAR_SAMPLES, TO_CORNER};
use crate::exact::scene::{Light, MOST_LIGHTS};
use crate::exact::surface::HalfCosines;
use crate::numeric::lanes::{f64x8, mask64x8};
use crate::numeric::vectors::Vectors;

/// The cosines n · l and n · h of the samples so far, of each light.
#[derive(Clone, Copy, Debug)]
pub(crate) struct LightCosines<S: Simd> {
    pub(super) lowest: [f64x8<S>; MOST_LIGHTS],
    pub(super) highest: [f64x8<S>; MOST_LIGHTS],
    /// At the samples of the star; NaN where they are not taken yet.
    star: [[f64x8<S>; STAR_SAMPLES]; MOST_LIGHTS],
    pub(super) halves: HalfCosines<S>,
    /// The number of samples so far.
    taken: usize,
}

/// The cosines of one light all over a pixel, by its samples.
#[derive(Clone, Copy, Debug)]
pub(crate) struct CosineRange<S: Simd> {
    pub(crate) lowest: f64x8<S>,
    pub(crate) highest: f64x8<S>,
    /// The sum of second differences along both diagonals of the star.
    pub(crate) bend: f64x8<S>,
}

impl<S: Simd> CosineRange<S> {
    #[inline(always)]
    pub(crate) fn width(&self) -> f64x8<S> {
        self.highest - self.lowest
    }

    /// The pixels in which the cosine may be positive here and negative there, when the range is known to within
    /// `doubt`.
    #[inline(always)]
    pub(crate) fn may_change_sign(&self, doubt: f64x8<S>) -> mask64x8<S> {
        self.lowest.simd_lt(doubt) & self.highest.simd_gt(-doubt)
    }
}

impl<S: Simd> LightCosines<S> {
    /// The cosines of no samples yet.
    #[inline(always)]
    pub(crate) fn new(simd: S) -> Self {
        Self {
            lowest: [f64x8::splat(simd, f64::INFINITY); MOST_LIGHTS],
            highest: [f64x8::splat(simd, f64::NEG_INFINITY); MOST_LIGHTS],
            star: [[f64x8::splat(simd, f64::NAN); STAR_SAMPLES]; MOST_LIGHTS],
            halves: HalfCosines::new(simd),
            taken: 0,
        }
    }

    /// Takes in a sample with these shading normals.
    #[inline(always)]
    pub(crate) fn add_sample(&mut self, lights: &[Light], normal: &Vectors<S>) {
        for (index, light) in lights.iter().enumerate() {
            self.add(index, normal.dot_one(light.toward));
        }
        self.taken += 1;
    }

    /// Takes in a sample's cosine.
    #[inline(always)]
    fn add(&mut self, light: usize, cosine: f64x8<S>) {
        self.lowest[light] = self.lowest[light].min(cosine);
        self.highest[light] = self.highest[light].max(cosine);
        if self.taken < STAR_SAMPLES {
            self.star[light][self.taken] = cosine;
        }
    }

    /// The range of the samples.
    #[inline(always)]
    pub(crate) fn of_samples(&self, light: usize) -> CosineRange<S> {
        CosineRange {
            lowest: self.lowest[light],
            highest: self.highest[light],
            bend: self.lowest[light] * 0.0,
        }
    }

    /// The range of the samples, and of the corners by the parabolas through the samples on the diagonals.
    #[inline(always)]
    pub(crate) fn with_corners(&self, light: usize) -> CosineRange<S> {
        let mut range = self.of_samples(light);
        let star = &self.star[light];
        let middle = star[GRID[1][1]];
        for [one, other] in [[GRID[0][0], GRID[2][2]], [GRID[0][2], GRID[2][0]]] {
            let bend = (star[one] - middle) + (star[other] - middle);
            let slope = (star[one] - star[other]) * (0.5 * TO_CORNER);
            let center = bend * (0.5 * TO_CORNER * TO_CORNER) + middle;
            let (first, last) = (center + slope, center - slope);
            range.lowest = range.lowest.min(first.min(last));
            range.highest = range.highest.max(first.max(last));
            range.bend += bend.abs();
        }
        range
    }

    /// The range of n · h.
    #[inline(always)]
    pub(crate) fn half_range(&self, light: usize) -> CosineRange<S> {
        CosineRange {
            lowest: self.halves.lowest[light],
            highest: self.halves.highest[light],
            bend: self.halves.lowest[light] * 0.0,
        }
    }
}

#[cfg(test)]
mod tests;
