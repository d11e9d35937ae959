//! Pixels that one sphere fills, eight at a time.

use fearless_simd::prelude::*;
use fearless_simd::{f64x8, mask64x8};

use super::cut::MOST_LIGHTS;
use super::scene::InCamera;
use super::surface::{Facings, Finish, Points};
use crate::edges::{Ball, Vectors};
use crate::roughness::NoiseCells;
use crate::{Color, Radiance};

/// A sample of a pixel, at (u, v) from its middle.
#[derive(Clone, Copy, Debug)]
struct Sample {
    u: f64,
    v: f64,
    /// Weight in the average: Gauss's rule with three points a side.
    average: f64,
    /// Weights, along both diagonals, in what Kronrod's rule with seven points finds more than
    /// Gauss's.
    apart: [f64; 2],
    /// Weights in what tells how much light bends along both axes.
    bend: [f64; 2],
}

/// Samples that a pixel takes, at most.
const SAMPLES: usize = 17;

/// Samples of Gauss's rule.
const GAUSS_SAMPLES: usize = 9;

/// Its weights along one axis.
const WEIGHTS: [f64; 3] = [5.0 / 18.0, 4.0 / 9.0, 5.0 / 18.0];

/// Gauss's points, then the others of Kronrod's on both diagonals.
const POINTS: [Sample; SAMPLES] = {
    const OUTER: f64 = 0.387_298_334_620_741_7;
    const GAUSS: [f64; 3] = [-OUTER, 0.0, OUTER];
    /// Kronrod's weights of Gauss's points less theirs.
    const EXCESS: [f64; 3] = [
        0.134_244_044_934_166_84 - WEIGHTS[0],
        0.225_458_269_329_237_05 - WEIGHTS[1],
        0.134_244_044_934_166_84 - WEIGHTS[0],
    ];
    const OTHERS: [(f64, f64); 4] = [
        (-0.480_245_634_354_010_15, 0.052_328_113_013_233_65),
        (-0.217_121_874_673_401_3, 0.200_698_707_387_981_1),
        (0.217_121_874_673_401_3, 0.200_698_707_387_981_1),
        (0.480_245_634_354_010_15, 0.052_328_113_013_233_65),
    ];
    /// The second difference.
    const SECOND: [f64; 3] = [1.0, -2.0, 1.0];
    let mut points = [Sample {
        u: 0.0,
        v: 0.0,
        average: 0.0,
        apart: [0.0; 2],
        bend: [0.0; 2],
    }; SAMPLES];
    let mut index = 0;
    while index < GAUSS_SAMPLES {
        let (row, col) = (index / 3, index % 3);
        let (along, across) = (WEIGHTS[col], WEIGHTS[row]);
        points[index] = Sample {
            u: GAUSS[col],
            v: GAUSS[row],
            average: along * across,
            apart: [
                if row == col { EXCESS[col] } else { 0.0 },
                if row + col == 2 { EXCESS[col] } else { 0.0 },
            ],
            bend: [SECOND[col] * across, SECOND[row] * along],
        };
        index += 1;
    }
    let mut other = 0;
    while other < 4 {
        let (place, weight) = OTHERS[other];
        points[index].u = place;
        points[index].v = place;
        points[index].apart[0] = weight;
        points[index + 4].u = place;
        points[index + 4].v = -place;
        points[index + 4].apart[1] = weight;
        index += 1;
        other += 1;
    }
    points
};

/// How far a point of a pixel is from the nearest sample, in its half diagonals.
const FROM_SAMPLES: f64 = 0.4;

/// Light of eight pixels, and its error.
#[derive(Clone, Copy, Debug)]
pub(super) struct Smooth {
    pub(super) values: [Color; 8],
    pub(super) errors: [f64; 8],
    /// How many samples each of the pixels took.
    pub(super) samples: usize,
}

