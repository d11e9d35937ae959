//! Light summed up along chords.

use fearless_simd::Simd;

use super::chord::{Chord, Reference};
use super::power_rules::PowerRules;
use crate::edges::cell::Cell;
use crate::exact::classify::active::{Active, Terminators};
use crate::exact::points::Points;
use crate::exact::scene::InCamera;
use crate::exact::surface::Finish;
use crate::model::roughness::noise::NoiseCells;
use crate::numeric::lanes::f64x8;
use crate::numeric::vectors::Vectors;

/// Gauss's rules on 0 to 1: nodes and weights.
///
/// # Source
/// Abramowitz and Stegun, Handbook of Mathematical Functions, 1964, table 25.4.
const THREE: [(f64, f64); 3] = [
    (0.112_701_665_379_258_3, 5.0 / 18.0),
    (0.5, 4.0 / 9.0),
    (0.887_298_334_620_741_7, 5.0 / 18.0),
];
const FOUR: [(f64, f64); 4] = [
    (0.069_431_844_202_973_71, 0.173_927_422_568_726_93),
    (0.330_009_478_207_571_87, 0.326_072_577_431_273_07),
    (0.669_990_521_792_428_1, 0.326_072_577_431_273_07),
    (0.930_568_155_797_026_3, 0.173_927_422_568_726_93),
];
pub(super) const SIX: [(f64, f64); 6] = [
    (0.033_765_242_898_423_975, 0.085_662_246_189_585_25),
    (0.169_395_306_766_867_7, 0.180_380_786_524_069_3),
    (0.380_690_406_958_401_5, 0.233_956_967_286_345_63),
    (0.619_309_593_041_598_5, 0.233_956_967_286_345_63),
    (0.830_604_693_233_132_4, 0.180_380_786_524_069_3),
    (0.966_234_757_101_576, 0.085_662_246_189_585_25),
];
pub(super) const EIGHT: [(f64, f64); 8] = [
    (0.019_855_071_751_231_856, 0.050_614_268_145_188_09),
    (0.101_666_761_293_186_66, 0.111_190_517_226_687_23),
    (0.237_233_795_041_835_5, 0.156_853_322_938_943_7),
    (0.408_282_678_752_175_1, 0.181_341_891_689_181),
    (0.591_717_321_247_825, 0.181_341_891_689_181),
    (0.762_766_204_958_164_5, 0.156_853_322_938_943_7),
    (0.898_333_238_706_813_5, 0.111_190_517_226_687_23),
    (0.980_144_928_248_768_2, 0.050_614_268_145_188_09),
];

/// The rules in their order.
pub(super) const RULES: [&[(f64, f64)]; 4] = [&THREE, &FOUR, &SIX, &EIGHT];

/// A sphere that sends light.
#[derive(Clone, Copy, Debug)]
pub(super) struct Sender<'a, 'scene> {
    pub(super) scene: &'a InCamera<'scene>,
    pub(super) cell: &'a Cell,
    pub(super) active: &'a Active,
    pub(super) finish: &'a Finish,
    /// The line on which sums begin.
    pub(super) reference: &'a Reference,
    /// The lights, bit by bit, whose terminators may lie in the cell.
    pub(super) terminators: u64,
    /// Those whose light is singular at their cutoffs, which may lie in the cell.
    pub(super) cutoffs: u64,
    /// Those for its diffuse light, where its power is not whole.
    pub(super) rules: &'a PowerRules,
    pub(super) tolerance: f64,
}

/// The places where light is summed up: on lines of the cell with these y, to these x.
#[derive(Clone, Copy, Debug)]
pub(super) struct Lines<S: Simd> {
    pub(super) x: f64x8<S>,
    pub(super) y: f64x8<S>,
    /// The lights, bit by bit.
    pub(super) lights: u64,
    /// Those of them whose diffuse light counts.
    pub(super) diffuse: u64,
}

/// Light summed up, and what the sum may be off by.
#[derive(Clone, Copy, Debug)]
pub(super) struct Summed<S: Simd> {
    pub(super) light: [f64x8<S>; 3],
    pub(super) doubt: f64x8<S>,
    pub(super) samples: u64,
    /// The share of what the lines differ by that rules across them may miss.
    pub(super) unevenness: f64,
    /// The brightest light that may lie between lines which are dark there.
    pub(super) tip: f64,
}

impl<S: Simd> Summed<S> {
    /// No light, without a doubt.
    #[inline(always)]
    pub(super) fn nothing(simd: S) -> Self {
        let zero = f64x8::splat(simd, 0.0);
        Self {
            light: [zero; 3],
            doubt: zero,
            samples: 0,
            unevenness: 0.0,
            tip: 0.0,
        }
    }
}

/// Memory of the noise.
pub(super) type Noise = Option<Box<NoiseCells>>;

