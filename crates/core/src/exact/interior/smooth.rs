//! The light of pixels that one sphere fills, eight at a time.

use fearless_simd::prelude::*;
use fearless_simd::{f64x8, mask64x8};

use super::facings::{Extremes, Facings};
use super::parts::SIZE_OF_PARTS;
use super::samples::{
    FROM_GRID, FROM_STAR, GAUSS_SAMPLES, GRID, POINTS, SAMPLES, STAR_SAMPLES, Sample, WEIGHTS,
};
use crate::edges::cell::Ball;
use crate::exact::points::Points;
use crate::exact::scene::{InCamera, MOST_LIGHTS};
use crate::exact::surface::Finish;
use crate::model::color::Color;
use crate::model::roughness::noise::NoiseCells;
use crate::numeric::vectors::Vectors;

/// Light of eight pixels, and its error.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Smooth {
    pub(crate) values: [Color; 8],
    pub(crate) errors: [f64; 8],
    /// Which of the pixels are better divided, bit by bit.
    pub(crate) divisible: u64,
    /// How many samples each of the pixels took.
    pub(crate) samples: usize,
}

/// Pixels that one sphere fills.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Filled<'a, S: Simd> {
    pub(crate) ball: &'a Ball,
    pub(crate) finish: &'a Finish<'a>,
    /// The rays through the middles, and the pixels' sides on the retina at distance 1.
    pub(crate) middle: Vectors<S>,
    pub(crate) size: [f64; 2],
    /// Which of the pixels each light reaches, bit by bit.
    pub(crate) lit: &'a [u64; MOST_LIGHTS],
    /// How far normals turn from the middles to the corners, at most.
    pub(crate) turn: f64x8<S>,
    /// How fast light may change: the extent of the pixels over the distance to where it is not
    /// smooth.
    pub(crate) pace: f64x8<S>,
    /// The pixels that count, bit by bit, and the error that is allowed in them.
    pub(crate) which: u64,
    pub(crate) tolerance: f64,
}

/// The averages over pixels that one sphere fills: in calm ones by a rule with five points, elsewhere
/// by Gauss's with three points a side.
///
/// # Accuracy
/// An estimate. Where light is calm, how much it bends tells what to expect: the error of an
/// exponential function that bends so. Elsewhere Gauss's rule is held against Kronrod's along both
/// diagonals, which reach where an edge may be near. A rough surface has terminators inside its
/// bumps: what they may cost is estimated where it may avert itself from a light between samples
/// that face it, or face it between those that do not.
#[inline(always)]
pub(crate) fn smooth<S: Simd>(
    simd: S,
    scene: &InCamera<'_>,
    filled: &Filled<'_, S>,
    noise: &mut Option<Box<NoiseCells>>,
) -> Smooth {
    let zero = f64x8::splat(simd, 0.0);
    let mut facings = Facings::new(simd);
    let mut lights = [[zero; 3]; GAUSS_SAMPLES];
    // Along both diagonals: Kronrod's rule less Gauss's.
    let mut apart = [[zero; 3]; 2];
    let never = mask64x8::splat(simd, false);
    let mut grid = Calm {
        error: zero,
        is_known: never,
        settled: never,
    };
    // Where a terminator of bumps costs too much, whatever further samples tell.
    let mut hopeless = never;
    let star_lights = filled.light::<STAR_SAMPLES>(simd, scene, 0, &mut facings, noise);
    lights[..STAR_SAMPLES].copy_from_slice(&star_lights);
    let star = filled.calm(simd, scene, &lights, Stage::Star, &facings);
    if filled.finish.is_rough() {
        let missed = filled.missed(simd, scene, &facings, FROM_GRID);
        hopeless = !star.settled & missed.simd_gt(filled.tolerance);
    }
    let mut samples = STAR_SAMPLES;
    let settled = star.settled | hopeless;
    if filled.which & !settled.to_bitmask() != 0 {
        let rest = filled.light::<GRID_REST>(simd, scene, samples, &mut facings, noise);
        lights[STAR_SAMPLES..].copy_from_slice(&rest);
        grid = filled.calm(simd, scene, &lights, Stage::Grid, &facings);
        samples = GAUSS_SAMPLES;
        let settled = settled | grid.settled;
        if filled.which & !settled.to_bitmask() != 0 {
            for (light, sample) in lights.iter().zip(&POINTS) {
                add_apart(&mut apart, light, sample, scene.channels);
            }
            while samples < SAMPLES {
                let more = filled.light::<ON_DIAGONAL>(simd, scene, samples, &mut facings, noise);
                for (light, sample) in more.iter().zip(&POINTS[samples..]) {
                    add_apart(&mut apart, light, sample, scene.channels);
                }
                samples += ON_DIAGONAL;
            }
        }
    }
    let mut result = Smooth {
        values: [Color::ZERO; 8],
        errors: [0.0; 8],
        divisible: 0,
        samples,
    };
    let is_rough = filled.finish.is_rough();
    // A function of one coordinate is off by half of what both diagonals tell, and rows are not
    // quite alike, on bumps less than elsewhere.
    let caution = if is_rough { 2.0 } else { 0.75 };
    let mut error = zero;
    for channel in 0..scene.channels {
        let (mut by_star, mut by_grid) = (zero, zero);
        let mut highest = zero;
        for (light, sample) in lights.iter().zip(&POINTS) {
            by_star += light[channel] * sample.star;
            by_grid += light[channel] * sample.gauss;
            highest = highest.max(light[channel]);
        }
        let bend = bend_of_grid(&lights, channel);
        let relative = bend / (highest + f64::MIN_POSITIVE);
        let natural = bend * relative * relative * NATURAL;
        let difference = apart[0][channel].abs() + apart[1][channel].abs();
        // Where a number is not finite, the estimate tells.
        error = error.max(difference * caution + natural + by_grid.abs() * ROUNDING);
        let average = star.settled.select(by_star, by_grid);
        for (value, average) in result.values.iter_mut().zip(average.iter()) {
            value[channel] = *average;
        }
    }
    if is_rough {
        error += filled.missed(simd, scene, &facings, FROM_GRID);
    }
    error = hopeless.select(zero + f64::INFINITY, error);
    error = grid.settled.select(grid.error, error);
    error = star.settled.select(star.error, error);
    for lane in 0..8 {
        result.errors[lane] = error[lane];
    }
    if is_rough {
        result.divisible = filled.gains_by_parts(&star).to_bitmask();
    }
    result
}

