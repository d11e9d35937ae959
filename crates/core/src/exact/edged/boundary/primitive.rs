//! Light summed up along lines.

use fearless_simd::f64x8;
use fearless_simd::prelude::*;

use crate::edges::cell::Cell;
use crate::exact::classify::active::Active;
use crate::exact::points::Points;
use crate::exact::scene::InCamera;
use crate::exact::surface::Finish;
use crate::numeric::vectors::Vectors;

/// Gauss's rules on 0 to 1: nodes and weights.
///
/// # Source
/// Abramowitz and Stegun, Handbook of Mathematical Functions, 1964, table 25.4.
const FOUR: [(f64, f64); 4] = [
    (0.069_431_844_202_973_71, 0.173_927_422_568_726_93),
    (0.330_009_478_207_571_87, 0.326_072_577_431_273_07),
    (0.669_990_521_792_428_1, 0.326_072_577_431_273_07),
    (0.930_568_155_797_026_3, 0.173_927_422_568_726_93),
];
const SIX: [(f64, f64); 6] = [
    (0.033_765_242_898_423_975, 0.085_662_246_189_585_25),
    (0.169_395_306_766_867_7, 0.180_380_786_524_069_3),
    (0.380_690_406_958_401_5, 0.233_956_967_286_345_63),
    (0.619_309_593_041_598_5, 0.233_956_967_286_345_63),
    (0.830_604_693_233_132_4, 0.180_380_786_524_069_3),
    (0.966_234_757_101_576, 0.085_662_246_189_585_25),
];
const EIGHT: [(f64, f64); 8] = [
    (0.019_855_071_751_231_856, 0.050_614_268_145_188_09),
    (0.101_666_761_293_186_66, 0.111_190_517_226_687_23),
    (0.237_233_795_041_835_5, 0.156_853_322_938_943_7),
    (0.408_282_678_752_175_1, 0.181_341_891_689_181),
    (0.591_717_321_247_825, 0.181_341_891_689_181),
    (0.762_766_204_958_164_5, 0.156_853_322_938_943_7),
    (0.898_333_238_706_813_5, 0.111_190_517_226_687_23),
    (0.980_144_928_248_768_2, 0.050_614_268_145_188_09),
];

/// What the rules are off by for n·l on a way of the parameter that is 1 long, wherever it lies: the
/// largest that a test finds, made larger. It falls with the power of the way that is twice the nodes and
/// one.
const OFF: [f64; 3] = [2e-3, 1.6e-5, 1e-7];

/// A sphere that sends light.
#[derive(Clone, Copy, Debug)]
pub(super) struct Sender<'a, 'scene> {
    pub(super) scene: &'a InCamera<'scene>,
    pub(super) active: &'a Active,
    pub(super) finish: &'a Finish,
    /// Those that reach it, bit by bit.
    pub(super) lights: u64,
    /// The parameter of the place to begin with.
    pub(super) reference: f64,
}

/// Where light is summed up: on lines of the cell with these y, to these x.
#[derive(Clone, Copy, Debug)]
pub(super) struct Lines<'a, S: Simd> {
    pub(super) cell: &'a Cell,
    pub(super) x: f64x8<S>,
    pub(super) y: f64x8<S>,
}

/// Light summed up, and what the sum may be off by.
#[derive(Clone, Copy, Debug)]
pub(super) struct Summed<S: Simd> {
    pub(super) light: [f64x8<S>; 3],
    pub(super) doubt: f64x8<S>,
    pub(super) samples: u64,
}

/// The light that a sphere sends where some lights reach it, summed up from a place on the line of y
/// to x.
///
/// On the chord of a line the parameter τ is -1 and 1 at the outline, x = middle + width · 2 τ / (1 + τ²),
/// so that the root of the distance to either end is rational, and the light smooth. The place to begin
/// with has the same τ on all lines.
#[inline(never)]
pub(super) fn lit_up_to<S: Simd>(
    simd: S,
    sender: &Sender<'_, '_>,
    lines: &Lines<'_, S>,
    negligible: f64,
) -> Summed<S> {
    simd.vectorize(
        #[inline(always)]
        || {
            let zero = f64x8::splat(simd, 0.0);
            let one = f64x8::splat(simd, 1.0);
            let (x, y) = (lines.x, lines.y);
            let q = &sender.active.discriminant;
            let half = (y * q.xy + q.x) * 0.5;
            let rest = (y * q.yy + q.y) * y + q.one;
            let middle = half * (-1.0 / q.xx);
            let most = rest + middle * half;
            let width = (most * (-1.0 / q.xx)).max(zero).sqrt();
            let here = ((x * q.xx + half * 2.0) * x + rest).max(zero);
            let root = (here / most).min(one).sqrt();
            let sine = ((x - middle) / width).min(one).max(-one);
            let chord = Chord {
                middle,
                width,
                reference: sender.reference,
                way: sine / (one + root) - sender.reference,
            };
            let ways: [f64; 8] = chord.way.abs().into();
            let way = ways.into_iter().fold(0.0, f64::max);
            let widths: [f64; 8] = width.into();
            let width = widths.into_iter().fold(0.0, f64::max);
            let brightest = sender.finish.brightest(sender.scene, sender.lights);
            if !sender.finish.is_plain() {
                let eight = chord.sum(simd, sender, lines, &EIGHT);
                let six = chord.sum(simd, sender, lines, &SIX);
                let mut doubt = zero;
                for channel in 0..sender.scene.channels {
                    doubt = doubt.max((eight[channel] - six[channel]).abs());
                }
                return Summed {
                    light: eight,
                    doubt,
                    samples: 112,
                };
            }
            let way_sq = way * way;
            let power = way_sq * way_sq * way_sq * way_sq * way;
            let offs = [
                OFF[0] * power,
                OFF[1] * power * way_sq * way_sq,
                OFF[2] * power * way_sq * way_sq * way_sq * way_sq,
            ];
            let scale = width * brightest;
            let (light, off, samples) = if offs[0] * scale <= negligible {
                let sum = chord.sum(simd, sender, lines, &FOUR);
                (sum, offs[0], 32)
            } else if offs[1] * scale <= negligible {
                let sum = chord.sum(simd, sender, lines, &SIX);
                (sum, offs[1], 48)
            } else {
                let sum = chord.sum(simd, sender, lines, &EIGHT);
                (sum, offs[2], 64)
            };
            Summed {
                light,
                doubt: one * (off * scale),
                samples,
            }
        },
    )
}