/// Pixels that one sphere fills.
#[derive(Clone, Copy, Debug)]
pub(super) struct Filled<'a, S: Simd> {
    pub(super) ball: &'a Ball,
    pub(super) finish: &'a Finish<'a>,
    /// The rays through the middles, and the pixels' side on the retina at distance 1.
    pub(super) middle: Vectors<S>,
    pub(super) size: f64,
    /// Which of the pixels each light reaches, bit by bit.
    pub(super) lit: &'a [u64; MOST_LIGHTS],
    /// How far normals turn from the middles to the corners, at most.
    pub(super) turn: f64x8<S>,
    /// How fast light may change: the extent of the pixels over the distance to where it is not
    /// smooth.
    pub(super) pace: f64x8<S>,
    /// The pixels that count, bit by bit, and the error that is allowed in them.
    pub(super) which: u64,
    pub(super) tolerance: f64,
}

/// The averages over pixels that one sphere fills, by Gauss's rule with three points a side.
///
/// # Accuracy
/// An estimate. Where light is calm, how much it bends tells what to expect: the error of an
/// exponential function that bends so. Elsewhere the rule is held against Kronrod's along both
/// diagonals, which reach where an edge may be near. A rough surface has terminators inside its
/// bumps: where it may avert itself between samples that face the light, or face it between those
/// that do not, what is missed is bounded by how fast its normals turn.
#[inline(always)]
pub(super) fn smooth<S: Simd, C: Radiance>(
    simd: S,
    scene: &InCamera<'_>,
    filled: &Filled<'_, S>,
    noise: &mut Option<Box<NoiseCells>>,
) -> Smooth {
    let zero = f64x8::splat(simd, 0.0);
    let is_rough = filled.finish.is_rough();
    let mut facings = Facings::new(simd);
    let mut lights = [[zero; 3]; GAUSS_SAMPLES];
    // Along both diagonals: Kronrod's rule less Gauss's.
    let mut apart = [[zero; 3]; 2];
    let mut calm = Calm {
        error: zero,
        settled: mask64x8::splat(simd, false),
    };
    let mut samples = SAMPLES;
    for (index, sample) in POINTS.iter().enumerate() {
        if index == GAUSS_SAMPLES {
            calm = filled.calm::<C>(simd, scene, &lights, &facings);
            if filled.which & !calm.settled.to_bitmask() == 0 {
                samples = GAUSS_SAMPLES;
                break;
            }
        }
        let light = filled.light::<C>(simd, scene, sample, &mut facings, noise);
        if let Some(lights) = lights.get_mut(index) {
            *lights = light;
        }
        for channel in 0..C::CHANNELS {
            apart[0][channel] += light[channel] * sample.apart[0];
            apart[1][channel] += light[channel] * sample.apart[1];
        }
    }
    let mut result = Smooth {
        values: [Color::ZERO; 8],
        errors: [0.0; 8],
        samples,
    };
    // A function of one coordinate is off by half of what both diagonals tell, and rows are not
    // quite alike, on bumps less than elsewhere.
    let caution = if is_rough { 2.0 } else { 0.75 };
    let mut error = zero;
    for channel in 0..C::CHANNELS {
        let mut average = zero;
        let mut bend = [zero; 2];
        let mut highest = zero;
        for (light, sample) in lights.iter().zip(&POINTS) {
            average += light[channel] * sample.average;
            bend[0] += light[channel] * sample.bend[0];
            bend[1] += light[channel] * sample.bend[1];
            highest = highest.max(light[channel]);
        }
        let bend = bend[0].abs() + bend[1].abs();
        let relative = bend / (highest + f64::MIN_POSITIVE);
        let natural = bend * relative * relative * NATURAL;
        let difference = apart[0][channel].abs() + apart[1][channel].abs();
        // Where a number is not finite, the estimate tells.
        error = error.max(difference * caution + natural + average.abs() * ROUNDING);
        for (value, average) in result.values.iter_mut().zip(average.iter()) {
            value[channel] = *average;
        }
    }
    if is_rough {
        error += filled.missed(simd, scene, &facings);
    }
    let error = calm.settled.select(calm.error, error);
    for lane in 0..8 {
        result.errors[lane] = error[lane];
    }
    result
}

