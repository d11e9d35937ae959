//! How the samples of pixels that one sphere fills face the lights.

use fearless_simd::prelude::*;
use fearless_simd::{f64x8, mask64x8};

use super::samples::{GRID, STAR_SAMPLES, TO_CORNER};
use crate::exact::scene::MOST_LIGHTS;

/// How a surface faces the lights.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Facings<S: Simd> {
    lowest: [f64x8<S>; MOST_LIGHTS],
    highest: [f64x8<S>; MOST_LIGHTS],
    /// At the samples of the star.
    star: [[f64x8<S>; STAR_SAMPLES]; MOST_LIGHTS],
    /// Powers of what highlights depend on, on either side of terminators.
    spots: [f64x8<S>; MOST_LIGHTS],
    /// How far half vectors are faced.
    spot_lowest: [f64x8<S>; MOST_LIGHTS],
    spot_highest: [f64x8<S>; MOST_LIGHTS],
    /// Samples so far.
    pub(crate) taken: usize,
}

/// How a surface faces a light all over a pixel, by its samples.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Extremes<S: Simd> {
    pub(crate) lowest: f64x8<S>,
    pub(crate) highest: f64x8<S>,
    /// How much it bends along both diagonals of the star.
    pub(crate) bend: f64x8<S>,
}

impl<S: Simd> Extremes<S> {
    #[inline(always)]
    pub(crate) fn range(&self) -> f64x8<S> {
        self.highest - self.lowest
    }

    /// Where the surface may face a light here and avert itself there, when the extremes are known to
    /// within `doubt`.
    #[inline(always)]
    pub(crate) fn undecided(&self, doubt: f64x8<S>) -> mask64x8<S> {
        self.lowest.simd_lt(doubt) & self.highest.simd_gt(-doubt)
    }
}

impl<S: Simd> Facings<S> {
    /// Of no samples yet.
    #[inline(always)]
    pub(crate) fn new(simd: S) -> Self {
        Self {
            lowest: [f64x8::splat(simd, f64::INFINITY); MOST_LIGHTS],
            highest: [f64x8::splat(simd, f64::NEG_INFINITY); MOST_LIGHTS],
            star: [[f64x8::splat(simd, 0.0); STAR_SAMPLES]; MOST_LIGHTS],
            spots: [f64x8::splat(simd, 0.0); MOST_LIGHTS],
            spot_lowest: [f64x8::splat(simd, f64::INFINITY); MOST_LIGHTS],
            spot_highest: [f64x8::splat(simd, f64::NEG_INFINITY); MOST_LIGHTS],
            taken: 0,
        }
    }

    /// Takes in how a sample faces a light.
    #[inline(always)]
    pub(crate) fn note(&mut self, light: usize, facing: f64x8<S>) {
        self.lowest[light] = self.lowest[light].min(facing);
        self.highest[light] = self.highest[light].max(facing);
        if self.taken < STAR_SAMPLES {
            self.star[light][self.taken] = facing;
        }
    }

    /// Takes in the power of a sample's highlight, and how its half vector is faced.
    #[inline(always)]
    pub(crate) fn note_spot(&mut self, light: usize, spot: f64x8<S>, half: f64x8<S>) {
        self.spots[light] = self.spots[light].max(spot);
        self.spot_lowest[light] = self.spot_lowest[light].min(half);
        self.spot_highest[light] = self.spot_highest[light].max(half);
    }

    /// How the samples face a light.
    #[inline(always)]
    pub(crate) fn of_samples(&self, light: usize) -> Extremes<S> {
        Extremes {
            lowest: self.lowest[light],
            highest: self.highest[light],
            bend: self.lowest[light] * 0.0,
        }
    }

    /// How the samples, and the corners by the parabolas through those on the diagonals, face a light.
    #[inline(always)]
    pub(crate) fn with_corners(&self, light: usize) -> Extremes<S> {
        let mut extremes = self.of_samples(light);
        let star = &self.star[light];
        let middle = star[GRID[1][1]];
        for [one, other] in [[GRID[0][0], GRID[2][2]], [GRID[0][2], GRID[2][0]]] {
            let bend = (star[one] - middle) + (star[other] - middle);
            let slope = (star[one] - star[other]) * (0.5 * TO_CORNER);
            let center = bend * (0.5 * TO_CORNER * TO_CORNER) + middle;
            let (first, last) = (center + slope, center - slope);
            extremes.lowest = extremes.lowest.min(first.min(last));
            extremes.highest = extremes.highest.max(first.max(last));
            extremes.bend += bend.abs();
        }
        extremes
    }

    /// Where half vectors may be faced here and averted there, and how far the points differ.
    #[inline(always)]
    pub(crate) fn undecided_spot(&self, light: usize, share: f64) -> (mask64x8<S>, f64x8<S>) {
        let (low, high) = (self.spot_lowest[light], self.spot_highest[light]);
        let range = high - low;
        let reach = range * share;
        (low.simd_lt(reach) & high.simd_gt(-reach), range)
    }

    /// How far the surface faces a light, at most.
    #[inline(always)]
    pub(crate) fn highest(&self, light: usize) -> f64x8<S> {
        self.highest[light]
    }

    /// How high a light's highlight is.
    #[inline(always)]
    pub(crate) fn spot(&self, light: usize) -> f64x8<S> {
        self.spots[light]
    }
}

#[cfg(test)]
mod tests {
    use fearless_simd::{Level, dispatch};

    use super::*;
    use crate::exact::interior::samples::POINTS;

    /// Parabolas along both diagonals are followed to the corners.
    #[test]
    fn corners_are_faced_as_parabolas_tell() {
        let facing = |u: f64, v: f64| 0.1 + 0.7 * u - 0.4 * v + 0.9 * u * u + 0.3 * u * v;
        let [lowest, highest] = dispatch!(Level::new(), simd => {
            let mut facings = Facings::new(simd);
            for sample in &POINTS[..STAR_SAMPLES] {
                facings.note(0, f64x8::splat(simd, facing(sample.u, sample.v)));
                facings.taken += 1;
            }
            let extremes = facings.with_corners(0);
            [extremes.lowest[3], extremes.highest[5]]
        });
        let corners = [(-0.5, -0.5), (-0.5, 0.5), (0.5, -0.5), (0.5, 0.5)];
        let corners = corners.map(|(u, v)| facing(u, v));
        let above = corners.into_iter().fold(f64::NEG_INFINITY, f64::max);
        let below = corners.into_iter().fold(facing(0.0, 0.0), f64::min);
        assert!(
            (highest - above).abs() < 1e-15,
            "{highest} instead of {above}"
        );
        assert!(
            (lowest - below).abs() < 1e-15,
            "{lowest} instead of {below}"
        );
    }
}
