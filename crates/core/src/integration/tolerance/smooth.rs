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

/// Samples that a pixel takes.
pub(super) const SAMPLES: usize = 17;

/// Gauss's points, then the others of Kronrod's on both diagonals.
const POINTS: [Sample; SAMPLES] = {
    const OUTER: f64 = 0.387_298_334_620_741_7;
    const GAUSS: [(f64, f64); 3] = [(-OUTER, 5.0 / 18.0), (0.0, 4.0 / 9.0), (OUTER, 5.0 / 18.0)];
    /// Kronrod's weights of Gauss's points less theirs.
    const EXCESS: [f64; 3] = [
        0.134_244_044_934_166_84 - 5.0 / 18.0,
        0.225_458_269_329_237_05 - 4.0 / 9.0,
        0.134_244_044_934_166_84 - 5.0 / 18.0,
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
    while index < 9 {
        let (row, col) = (index / 3, index % 3);
        let ((u, along), (v, across)) = (GAUSS[col], GAUSS[row]);
        points[index] = Sample {
            u,
            v,
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
}

/// The averages over pixels that one sphere fills, by Gauss's rule with three points a side.
///
/// # Accuracy
/// An estimate: along both diagonals, which reach where an edge may be near, the rule is held
/// against Kronrod's. Should the two agree by accident, how much light bends tells what to expect:
/// the error of an exponential function that bends so. A rough surface has terminators inside its bumps: where it may avert
/// itself between samples that face the light, or face it between those that do not, what is missed
/// is bounded by how fast its normals turn.
#[inline(always)]
pub(super) fn smooth<S: Simd, C: Radiance>(
    simd: S,
    scene: &InCamera<'_>,
    filled: &Filled<'_, S>,
    noise: &mut Option<Box<NoiseCells>>,
) -> Smooth {
    let zero = f64x8::splat(simd, 0.0);
    let mut facings = Facings::new(simd);
    let mut average = [zero; 3];
    // Along both diagonals: Kronrod's rule less Gauss's. Along both axes: how much the light bends.
    let mut apart = [[zero; 3]; 2];
    let mut bend = [[zero; 3]; 2];
    let mut highest = zero;
    for sample in &POINTS {
        let light = filled.light::<C>(simd, scene, sample, &mut facings, noise);
        for channel in 0..C::CHANNELS {
            let light = light[channel];
            highest = highest.max(light);
            average[channel] += light * sample.average;
            for axis in 0..2 {
                apart[axis][channel] += light * sample.apart[axis];
                bend[axis][channel] += light * sample.bend[axis];
            }
        }
    }
    let mut error = zero;
    let mut result = Smooth {
        values: [Color::ZERO; 8],
        errors: [0.0; 8],
    };
    // A function of one coordinate is off by half of what both diagonals tell, and rows are not
    // quite alike, on bumps less than elsewhere.
    let caution = if filled.finish.is_rough() { 2.0 } else { 0.75 };
    for channel in 0..C::CHANNELS {
        /// The error of an exponential function over the cube of its bend.
        const NATURAL: f64 = 1.5e-4;
        let bend = bend[0][channel].abs() + bend[1][channel].abs();
        let relative = bend / (highest + f64::MIN_POSITIVE);
        let natural = bend * relative * relative * NATURAL;
        let difference = apart[0][channel].abs() + apart[1][channel].abs();
        // Where a number is not finite, the estimate tells.
        error = error.max(difference * caution + natural + average[channel].abs() * 1e-15);
        for (value, average) in result.values.iter_mut().zip(average[channel].iter()) {
            value[channel] = *average;
        }
    }
    if filled.finish.is_rough() {
        error += filled.missed(simd, scene, &facings);
    }
    for lane in 0..8 {
        result.errors[lane] = error[lane];
    }
    result
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

    /// What samples may miss of the lights that a rough surface faces here and averts itself from
    /// there: a bound where no sample faces them, elsewhere an estimate, for twice the facing that is
    /// possible next to a terminator.
    #[inline(always)]
    fn missed(&self, simd: S, scene: &InCamera<'_>, facings: &Facings<S>) -> f64x8<S> {
        let zero = f64x8::splat(simd, 0.0);
        let reach = self.turn * (FROM_SAMPLES * self.finish.slope_bound());
        let mut missed = zero;
        for (light, lit) in self.lit.iter().enumerate().take(scene.lights.len()) {
            let undecided = facings.undecided(light, reach) & mask64x8::from_bitmask(simd, *lit);
            let facing = (facings.highest(light) + reach).min(reach * 2.0);
            let most = self.finish.brightest(scene, light, facing);
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
            let distances = POINTS.iter().map(|at| (x - at.u).hypot(y - at.v));
            farthest = farthest.max(distances.fold(f64::INFINITY, f64::min));
        }
        let half_diagonals = farthest / 0.5_f64.sqrt();
        assert!(
            (0.3..FROM_SAMPLES).contains(&half_diagonals),
            "{half_diagonals}"
        );
    }
}
