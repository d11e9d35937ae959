//! Light of lamps that begins at their cutoffs with a power that is not whole, summed up along chords.
//!
//! The distance from the plane of a cutoff is, along a chord, P / Q with polynomials of degree 2 of its parameter, as is n·l
//! for the plane of a terminator, and Q has no zero near it. So chords are divided at the roots of both, and halfway between
//! them. Each part has a root at one end: with the distance from there as the fourth power of a new parameter, a power
//! of it begins there with a high power, and rules of Gauss converge fast, whatever the power is, and whichever of the
//! two begins there.
//!
//! Rules with 12 nodes are held against those with 8.

use fearless_simd::Simd;

use super::chord::Chord;
use super::fractional::roots;
use super::plain::{normal_times, ray_times};
use super::primitive::{EIGHT, Lines, Noise, Sender, Summed};
use super::turns::Stops;
use crate::exact::points::Points;
use crate::exact::scene::Light;
use crate::light::lobe::Beyond;
use crate::numeric::bits::set_bits;
use crate::numeric::lanes::{f64x8, mask64x8};

/// Gauss's rule on 0 to 1: nodes and weights.
///
/// # Source
/// Abramowitz and Stegun, Handbook of Mathematical Functions, 1964, table 25.4.
const TWELVE: [(f64, f64); 12] = [
    (0.009_219_682_876_640_375, 0.023_587_668_193_255_914),
    (0.047_941_371_814_762_57, 0.053_469_662_997_659_21),
    (0.115_048_662_902_847_65, 0.080_039_164_271_673_11),
    (0.206_341_022_856_691_3, 0.101_583_713_361_532_96),
    (0.316_084_250_500_909_9, 0.116_746_268_269_177_4),
    (0.437_383_295_744_265_54, 0.124_573_522_906_701_39),
    (0.562_616_704_255_734_5, 0.124_573_522_906_701_39),
    (0.683_915_749_499_090_1, 0.116_746_268_269_177_4),
    (0.793_658_977_143_308_7, 0.101_583_713_361_532_96),
    (0.884_951_337_097_152_3, 0.080_039_164_271_673_11),
    (0.952_058_628_185_237_5, 0.053_469_662_997_659_21),
    (0.990_780_317_123_359_7, 0.023_587_668_193_255_914),
];

/// Places at which chords are divided: their ends, and two roots of each plane.
const MOST_PLACES: usize = 6;

/// The light of a lamp along chords.
#[derive(Clone, Copy)]
struct Integrand<'a, 'scene, S: Simd> {
    sender: &'a Sender<'a, 'scene>,
    chord: &'a Chord<S>,
    y: f64x8<S>,
    light: &'a Light,
    /// Whether diffuse light ends at a terminator in the cell, as its power is not whole.
    ends_at_terminator: bool,
    /// The distance from the plane of the cutoff, times what has no zero, at 1, σ and σ².
    ahead: [f64x8<S>; 3],
}

/// A part of chords, from a place at which light may begin.
#[derive(Clone, Copy, Debug)]
struct Part<S: Simd> {
    begin: f64x8<S>,
    end: f64x8<S>,
    lit: mask64x8<S>,
}

impl Sender<'_, '_> {
    /// The light along chords where that of some lamps goes with a power that is not whole of the distance from
    /// their cutoffs.
    #[inline(never)]
    pub(super) fn cut_off<S: Simd>(
        &self,
        simd: S,
        chord: &Chord<S>,
        lines: &Lines<S>,
        noise: &mut Noise,
    ) -> Summed<S> {
        simd.vectorize(
            #[inline(always)]
            || {
                let apart = lines.lights & self.cutoffs;
                let rest = Lines {
                    lights: lines.lights & !apart,
                    diffuse: lines.diffuse & !apart,
                    ..*lines
                };
                let mut sum = Summed::nothing(simd);
                if rest.lights != 0 {
                    sum = self.without_kinks(simd, chord, &rest, noise);
                }
                for index in set_bits(apart) {
                    self.add_lamp(simd, chord, lines, index, noise, &mut sum);
                }
                sum
            },
        )
    }

    /// Notes where chords meet the cutoffs of some lights.
    #[inline(never)]
    pub(super) fn divide_at_cutoffs<S: Simd>(
        &self,
        simd: S,
        chord: &Chord<S>,
        lines: &Lines<S>,
        cutoffs: u64,
        stops: &mut Stops,
    ) {
        for index in set_bits(cutoffs) {
            let Some(plane) = self.scene.lights[index].cutoff(&self.active.ball) else {
                continue;
            };
            simd.vectorize(
                #[inline(always)]
                || {
                    let found = roots(simd, self, chord, lines.y, &plane);
                    for place in [found.low, found.high] {
                        for lane in 0..8 {
                            if place[lane].abs() < 1.0 {
                                stops.note(lane, place[lane]);
                            }
                        }
                    }
                },
            );
        }
    }