/// The error of an exponential function over the cube of its bend.
const NATURAL: f64 = 1.5e-4;

/// The relative error that rounding makes.
const ROUNDING: f64 = 1e-15;

/// What is known of the error by Gauss's samples alone.
#[derive(Clone, Copy, Debug)]
struct Calm<S: Simd> {
    error: f64x8<S>,
    /// Where that is enough.
    settled: mask64x8<S>,
}

impl<S: Simd> Filled<'_, S> {
    /// The light at a sample of each pixel.
    #[inline(always)]
    fn light<C: Radiance>(
        &self,
        simd: S,
        scene: &InCamera<'_>,
        sample: &Sample,
        facings: &mut Facings<S>,
        noise: &mut Option<Box<NoiseCells>>,
    ) -> [f64x8<S>; 3] {
        let mut ray = self.middle;
        ray.x += sample.u * self.size;
        ray.y += sample.v * self.size;
        let points = Points::new(simd, self.ball, ray);
        let facings = self.finish.is_rough().then_some(facings);
        self.finish
            .radiance::<S, C>(simd, scene, &points, self.lit, noise, facings)
    }

    /// An estimate of the error by how much light bends, where it is calm.
    ///
    /// It is small where light is linear, and compared with how much light changes rather than with
    /// how much there is, so that a weak highlight on a bright surface counts.
    #[inline(always)]
    fn calm<C: Radiance>(
        &self,
        simd: S,
        scene: &InCamera<'_>,
        lights: &[[f64x8<S>; 3]; GAUSS_SAMPLES],
        facings: &Facings<S>,
    ) -> Calm<S> {
        /// The pace at which light is no more calm.
        const HURRIED: f64 = 0.25;
        /// What the sixth derivative of a root contributes at a pace of 1.
        const OF_ROOT: f64 = 7.3e-6;
        /// The error of an exponential function over the cube of its bend and the square of what it
        /// changes by, when it turns to e times as much in a pixel; less where it changes less.
        const OF_CHANGE: f64 = 1e-3;
        /// What a kink of the second derivative, where cells of the noise meet, costs at most.
        const OF_KINK: f64 = 0.1;
        let zero = f64x8::splat(simd, 0.0);
        let is_rough = self.finish.is_rough();
        let pace_sq = self.pace * self.pace;
        let root = pace_sq * pace_sq * pace_sq * OF_ROOT;
        let mut error = zero;
        for channel in 0..C::CHANNELS {
            let (mut highest, mut lowest) = (lights[0][channel], lights[0][channel]);
            let mut bend = zero;
            for light in lights {
                highest = highest.max(light[channel]);
                lowest = lowest.min(light[channel]);
            }
            for (index, weight) in WEIGHTS.into_iter().enumerate() {
                let row = [3 * index, 3 * index + 1, 3 * index + 2];
                let col = [index, index + 3, index + 6];
                for [before, middle, after] in [row, col] {
                    let sides = lights[before][channel] + lights[after][channel];
                    bend += (sides - lights[middle][channel] * 2.0).abs() * weight;
                }
            }
            let relative = bend / (highest - lowest + f64::MIN_POSITIVE);
            let mut estimate = bend * relative * relative * OF_CHANGE + highest * (root + ROUNDING);
            if is_rough {
                estimate += bend * OF_KINK;
            }
            error = error.max(estimate);
        }
        let mut settled = self.pace.simd_lt(HURRIED);
        if is_rough {
            error += self.missed(simd, scene, facings);
            if !self.finish.has_whole_exponent() {
                for (light, lit) in self.lit.iter().enumerate().take(scene.lights.len()) {
                    let reach = self.changes(light, facings)[1] * (1.0 / HURRIED);
                    let lit = mask64x8::from_bitmask(simd, *lit);
                    settled &= !(facings.undecided(light, reach) & lit);
                }
            }
        }
        settled &= error.simd_le(self.tolerance);
        Calm { error, settled }
    }

    /// How much a rough surface's facing of a light changes from the nearest sample, and over all of
    /// a pixel, at most: as much as its normals may turn; an estimate by its change from sample to
    /// sample where a pixel is small beside its bumps.
    #[inline(always)]
    fn changes(&self, light: usize, facings: &Facings<S>) -> [f64x8<S>; 2] {
        /// Pixels over cells of the noise that are small.
        const SMALL: f64 = 0.25;
        const OF_RANGE: [f64; 2] = [0.75, 1.5];
        let bound = self.turn * self.finish.slope_bound();
        let range = facings.range(light);
        let is_small = (self.turn * self.finish.grain()).simd_lt(SMALL);
        let least =
            |bound: f64x8<S>, of_range: f64| is_small.select(bound.min(range * of_range), bound);
        [
            least(bound * FROM_SAMPLES, OF_RANGE[0]),
            least(bound * 2.0, OF_RANGE[1]),
        ]
    }

    /// What samples may miss where a rough surface faces a light here and averts itself from it
    /// there.
    #[inline(always)]
    fn missed(&self, simd: S, scene: &InCamera<'_>, facings: &Facings<S>) -> f64x8<S> {
        let zero = f64x8::splat(simd, 0.0);
        let mut missed = zero;
        for (light, lit) in self.lit.iter().enumerate().take(scene.lights.len()) {
            let [reach, range] = self.changes(light, facings);
            let undecided = facings.undecided(light, reach) & mask64x8::from_bitmask(simd, *lit);
            let most = self
                .finish
                .cost_of_turning(scene, light, range, facings.spot(light));
            missed += undecided.select(most, zero);
        }
        missed
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Gauss's rule is exact to degree 5, Kronrod's to degree 11.
    #[test]
    fn rules_are_exact_for_polynomials() {
        let sum = |of: &dyn Fn(&Sample) -> f64| POINTS.iter().map(of).sum::<f64>();
        for power in (0..=11).step_by(2) {
            let exact = 0.5_f64.powi(power) / f64::from(power + 1);
            let gauss = sum(&|at| at.average * at.u.powi(power));
            for axis in 0..2 {
                let apart = sum(&|at| at.apart[axis] * at.u.powi(power));
                assert!(
                    (gauss + apart - exact).abs() < 1e-15 * exact.max(0.1),
                    "{power}"
                );
                assert_eq!(
                    apart.abs() < 1e-15 * exact.max(0.1),
                    power <= 4,
                    "{power}: {apart}"
                );
            }
        }
        let mixed = sum(&|at| at.average * at.u.powi(4) * at.v.powi(4));
        assert!((mixed - (0.5_f64.powi(4) / 5.0).powi(2)).abs() < 1e-16);
    }

    /// What bends is seen, what does not is not.
    #[test]
    fn second_differences_tell_how_light_bends() {
        let bend = |axis: usize, of: &dyn Fn(&Sample) -> f64| {
            POINTS.iter().map(|at| at.bend[axis] * of(at)).sum::<f64>()
        };
        for axis in 0..2 {
            assert!(bend(axis, &|at| 3.0 + at.u - 2.0 * at.v).abs() < 1e-15);
            let squares = [bend(axis, &|at| at.u * at.u), bend(axis, &|at| at.v * at.v)];
            assert!(squares[axis] > 0.2 && squares[1 - axis].abs() < 1e-15);
        }
    }

    #[test]
    fn no_point_is_far_from_the_samples() {
        let grid = |index: u32| f64::from(index) / 200.0 - 0.5;
        let mut farthest: f64 = 0.0;
        for (x, y) in (0..=200).flat_map(|row| (0..=200).map(move |col| (grid(col), grid(row)))) {
            let distances = POINTS[..GAUSS_SAMPLES]
                .iter()
                .map(|at| (x - at.u).hypot(y - at.v));
            farthest = farthest.max(distances.fold(f64::INFINITY, f64::min));
        }
        let half_diagonals = farthest / 0.5_f64.sqrt();
        assert!(
            (0.3..FROM_SAMPLES).contains(&half_diagonals),
            "{half_diagonals}"
        );
    }
}