impl Sender<'_, '_> {
    /// The light that the sphere sends where some lights reach it, summed up from the reference on the
    /// line of y to x.
    #[inline(never)]
    pub(super) fn lit_up_to<S: Simd>(
        &self,
        simd: S,
        lines: &Lines<S>,
        noise: &mut Noise,
    ) -> Summed<S> {
        simd.vectorize(
            #[inline(always)]
            || {
                let q = &self.active.discriminant;
                let chord = Chord::new(simd, q, self.reference, lines.x, lines.y);
                if chord.is_empty() {
                    return Summed::nothing(simd);
                }
                if self.has_kinks() {
                    return self.kinked(simd, &chord, lines, noise);
                }
                if self.cutoffs & lines.lights != 0 {
                    return self.cut_off(simd, &chord, lines, noise);
                }
                self.without_kinks(simd, &chord, lines, noise)
            },
        )
    }

    /// Light without kinks, and without cutoffs at which it is singular.
    #[inline(always)]
    pub(super) fn without_kinks<S: Simd>(
        &self,
        simd: S,
        chord: &Chord<S>,
        lines: &Lines<S>,
        noise: &mut Noise,
    ) -> Summed<S> {
        if self.terminators & lines.lights != 0 && self.finish.has_fractional_exponent() {
            return self.fractional(simd, chord, lines, noise);
        }
        if self.is_plain() {
            self.plain(simd, chord, lines)
        } else {
            self.smooth(simd, chord, lines, noise)
        }
    }

    /// Whether light along chords bends or jumps at unknown places: at terminators of bumps, and where highlights
    /// end.
    fn has_kinks(&self) -> bool {
        self.active.terminators == Terminators::Anywhere || self.finish.has_blunt_highlight()
    }

    /// Light without kinks, by rules held against each other.
    #[inline(always)]
    pub(super) fn smooth<S: Simd>(
        &self,
        simd: S,
        chord: &Chord<S>,
        lines: &Lines<S>,
        noise: &mut Noise,
    ) -> Summed<S> {
        /// Powers of e by which a lobe falls on a chord that no few points step over.
        const BLUNT: f64 = 1.0;
        let negligible = NEGLIGIBLE * self.tolerance;
        let steep = greatest(chord.way_sq()) * self.finish.sharpness();
        let is_blunt = steep < BLUNT && !self.scene.has_narrow_lamps;
        let first = match (is_blunt, self.scene.has_near_lights) {
            (true, false) => 0,
            (true, true) => 1,
            (false, _) => 2,
        };
        let mut coarse = self.sum(simd, chord, lines, RULES[first], noise);
        let mut samples = 8 * RULES[first].len() as u64;
        let mut doubt = coarse[0];
        for rule in &RULES[first + 1..] {
            let fine = self.sum(simd, chord, lines, rule, noise);
            samples += 8 * rule.len() as u64;
            doubt = f64x8::splat(simd, 0.0);
            for channel in 0..self.scene.channels {
                doubt = doubt.max((fine[channel] - coarse[channel]).abs());
            }
            coarse = fine;
            if greatest(doubt) <= negligible {
                break;
            }
        }
        Summed {
            light: coarse,
            doubt,
            samples,
            ..Summed::nothing(simd)
        }
    }

    #[inline(never)]
    fn sum<S: Simd>(
        &self,
        simd: S,
        chord: &Chord<S>,
        lines: &Lines<S>,
        rule: &[(f64, f64)],
        noise: &mut Noise,
    ) -> [f64x8<S>; 3] {
        simd.vectorize(
            #[inline(always)]
            || {
                let mut sum = [f64x8::splat(simd, 0.0); 3];
                for (node, weight) in rule {
                    let sigma = f64x8::splat(simd, 2.0 * node - 1.0);
                    let (x, slope) = chord.at(sigma);
                    let mut points = self.points(simd, x, lines.y);
                    let normal = std::slice::from_mut(&mut points.normal);
                    self.finish.perturb(simd, self.scene, normal, noise);
                    let light = self.finish.unclamped(
                        simd,
                        self.scene,
                        &points,
                        [lines.lights, lines.diffuse],
                    );
                    let share = slope * (2.0 * weight);
                    for channel in 0..self.scene.channels {
                        sum[channel] += light[channel] * share;
                    }
                }
                sum
            },
        )
    }

    /// The points that are seen at some places of the cell.
    #[inline(always)]
    pub(super) fn points<S: Simd>(&self, simd: S, x: f64x8<S>, y: f64x8<S>) -> Points<S> {
        Points::new(simd, &self.active.ball, ray(simd, self.cell, x, y))
    }
}

/// The share of the tolerance that chords may be off by.
pub(super) const NEGLIGIBLE: f64 = 0.01;

/// The rays through eight points of a cell.
#[inline(always)]
pub(super) fn ray<S: Simd>(simd: S, cell: &Cell, x: f64x8<S>, y: f64x8<S>) -> Vectors<S> {
    Vectors {
        x: x * cell.size[0] + cell.middle.x,
        y: y * cell.size[1] + cell.middle.y,
        z: f64x8::splat(simd, 1.0),
    }
}

/// The largest of the lanes.
#[inline(always)]
pub(super) fn greatest<S: Simd>(lanes: f64x8<S>) -> f64 {
    let v: [f64; 8] = lanes.into();
    v.into_iter().fold(0.0, f64::max)
}
