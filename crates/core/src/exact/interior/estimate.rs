//! The error of rules with five and nine samples, by how light bends between them.

use fearless_simd::Simd;

use super::filled::{Filled, Radiance};
use super::kinks::Kinks;
use super::light_cosines::LightCosines;
use super::samples::{GAUSS_SAMPLES, GRID, POINTS, Rule, WEIGHTS};
use super::terminators::{MEDIUM, SMALL};
use crate::exact::costs::highest_cosine;
use crate::numeric::lanes::{f64x8, mask64x8};
use crate::numeric::pair::both;

/// The nearness of a singularity from which on light is not smooth enough for an estimate. The terms of a
/// root's series fall like powers of it; not tuned.
pub(super) const MOST_NEARNESS: f64 = 0.25;

/// The same on bumps, whose parts are many: there the terms of a root's series that are left out are counted.
const MOST_NEARNESS_OF_BUMPS: f64 = 0.5;

/// The factor on errors of bumps: one pixel in some ten thousand was off by up to four times what the bend
/// told.
pub(super) const CAUTION: f64 = 3.0;

/// The relative error that rounding makes: some units in the last place, of about ten operations.
pub(super) const ROUNDING: f64 = 1e-15;

/// The error of a rule in eight pixels.
#[derive(Clone, Copy, Debug)]
pub(super) struct Estimate<S: Simd> {
    pub(super) error: f64x8<S>,
    /// The pixels whose light is smooth enough for that.
    pub(super) is_known: mask64x8<S>,
    /// The pixels in which that is enough.
    pub(super) is_met: mask64x8<S>,
}

impl<S: Simd> Estimate<S> {
    /// The estimate of a rule that was not tried.
    #[inline(always)]
    pub(super) fn unknown(simd: S) -> Self {
        let never = mask64x8::splat(simd, false);
        Self {
            error: f64x8::splat(simd, 0.0),
            is_known: never,
            is_met: never,
        }
    }
}

