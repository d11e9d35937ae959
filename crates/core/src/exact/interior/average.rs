//! The averages over eight pixels that one sphere fills, by 1, 5, 9 or 17 samples.

use fearless_simd::Simd;

use super::estimate::{Estimate, ROUNDING, apart_on_bumps, bend_of_grid};
use super::filled::{Filled, Radiance};
use super::light_cosines::LightCosines;
use super::remainder::Rules;
use super::samples::{GAUSS_SAMPLES, POINTS, Rule, SAMPLES, STAR_SAMPLES, Sample};
use super::terminators::MEDIUM;
use crate::exact::points::Points;
use crate::model::color::Color;
use crate::model::roughness::noise::NoiseCells;
use crate::numeric::bits::set_bits;
use crate::numeric::lanes::{f64x8, mask64x8};

/// The averages over eight pixels, and their errors.
#[derive(Clone, Copy, Debug)]
pub(super) struct Averages {
    pub(super) values: [Color; 8],
    pub(super) errors: [f64; 8],
    /// Bounds of the errors; infinite where there is none.
    pub(super) bounds: [f64; 8],
    /// The number of samples that each of the pixels took.
    pub(super) samples: usize,
}

/// Samples of eight pixels, and what their rules claim.
struct Sampled<S: Simd> {
    lights: [Radiance<S>; GAUSS_SAMPLES],
    /// Only if the surface needs them.
    cosines: Option<LightCosines<S>>,
    /// The estimates of one sample of bumps, of five and of nine.
    middle: Estimate<S>,
    star: Estimate<S>,
    grid: Estimate<S>,
    /// Along both diagonals, Kronrod's rule less Gauss's.
    excess: [Radiance<S>; 2],
    /// The pixels in which a terminator of bumps costs too much, whatever further samples tell.
    is_out_of_reach: mask64x8<S>,
    samples: usize,
}

/// Tolerances from which on one sample may suffice: at lower ones hardly any pixel is smooth enough.
const LOOSE: f64 = 2.5e-5;

/// Kronrod's samples on each diagonal.
const ON_DIAGONAL: usize = (SAMPLES - GAUSS_SAMPLES) / 2;

impl<S: Simd> Sampled<S> {
    #[inline(always)]
    fn new(simd: S, needs_cosines: bool) -> Self {
        let zero = f64x8::splat(simd, 0.0);
        Self {
            lights: [[zero; 3]; GAUSS_SAMPLES],
            cosines: if needs_cosines {
                Some(LightCosines::new(simd))
            } else {
                None
            },
            middle: Estimate::unknown(simd),
            star: Estimate::unknown(simd),
            grid: Estimate::unknown(simd),
            excess: [[zero; 3]; 2],
            is_out_of_reach: mask64x8::splat(simd, false),
            samples: 0,
        }
    }
}