/// The chords of lines in an outline.
#[derive(Clone, Copy, Debug)]
struct Chord<S: Simd> {
    middle: f64x8<S>,
    /// Half of it.
    width: f64x8<S>,
    /// Where the parameter begins, and how far it goes.
    reference: f64,
    way: f64x8<S>,
}

impl<S: Simd> Chord<S> {
    #[inline(never)]
    fn sum(
        &self,
        simd: S,
        sender: &Sender<'_, '_>,
        lines: &Lines<'_, S>,
        rule: &[(f64, f64)],
    ) -> [f64x8<S>; 3] {
        simd.vectorize(
            #[inline(always)]
            || {
                let one = f64x8::splat(simd, 1.0);
                let mut sum = [f64x8::splat(simd, 0.0); 3];
                let cell = lines.cell;
                let ray_y = lines.y * cell.size[1] + cell.middle.y;
                for (node, weight) in rule {
                    let tau = self.way * *node + self.reference;
                    let tau_sq = tau * tau;
                    let inverse = one / (tau_sq + 1.0);
                    let x = self.middle + self.width * tau * 2.0 * inverse;
                    let slope = (one - tau_sq) * inverse * inverse * (2.0 * weight);
                    let ray = Vectors {
                        x: x * cell.size[0] + cell.middle.x,
                        y: ray_y,
                        z: one,
                    };
                    let points = Points::new(simd, &sender.active.ball, ray);
                    let light = sender
                        .finish
                        .unclamped(simd, sender.scene, &points, sender.lights);
                    for channel in 0..sender.scene.channels {
                        sum[channel] += light[channel] * slope;
                    }
                }
                let scale = self.width * self.way;
                for channel in &mut sum {
                    *channel *= scale;
                }
                sum
            },
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The integral of a part of n·l along a chord, which is that of cos² φ, sin φ cos φ or cos φ, from
    /// one tan(φ / 2) to another.
    fn error(rule: &[(f64, f64)], start: f64, way: f64, part: usize) -> f64 {
        let light = |tau: f64| {
            let below = 1.0 + tau * tau;
            let (cos, sin) = ((1.0 - tau * tau) / below, 2.0 * tau / below);
            [cos * cos, sin * cos, cos][part] * 2.0 / below
        };
        let integral = |tau: f64| {
            let angle = 2.0 * libm::atan(tau);
            let (cos, sin) = (libm::cos(angle), libm::sin(angle));
            [0.5 * (angle + sin * cos), 0.5 * sin * sin, sin][part]
        };
        let nodes = rule.iter();
        let sum: f64 = nodes
            .map(|(node, weight)| weight * way * light(start + way * node))
            .sum();
        (sum - (integral(start + way) - integral(start))).abs()
    }

    #[test]
    fn rules_are_off_by_no_more_than_they_are_said_to() {
        let rules: [&[(f64, f64)]; 3] = [&FOUR, &SIX, &EIGHT];
        for (rule, off) in rules.into_iter().zip(OFF) {
            for way in [1.0, 0.8, 0.6] {
                let mut worst = 0.0_f64;
                for step in 0..=100 {
                    let start = -1.0 + f64::from(step) * (2.0 - way) / 100.0;
                    for part in 0..3 {
                        worst = worst.max(error(rule, start, way, part));
                    }
                }
                let said = off * libm::pow(way, 2.0 * rule.len() as f64 + 1.0);
                assert!(worst <= said, "{} {way}: {worst:e} {said:e}", rule.len());
                assert!(worst > 0.1 * said, "{} {way}: {worst:e}", rule.len());
            }
        }
    }
}