impl<S: Simd> Filled<'_, S> {
    /// An estimate of a rule's error by how much light bends, where it is smooth.
    ///
    /// It is small where light is linear, and compares with how much light changes rather than with
    /// how much there is, so that a weak highlight on a bright surface counts. The star's rule is
    /// off by 1/720 of the mixed fourth derivative.
    ///
    /// What could fool it: the second differences of bumps are small by chance, and the kinks of their second derivatives
    /// are not. So what kinks may cost is added, nine samples must agree with five where five are not enough, and the
    /// estimate is multiplied.
    #[inline(always)]
    pub(super) fn estimate(
        &self,
        simd: S,
        rule: Rule,
        lights: &[Radiance<S>; GAUSS_SAMPLES],
        cosines: Option<&LightCosines<S>>,
        kinks: Option<&Kinks<S>>,
    ) -> Estimate<S> {
        /// The terms of the fourth and of the sixth derivative of a root at a nearness of 1: 5/128 z⁴ and 21/1024 z⁶ with
        /// z = a x + b y and |a| + |b| = ν in a corner. Five samples miss most where a = b, nine where one of them is 0,
        /// which is less than what five may miss.
        const OF_ROOT: [f64; 2] = [1.3e-3, 1.5e-5];
        const OF_ROOT_BY_GRID: f64 = 4.7e-4;
        /// The errors of exponential functions over the square of their bend and what they change
        /// by, and over the cube and the square, when they grow to e times as much in a pixel; less when
        /// they grow less.
        const OF_CHANGE: [f64; 2] = [1e-2, 1e-3];
        /// The largest share of the bend that a kink of the second derivative costs, where cells of the
        /// noise meet. Not tuned.
        const OF_KINK: f64 = 0.1;
        /// And more where light begins steeply, with a power below 1: near places of bumps that hardly face it one
        /// pixel in a hundred thousand was off by 2.6 times that.
        const OF_STEEP: f64 = 3.0;
        let is_star = rule == Rule::Star;
        let zero = f64x8::splat(simd, 0.0);
        let is_rough = self.finish.is_rough();
        let nearness_sq = self.nearness * self.nearness;
        let of_sixth = if is_star { OF_ROOT[1] } else { OF_ROOT_BY_GRID };
        let mut of_root = nearness_sq * nearness_sq * nearness_sq * of_sixth;
        if is_star {
            of_root += nearness_sq * nearness_sq * OF_ROOT[0];
        }
        // What vanishes at the silhouette is a part of all light, not of what light falls to in the pixel.
        let most = self.range_of_light();
        if is_rough {
            // Each term is less than ν² times that before.
            of_root /= (nearness_sq * -1.0 + 1.0).max(zero);
        }
        let from_samples = rule.farthest();
        let steep = kinks.zip(cosines).map(|(kinks, cosines)| {
            let slope = self.slope_of_light(simd, cosines, from_samples);
            (kinks, slope)
        });
        let mut error = zero;
        for channel in 0..self.scene.channels {
            let (mut highest, mut lowest) = (lights[0][channel], lights[0][channel]);
            for light in &lights[..rule.samples()] {
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
            if is_rough && kinks.is_none() {
                estimate += OF_KINK;
            }
            let amplitude = if is_rough { highest } else { zero + most };
            error = error.max(estimate * bend + of_root * amplitude + highest * ROUNDING);
            if is_rough && !is_star {
                let explained = steep.map_or(zero, |(kinks, slope)| kinks.apart(&slope));
                error = error.max(apart_on_bumps(lights, channel, explained));
            }
        }
        if is_rough {
            error *= CAUTION;
            let [exponent, _] = self.finish.reflectance.exponents();
            if exponent < 1.0 {
                error *= OF_STEEP;
            }
        }
        if let Some(cosines) = cosines {
            error = error.max(self.of_lobes(simd, rule, cosines));
            if is_rough {
                error += self.of_powers(simd, rule, cosines);
            }
        }
        let mut is_known = self.nearness.simd_lt(MOST_NEARNESS);
        if is_rough {
            is_known = self.nearness.simd_lt(MOST_NEARNESS_OF_BUMPS);
            if let Some(cosines) = cosines {
                error += self.missed(simd, rule, cosines);
            }
            is_known &= self.is_within(if is_star { SMALL } else { MEDIUM });
        }
        if let Some((kinks, slope)) = steep {
            error += kinks.missed(rule, &slope);
        }
        let mut is_met = is_known & error.simd_le(self.tolerance);
        if is_rough && is_star && kinks.is_none() {
            is_met = mask64x8::splat(simd, false);
        }
        Estimate {
            error,
            is_known,
            is_met,
        }
    }

    /// The error of rules for bells exp(−κ) where normals turn through them, however the bend of light
    /// adds up: see [`Bell`].
    #[inline(always)]
    pub(super) fn of_lobes(&self, simd: S, rule: Rule, cosines: &LightCosines<S>) -> f64x8<S> {
        let bells = both(self.finish.reflectance.exponents(), |exponent| Bell {
            exponent,
            rule,
            is_followed: !self.finish.is_rough(),
        });
        let zero = f64x8::splat(simd, 0.0);
        let mut sum = zero;
        let turn = self.turn * self.finish.usual_slope();
        let from_samples = rule.farthest();
        let most = self.turn * (self.finish.shading_normal.slope_bound() * from_samples);
        let has_highlight = bells[1].exponent > 0.0;
        for (index, light) in self.scene.lights.iter().enumerate() {
            if self.lit[index] != 0 {
                let mut cosine = cosines.highest[index];
                let mut highlight = cosines.halves.powers[index];
                // Half vectors turn away from normals that turn with the view.
                let aside = if has_highlight {
                    self.half_turn(simd, light)
                } else {
                    zero
                };
                if self.finish.is_rough() {
                    // Bumps may lead up to the top between the samples.
                    cosine = highest_cosine(simd, cosine, most);
                    let half_cosine = cosines.halves.highest[index];
                    let most = most + aside * from_samples;
                    let half_cosine = highest_cosine(simd, half_cosine, most);
                    highlight = self.finish.highlight_of(half_cosine);
                }
                let shares = [
                    bells[0].share(turn, cosines.lowest[index]),
                    bells[1].share(turn + aside, cosines.halves.lowest[index]),
                ];
                sum += self.finish.lobes(light, cosine, highlight, shares);
            }
        }
        sum
    }
}