impl<S: Simd> Filled<'_, S> {
    /// The averages: by one sample where a bound, or an estimate on bumps, tells that it suffices; where light is smooth
    /// by a rule with five points, elsewhere by Gauss's with three points a side.
    ///
    /// # Accuracy
    /// A bound where there is one, and else an estimate. Where light is smooth, how much it bends tells what to expect:
    /// the error of an exponential function that bends so. Elsewhere Gauss's rule is held against Kronrod's along both
    /// diagonals, which reach where an edge may be near. A rough surface has terminators inside its bumps: what they may
    /// cost is estimated where it may avert itself from a light between samples that face it, or face it between those
    /// that do not.
    #[inline(never)]
    pub(super) fn averages(&self, simd: S, noise: &mut Option<Box<NoiseCells>>) -> Averages {
        simd.vectorize(
            #[inline(always)]
            || self.averages_of(simd, noise),
        )
    }

    #[inline(always)]
    fn averages_of(&self, simd: S, noise: &mut Option<Box<NoiseCells>>) -> Averages {
        let (mut domain, mut in_middle) = (None, None);
        if !self.finish.is_rough() && self.is_proved {
            let of_pixels = self.domain(simd);
            // What is smooth enough for one sample is known before any is taken.
            if self.tolerance >= LOOSE {
                let bounds = self.bound(simd, &of_pixels, Rules::Middle);
                let met = bounds.simd_le(self.tolerance).to_bitmask();
                if self.which & !met == 0 {
                    return self.by_middle(simd, bounds);
                }
                in_middle = Some((bounds, met));
            }
            domain = Some(of_pixels);
        }
        // In place: it takes several kilobytes.
        let mut sampled = Sampled::new(simd, self.finish.needs_cosines());
        self.sample(simd, &mut sampled, noise);
        let mut averages = Averages {
            values: [Color::ZERO; 8],
            errors: [0.0; 8],
            bounds: [f64::INFINITY; 8],
            samples: sampled.samples,
        };
        let is_star_enough = self.which & !sampled.star.is_met.to_bitmask() == 0;
        let error = if sampled.samples == 1 {
            sampled.middle.error
        } else if is_star_enough {
            self.by_star(simd, &sampled, &mut averages.values)
        } else {
            self.weighted(simd, &sampled, &mut averages.values)
        };
        for (lane, of_lane) in averages.errors.iter_mut().enumerate() {
            *of_lane = error[lane];
        }
        if let Some(domain) = &domain {
            let rules = Rules::StarOrGrid(sampled.star.is_met);
            averages.bounds = self.bound(simd, domain, rules).into();
        }
        for lane in set_bits(sampled.middle.is_met.to_bitmask()) {
            for channel in 0..self.scene.channels {
                averages.values[lane][channel] = sampled.lights[0][channel][lane];
            }
            averages.errors[lane] = sampled.middle.error[lane];
        }
        if let Some((bounds, met)) = in_middle {
            // A pixel does not depend on those beside it: the first sample is the middle's.
            for lane in set_bits(met) {
                for channel in 0..self.scene.channels {
                    averages.values[lane][channel] = sampled.lights[0][channel][lane];
                }
                averages.errors[lane] = bounds[lane];
                averages.bounds[lane] = bounds[lane];
            }
        }
        averages
    }

    /// The averages by one sample in the middle, with these bounds of their errors.
    #[inline(always)]
    fn by_middle(&self, simd: S, bounds: f64x8<S>) -> Averages {
        let points = Points::new(simd, self.ball, self.middle);
        let (scene, finish) = (self.scene, self.finish);
        let light = finish.radiance(simd, scene, &points, &points.normal, self.lit, None);
        let mut values = [Color::ZERO; 8];
        for (channel, light) in light.iter().enumerate().take(scene.channels) {
            for (value, light) in values.iter_mut().zip(light.iter()) {
                value[channel] = *light;
            }
        }
        Averages {
            values,
            errors: bounds.into(),
            bounds: bounds.into(),
            samples: 1,
        }
    }

    /// Takes samples, until a rule is good enough or all are taken.
    #[inline(always)]
    fn sample(&self, simd: S, into: &mut Sampled<S>, noise: &mut Option<Box<NoiseCells>>) {
        let Sampled {
            lights, cosines, ..
        } = into;

        // Samples that are far apart beside bumps tell nothing of what lies between them.
        let is_seen = self.is_within(MEDIUM);
        if self.finish.is_rough() && self.which & is_seen.to_bitmask() == 0 {
            into.is_out_of_reach = !is_seen;
            return;
        }

        // One sample.
        if self.is_worth_a_middle() {
            self.light(simd, 0, cosines, noise, &mut lights[..1]);
            into.samples = 1;
            if let Some(cosines) = &*cosines {
                into.middle = self.of_middle(simd, cosines);
            }
            if self.which & !into.middle.is_met.to_bitmask() == 0 {
                return;
            }
        }

        // Five samples.
        let rest = &mut lights[into.samples..STAR_SAMPLES];
        self.light(simd, into.samples, cosines, noise, rest);
        let kinks = match self.finish.is_rough() {
            true => self.kinks(simd, noise),
            false => None,
        };
        let kinks = kinks.as_ref();
        into.star = self.estimate(simd, Rule::Star, lights, cosines.as_ref(), kinks);
        into.samples = STAR_SAMPLES;
        if self.finish.is_rough()
            && let Some(cosines) = &*cosines
        {
            let missed = self.missed(simd, Rule::Grid, cosines);
            into.is_out_of_reach = !into.star.is_met & missed.simd_gt(self.tolerance);
            into.is_out_of_reach |= !is_seen;
        }
        let is_done = into.star.is_met | into.is_out_of_reach;
        if self.which & !is_done.to_bitmask() == 0 {
            return;
        }

        // Nine.
        let rest = &mut lights[STAR_SAMPLES..];
        self.light(simd, into.samples, cosines, noise, rest);
        into.grid = self.estimate(simd, Rule::Grid, lights, cosines.as_ref(), kinks);
        into.samples = GAUSS_SAMPLES;
        let is_done = is_done | into.grid.is_met;
        if self.which & !is_done.to_bitmask() == 0 {
            return;
        }

        // Seventeen.
        let channels = self.scene.channels;
        for (light, sample) in lights.iter().zip(&POINTS) {
            add_excess(&mut into.excess, light, sample, channels);
        }
        let mut more = [[f64x8::splat(simd, 0.0); 3]; ON_DIAGONAL];
        while into.samples < SAMPLES {
            self.light(simd, into.samples, cosines, noise, &mut more);
            for (light, sample) in more.iter().zip(&POINTS[into.samples..]) {
                add_excess(&mut into.excess, light, sample, channels);
            }
            into.samples += ON_DIAGONAL;
        }
    }

    /// Writes the averages by five samples; their errors.
    #[inline(always)]
    fn by_star(&self, simd: S, sampled: &Sampled<S>, values: &mut [Color; 8]) -> f64x8<S> {
        for channel in 0..self.scene.channels {
            let mut average = f64x8::splat(simd, 0.0);
            for (light, sample) in sampled.lights.iter().zip(&POINTS[..STAR_SAMPLES]) {
                average += light[channel] * sample.star;
            }
            for (value, average) in values.iter_mut().zip(average.iter()) {
                value[channel] = *average;
            }
        }
        sampled.star.error
    }

    /// Writes the averages by the cheapest rule that is good enough; their errors.
    #[inline(always)]
    fn weighted(&self, simd: S, sampled: &Sampled<S>, values: &mut [Color; 8]) -> f64x8<S> {
        /// The error of an exponential function over the cube of its bend.
        const NATURAL: f64 = 1.5e-4;
        /// The error over what both diagonals tell: a function of one coordinate is off by half of that,
        /// and rows are not quite alike, on bumps less than elsewhere. Through a wide lens 0.98 was found.
        const CAUTION: f64 = 1.5;
        const CAUTION_ON_BUMPS: f64 = 2.0;
        let zero = f64x8::splat(simd, 0.0);
        let is_rough = self.finish.is_rough();
        let caution = if is_rough { CAUTION_ON_BUMPS } else { CAUTION };
        let (star, grid) = (&sampled.star, &sampled.grid);
        let mut error = zero;
        for channel in 0..self.scene.channels {
            let (mut by_star, mut by_grid) = (zero, zero);
            let mut highest = zero;
            for (light, sample) in sampled.lights.iter().zip(&POINTS) {
                by_star += light[channel] * sample.star;
                by_grid += light[channel] * sample.gauss;
                highest = highest.max(light[channel]);
            }
            let bend = bend_of_grid(&sampled.lights, channel);
            let relative = bend / (highest + f64::MIN_POSITIVE);
            let natural = bend * relative * relative * NATURAL;
            let [falling, rising] = &sampled.excess;
            let difference = falling[channel].abs() + rising[channel].abs();
            // Where a number is not finite, the estimate tells.
            error = error.max(difference * caution + natural + by_grid.abs() * ROUNDING);
            if self.finish.is_rough() {
                error = error.max(apart_on_bumps(&sampled.lights, channel, zero));
            }
            let average = star.is_met.select(by_star, by_grid);
            for (value, average) in values.iter_mut().zip(average.iter()) {
                value[channel] = *average;
            }
        }
        if let Some(cosines) = &sampled.cosines {
            // Along diagonals, what lobes miss along both axes may cancel.
            error = error.max(self.of_lobes(simd, Rule::Grid, cosines));
            if is_rough {
                error += self.missed(simd, Rule::Grid, cosines);
            }
        }
        if is_rough {
            // Samples that are farther apart tell nothing of what lies between them, though they may agree.
            let is_unseen = sampled.is_out_of_reach | !self.is_within(MEDIUM);
            error = is_unseen.select(zero + f64::INFINITY, error);
        }
        error = grid.is_met.select(grid.error, error);
        star.is_met.select(star.error, error)
    }
}

/// Adds a sample's share of Kronrod's rule less Gauss's along both diagonals.
#[inline(always)]
fn add_excess<S: Simd>(
    excess: &mut [Radiance<S>; 2],
    light: &Radiance<S>,
    sample: &Sample,
    channels: usize,
) {
    for channel in 0..channels {
        excess[0][channel] += light[channel] * sample.excess[0];
        excess[1][channel] += light[channel] * sample.excess[1];
    }
}