/// Gauss's samples beside the star, and Kronrod's on each diagonal.
const GRID_REST: usize = GAUSS_SAMPLES - STAR_SAMPLES;
const ON_DIAGONAL: usize = (SAMPLES - GAUSS_SAMPLES) / 2;

/// Adds what a sample contributes to what Kronrod's rule finds more along both diagonals.
#[inline(always)]
fn add_apart<S: Simd>(
    apart: &mut [[f64x8<S>; 3]; 2],
    light: &[f64x8<S>; 3],
    sample: &Sample,
    channels: usize,
) {
    for channel in 0..channels {
        apart[0][channel] += light[channel] * sample.apart[0];
        apart[1][channel] += light[channel] * sample.apart[1];
    }
}

/// The error of an exponential function over the cube of its bend.
const NATURAL: f64 = 1.5e-4;

/// Half diagonals over cells of the noise, where five samples of a pixel are enough to know bumps by;
/// by more samples, or parts, larger ones are.
const SMALL: f64 = 0.25;

/// The pace at which light is no more calm.
const HURRIED: f64 = 0.25;

/// The relative error that rounding makes.
const ROUNDING: f64 = 1e-15;

/// How much light bends along both axes.
#[inline(always)]
fn bend_of_grid<S: Simd>(lights: &[[f64x8<S>; 3]; GAUSS_SAMPLES], channel: usize) -> f64x8<S> {
    let mut bend = lights[0][channel] * 0.0;
    for (index, weight) in WEIGHTS.into_iter().enumerate() {
        let col = [GRID[0][index], GRID[1][index], GRID[2][index]];
        for [before, middle, after] in [GRID[index], col] {
            let sides = lights[before][channel] + lights[after][channel];
            bend += (sides - lights[middle][channel] * 2.0).abs() * weight;
        }
    }
    bend
}

/// How much light bends along both diagonals.
#[inline(always)]
fn bend_of_star<S: Simd>(lights: &[[f64x8<S>; 3]; GAUSS_SAMPLES], channel: usize) -> f64x8<S> {
    let middle = lights[GRID[1][1]][channel] * 2.0;
    let falling = lights[GRID[0][0]][channel] + lights[GRID[2][2]][channel];
    let rising = lights[GRID[0][2]][channel] + lights[GRID[2][0]][channel];
    (falling - middle).abs() + (rising - middle).abs()
}

/// How many samples have been taken.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub(crate) enum Stage {
    Star,
    Grid,
}

/// The share of a bell exp(−x² / (2 σ²)) that rules are off by at most: 15 / σ⁶ over 7! · 400 for
/// each axis of Gauss's rule, and 3 / σ⁴ over 720 more for the star. For an exponent 1 / σ² is twice
/// that times the square of the turn from the middle to a corner.
#[inline(always)]
fn share_of_bell<S: Simd>(turn: f64x8<S>, exponent: f64, stage: Stage) -> f64x8<S> {
    const SIXTH: f64 = 1.5e-5;
    const FOURTH: f64 = 4.2e-3;
    /// Nothing bends so that second derivatives do not tell.
    const BLUNT: f64 = 2.0;
    let steep = turn
        * turn
        * if exponent > BLUNT {
            2.0 * exponent
        } else {
            0.0
        };
    let steep_sq = steep * steep;
    let sixth = steep_sq * steep * SIXTH;
    if stage == Stage::Star {
        sixth + steep_sq * FOURTH
    } else {
        sixth
    }
}