/// The bell that a power of a cosine is near its top.
struct Bell {
    exponent: f64,
    rule: Rule,
    /// Whether cosines tell how far from its top light is: those of bumps tell little.
    is_followed: bool,
}

impl Bell {
    /// A bound of the share of a bell exp(−x² / (2 σ²)) that rules are off by, where normals, and half vectors beside
    /// them, turn by `turn` from the middle of a pixel to a corner and the cosine falls to `lowest`.
    ///
    /// It is 15 / σ⁶ over 7! · 400 for each axis of Gauss's rule, and 3 / σ⁴ over 720 more for the star.
    /// For an exponent 1 / σ² is twice that times the square of the turn, or, where all of the turn is
    /// along one axis, four times that along it and 0 along the other, which is worse. Away from the top,
    /// by u = x / σ, derivatives are a larger share of the bell: Hermite's polynomials of u, with all
    /// terms added, over their values at the top. With u² = −ln(bell)·2 less than exponent · tan².
    #[inline(always)]
    fn share<S: Simd>(&self, turn: f64x8<S>, lowest: f64x8<S>) -> f64x8<S> {
        const SIXTH: f64 = 6e-5;
        const FOURTH: f64 = 4.2e-3;
        /// Up to this exponent nothing bends so that second derivatives do not tell.
        const BLUNT: f64 = 2.0;
        /// A cosine below which the bell is nothing.
        const LEAST: f64 = 1e-3;
        let zero = turn * 0.0;
        if self.exponent <= BLUNT {
            return zero;
        }
        let steep = turn * turn * (2.0 * self.exponent);
        let mut off_top = zero;
        if self.is_followed {
            let cosine = lowest.max(zero + LEAST).min(zero + 1.0);
            let cosine_sq = cosine * cosine;
            off_top = (1.0 - cosine_sq) / cosine_sq * self.exponent;
        }
        let steep_sq = steep * steep;
        let of_sixth = ((off_top * (1.0 / 15.0) + 1.0) * off_top + 3.0) * off_top + 1.0;
        let sixth = steep_sq * steep * of_sixth * SIXTH;
        match self.rule {
            Rule::Star => {
                let of_fourth = (off_top * (1.0 / 3.0) + 2.0) * off_top + 1.0;
                sixth + steep_sq * of_fourth * FOURTH
            }
            Rule::Grid => sixth,
        }
    }
}

/// The sum of second differences of light along both axes.
#[inline(always)]
pub(super) fn bend_of_grid<S: Simd>(
    lights: &[Radiance<S>; GAUSS_SAMPLES],
    channel: usize,
) -> f64x8<S> {
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

/// The error of nine samples on bumps, by how far they are from five: at least a part of that, but for what is
/// explained.
#[inline(always)]
pub(super) fn apart_on_bumps<S: Simd>(
    lights: &[Radiance<S>; GAUSS_SAMPLES],
    channel: usize,
    explained: f64x8<S>,
) -> f64x8<S> {
    const OF_DIFFERENCE: f64 = 0.3;
    let mut difference = lights[0][channel] * 0.0;
    for (light, sample) in lights.iter().zip(&POINTS) {
        difference += light[channel] * (sample.star - sample.gauss);
    }
    let zero = explained * 0.0;
    (difference.abs() - explained).max(zero) * OF_DIFFERENCE
}

/// The sum of second differences of light along both diagonals.
#[inline(always)]
fn bend_of_star<S: Simd>(lights: &[Radiance<S>; GAUSS_SAMPLES], channel: usize) -> f64x8<S> {
    let middle = lights[GRID[1][1]][channel] * 2.0;
    let falling = lights[GRID[0][0]][channel] + lights[GRID[2][2]][channel];
    let rising = lights[GRID[0][2]][channel] + lights[GRID[2][0]][channel];
    (falling - middle).abs() + (rising - middle).abs()
}