    /// Adds the light of one of the lamps.
    #[inline(always)]
    fn add_lamp<S: Simd>(
        &self,
        simd: S,
        chord: &Chord<S>,
        lines: &Lines<S>,
        index: usize,
        noise: &mut Noise,
        sum: &mut Summed<S>,
    ) {
        let one = f64x8::splat(simd, 1.0);
        let (scene, ball) = (self.scene, &self.active.ball);
        let light = &scene.lights[index];
        let Some(cutoff) = light.cutoff(ball) else {
            return;
        };
        let mut places = [one; MOST_PLACES];
        places[0] = -one;
        let mut count = 1;
        let of_cutoff = roots(simd, self, chord, lines.y, &cutoff);
        let mut divide = |place: f64x8<S>| {
            places[count] = place.max(-one).min(one);
            count += 1;
        };
        divide(of_cutoff.low);
        divide(of_cutoff.high);
        let is_fractional = self.finish.has_fractional_exponent();
        let ends_at_terminator = is_fractional && self.terminators >> index & 1 == 1;
        if ends_at_terminator && let Some(plane) = self.active.terminators.plane(scene, ball, index)
        {
            let of_terminator = roots(simd, self, chord, lines.y, &plane);
            divide(of_terminator.low);
            divide(of_terminator.high);
        }
        // The last place is the other end.
        let places = &mut places[..=count];
        sort(places);
        let integrand = Integrand {
            sender: self,
            chord,
            y: lines.y,
            light,
            ends_at_terminator,
            ahead: of_cutoff.polynomial,
        };
        for pair in 1..places.len() {
            integrand.add(simd, places[pair - 1], places[pair], noise, sum);
        }
    }
}

/// Brings places in order on each chord.
#[inline(always)]
fn sort<S: Simd>(places: &mut [f64x8<S>]) {
    for last in (1..places.len()).rev() {
        for index in 0..last {
            let (one, other) = (places[index], places[index + 1]);
            places[index] = one.min(other);
            places[index + 1] = one.max(other);
        }
    }
}

impl<S: Simd> Integrand<'_, '_, S> {
    /// Adds the integral between two places, where the lamp faces what is between them.
    #[inline(always)]
    fn add(&self, simd: S, start: f64x8<S>, end: f64x8<S>, noise: &mut Noise, sum: &mut Summed<S>) {
        let middle = (start + end) * 0.5;
        let [constant, linear, square] = self.ahead;
        let ahead = (square * middle + linear) * middle + constant;
        let lit = ahead.simd_gt(0.0) & start.simd_ne(end);
        if lit.to_bitmask() == 0 {
            return;
        }
        for begin in [start, end] {
            let part = Part {
                begin,
                end: middle,
                lit,
            };
            let fine = self.by_rule(simd, &part, &TWELVE, noise);
            let coarse = self.by_rule(simd, &part, &EIGHT, noise);
            let mut doubt = f64x8::splat(simd, 0.0);
            for channel in 0..self.sender.scene.channels {
                sum.light[channel] += fine[channel];
                doubt = doubt.max((fine[channel] - coarse[channel]).abs());
            }
            sum.doubt += doubt;
            sum.samples += 8 * (TWELVE.len() + EIGHT.len()) as u64;
        }
    }

    /// The integral over a part by a rule.
    #[inline(never)]
    fn by_rule(
        &self,
        simd: S,
        part: &Part<S>,
        rule: &[(f64, f64)],
        noise: &mut Noise,
    ) -> [f64x8<S>; 3] {
        simd.vectorize(
            #[inline(always)]
            || {
                let zero = f64x8::splat(simd, 0.0);
                let mut sum = [zero; 3];
                let way = part.end - part.begin;
                let width = part.lit.select(way.abs(), zero);
                for (node, weight) in rule {
                    let share = node * node * node;
                    let light = self.value(simd, part.begin + way * (share * node), noise);
                    let weight = width * (4.0 * share * weight);
                    for channel in 0..self.sender.scene.channels {
                        sum[channel] += light[channel] * weight;
                    }
                }
                sum
            },
        )
    }

    /// The light at some places of the chords, times how fast x goes with their parameter.
    #[inline(always)]
    fn value(&self, simd: S, sigma: f64x8<S>, noise: &mut Noise) -> [f64x8<S>; 3] {
        let Sender {
            scene,
            cell,
            finish,
            active,
            ..
        } = *self.sender;
        let one = f64x8::splat(simd, 1.0);
        let at = self.chord.homogeneous_lanes(sigma);
        let ray = ray_times(cell, &at, self.y);
        let (normal, length, _) = normal_times(simd, &active.ball, &ray, at.root);
        let mut normal = [normal.times(one / (length * active.ball.radius))];
        finish.perturb(simd, scene, &mut normal, noise);
        let points = Points::new(simd, &active.ball, ray.times(one / at.denominator));
        let reflectance = &finish.reflectance;
        let viewed = finish.viewed(&points, &normal[0]);
        let (cosine, half_cosine, factor) = self.light.on_points(&points, &viewed, Beyond::Nothing);
        let factor = factor.unwrap_or(one) * at.slope / (at.denominator * at.denominator);
        let mut light = [one * 0.0; 3];
        let sum = &mut light[..scene.channels];
        let lit = self.ends_at_terminator.then(|| cosine.simd_gt(0.0));
        let color = reflectance.albedo * self.light.intensity;
        reflectance.add_diffuse(color, cosine, lit, sum);
        reflectance.add_highlight(self.light.intensity, half_cosine, None, sum);
        for sum in sum {
            *sum *= factor;
        }
        light
    }
}

#[cfg(test)]
mod tests;