/// What is known of the error without Kronrod's samples.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Calm<S: Simd> {
    pub(crate) error: f64x8<S>,
    /// Where that can be said.
    pub(crate) is_known: mask64x8<S>,
    /// Where that is enough.
    settled: mask64x8<S>,
}

impl<S: Simd> Filled<'_, S> {
    /// The light at some samples of each pixel, from the one with the number `first`.
    #[inline(always)]
    pub(crate) fn light<const COUNT: usize>(
        &self,
        simd: S,
        scene: &InCamera<'_>,
        first: usize,
        facings: &mut Facings<S>,
        noise: &mut Option<Box<NoiseCells>>,
    ) -> [[f64x8<S>; 3]; COUNT] {
        let zero = f64x8::splat(simd, 0.0);
        let mut points = [Points::nowhere(simd); COUNT];
        for (points, sample) in points.iter_mut().zip(&POINTS[first..]) {
            let mut ray = self.middle;
            ray.x += sample.u * self.size[0];
            ray.y += sample.v * self.size[1];
            *points = Points::new(simd, self.ball, ray);
        }
        let normals = self.finish.normals(simd, scene, &points, noise);
        let mut lights = [[zero; 3]; COUNT];
        for index in 0..COUNT {
            let facings = self.finish.is_told().then_some(&mut *facings);
            let (points, normal) = (&points[index], &normals[index]);
            lights[index] = self
                .finish
                .radiance(simd, scene, points, normal, self.lit, facings);
        }
        lights
    }

    /// An estimate of the error by how much light bends, where it is calm.
    ///
    /// It is small where light is linear, and compares with how much light changes rather than with
    /// how much there is, so that a weak highlight on a bright surface counts. The star's rule is
    /// off by 1/720 of the mixed fourth derivative.
    #[inline(always)]
    pub(crate) fn calm(
        &self,
        simd: S,
        scene: &InCamera<'_>,
        lights: &[[f64x8<S>; 3]; GAUSS_SAMPLES],
        stage: Stage,
        facings: &Facings<S>,
    ) -> Calm<S> {
        /// What the fourth and the sixth derivative of a root contribute at a pace of 1.
        const OF_ROOT: [f64; 2] = [1.3e-3, 7.3e-6];
        /// The errors of exponential functions over the square of their bend and what they change
        /// by, and over the cube and the square, when they grow to e times as much in a pixel.
        /// Where they grow less, less is true.
        const OF_CHANGE: [f64; 2] = [1e-2, 1e-3];
        /// What a kink of the second derivative, where cells of the noise meet, costs at most.
        const OF_KINK: f64 = 0.1;
        let is_star = stage == Stage::Star;
        let zero = f64x8::splat(simd, 0.0);
        let is_rough = self.finish.is_rough();
        let pace_sq = self.pace * self.pace;
        let mut of_root = pace_sq * pace_sq * pace_sq * OF_ROOT[1];
        if is_star {
            of_root += pace_sq * pace_sq * OF_ROOT[0];
        }
        let samples = if is_star { STAR_SAMPLES } else { GAUSS_SAMPLES };
        let mut error = zero;
        for channel in 0..scene.channels {
            let (mut highest, mut lowest) = (lights[0][channel], lights[0][channel]);
            for light in &lights[..samples] {
                highest = highest.max(light[channel]);
                lowest = lowest.min(light[channel]);
            }
            let bend = if is_star {
                bend_of_star(lights, channel)
            } else {
                bend_of_grid(lights, channel)
            };
            let relative = bend / (highest - lowest + f64::MIN_POSITIVE);
            let mut estimate = relative * relative * OF_CHANGE[1];
            if is_star {
                estimate += relative * OF_CHANGE[0];
            }
            if is_rough {
                estimate += OF_KINK;
            }
            error = error.max(estimate * bend + highest * (of_root + ROUNDING));
        }
        if self.finish.is_told() {
            error = error.max(self.of_lobes(scene, stage, facings));
        }
        let mut is_known = self.pace.simd_lt(HURRIED);
        if is_rough {
            let from_samples = if is_star { FROM_STAR } else { FROM_GRID };
            error += self.missed(simd, scene, facings, from_samples);
            if is_star {
                is_known &= self.is_within(SMALL);
            }
        }
        let settled = is_known & error.simd_le(self.tolerance);
        Calm {
            error,
            is_known,
            settled,
        }
    }

    /// What rules do to bells exp(−κ) where normals turn through them, however the bend of light
    /// adds up: see [`share_of_bell`].
    #[inline(always)]
    fn of_lobes(&self, scene: &InCamera<'_>, stage: Stage, facings: &Facings<S>) -> f64x8<S> {
        let [exponent, shininess] = self.finish.exponents();
        let shares = [
            share_of_bell(self.turn, exponent, stage),
            share_of_bell(self.turn, shininess, stage),
        ];
        let mut sum = self.turn * 0.0;
        for (light, in_camera) in scene.lights.iter().enumerate() {
            if self.lit[light] != 0 {
                let (facing, spot) = (facings.highest(light), facings.spot(light));
                sum += self.finish.lobes(in_camera, facing, spot, shares);
            }
        }
        sum
    }

    /// Which pixels' half diagonals are less than some cells of the noise.
    #[inline(always)]
    fn is_within(&self, cells: f64) -> mask64x8<S> {
        (self.turn * self.finish.grain()).simd_lt(cells)
    }

    /// Which pixels' parts are small beside the bumps, and promise an error that is small enough.
    #[inline(always)]
    fn gains_by_parts(&self, star: &Calm<S>) -> mask64x8<S> {
        /// Errors of parts over the whole pixel's, at best.
        const GAIN: f64 = 0.1;
        self.is_within(SMALL / SIZE_OF_PARTS)
            & self.pace.simd_lt(HURRIED / SIZE_OF_PARTS)
            & (star.error * GAIN).simd_le(self.tolerance)
    }

    /// How a rough surface faces a light all over the pixels, how far that is in doubt when no point is
    /// farther from samples than `from_samples`, and what it changes by at most.
    ///
    /// By how fast its normals may turn; an estimate by the samples where a pixel is small beside its
    /// bumps.
    #[inline(always)]
    fn faces(
        &self,
        light: usize,
        facings: &Facings<S>,
        from_samples: f64,
    ) -> (Extremes<S>, f64x8<S>, f64x8<S>) {
        /// How far corners are off, and points at the sides, of what samples and corners differ by,
        /// and of what they bend by beyond what parabolas tell.
        const OF_RANGE: f64 = 0.4;
        const OF_BEND: f64 = 1.5;
        /// Of how far normals may turn, for each cell of the noise.
        const OF_TURN: f64 = 0.1;
        const CAUTION: f64 = 1.2;
        let slope = self.turn * self.finish.slope_bound();
        let (samples, corners) = (facings.of_samples(light), facings.with_corners(light));
        let cells = self.turn * self.finish.grain();
        let doubt = corners.range() * OF_RANGE + corners.bend * OF_BEND + slope * cells * OF_TURN;
        let range = corners.range() * CAUTION;
        let is_small = self.is_within(SMALL / SIZE_OF_PARTS);
        let extremes = Extremes {
            lowest: is_small.select(corners.lowest, samples.lowest),
            highest: is_small.select(corners.highest, samples.highest),
            bend: corners.bend,
        };
        let bound = slope * from_samples;
        (
            extremes,
            is_small.select(doubt * from_samples, bound).min(bound),
            is_small.select(range, slope * 2.0).min(slope * 2.0),
        )
    }

    /// What samples, from which no point is farther than `from_samples`, may miss where a rough
    /// surface faces a light here and averts itself from it there.
    #[inline(always)]
    fn missed(
        &self,
        simd: S,
        scene: &InCamera<'_>,
        facings: &Facings<S>,
        from_samples: f64,
    ) -> f64x8<S> {
        let zero = f64x8::splat(simd, 0.0);
        let mut missed = zero;
        let negligible = 0.01 * self.tolerance;
        let jumps = self
            .finish
            .jumps(simd, scene, &self.middle, self.size, negligible);
        for (light, lit) in self.lit.iter().enumerate().take(scene.lights.len()) {
            let (extremes, doubt, range) = self.faces(light, facings, from_samples);
            let undecided = extremes.undecided(doubt) & mask64x8::from_bitmask(simd, *lit);
            let spot = jumps.select(facings.spot(light), zero);
            let most = self.finish.cost_of_turning(scene, light, range, spot);
            missed += undecided.select(most, zero);
            if self.finish.has_blunt_spot() {
                /// As with the facing of lights.
                const OF_RANGE: f64 = 1.9;
                let (undecided, range) = facings.undecided_spot(light, OF_RANGE * from_samples);
                let undecided = undecided & mask64x8::from_bitmask(simd, *lit);
                let most = self.finish.cost_of_spot(scene, light, range * 1.5);
                missed += undecided.select(most, zero);
            }
        }
        missed
    }
}
