//! Powers of n·l that are not whole, summed up along chords on which they may begin.
//!
//! Along a chord n·l is P / Q with polynomials of degree 2 of its parameter, and Q has no zero near it. So a
//! power of n·l begins at the roots of P, at most two, and is analytic but for them. Chords are divided there;
//! each part has the nearest root at one end, or beyond it. Factors of `grain: Pixel` move the roots, with the axis
//! of the terminator, and divide n·l by a length that has no zero.
//!
//! The rules are those of Gauss and Jacobi where a part begins at a root, else Gauss's: 8 nodes, and 6 whose
//! difference to them is the doubt. Parts are so short that no root is nearer to them, or to what is between
//! them and the root that their rule is made for, than half of their length: so the rules with 6 nodes are off
//! by less than 10⁻⁶ of the light, and their difference could only be fooled by zeros of Q, for which lines
//! would have to pass the eye.

use super::chord::Chord;
use super::plain::{normal_times, ray_times};
use super::power_rules::PowerRules;
use super::primitive::{EIGHT, Lines, Noise, SIX, Sender, Summed};
use crate::edges::terminator::Plane;
use crate::exact::points::places_of_roots;
use crate::exact::scene::Light;
use crate::light::lobe::Beyond;
use crate::numeric::bits::set_bits;
use crate::numeric::lanes::{f64x8, mask64x8};
use crate::numeric::pair::both;
use fearless_simd::Simd;

/// The integrand: the diffuse light of a light, for an intensity and an albedo of 1.
#[derive(Clone, Copy)]
struct Integrand<'a, 'scene, S: Simd> {
    sender: &'a Sender<'a, 'scene>,
    chord: &'a Chord<S>,
    y: f64x8<S>,
    light: &'a Light,
}

/// The roots of P: real ones, or twice the real part of two others, and their distance from the real axis.
#[derive(Clone, Copy, Debug)]
pub(super) struct Roots<S: Simd> {
    pub(super) low: f64x8<S>,
    pub(super) high: f64x8<S>,
    aside: f64x8<S>,
    /// P, at 1, σ and σ².
    pub(super) polynomial: [f64x8<S>; 3],
}

/// A part of chords, from the end that is nearer to a root.
#[derive(Clone, Copy, Debug)]
struct Part<S: Simd> {
    root: f64x8<S>,
    near: f64x8<S>,
    far: f64x8<S>,
}

/// A sum by the rule with 8 nodes, and how far that with 6 is from it.
#[derive(Clone, Copy, Debug)]
struct Integral<S: Simd> {
    value: f64x8<S>,
    doubt: f64x8<S>,
}

/// The nodes and the weights of a rule for a power, and of that which takes its place where none begins.
struct Nodes<'a> {
    of_power: (&'a [f64], &'a [f64]),
    plain: &'a [(f64, f64)],
}

/// A root that is farther than this in multiples of a chord is as good as none.
const FAR: f64 = 1e4;

/// The factor by which each stretch of a part reaches farther from its root than the one before.
const LONGER: f64 = 3.0;

/// Stretches of a part at most: where roots are nearer to each other than 10⁻⁵ of the chord, the last one is
/// too long, which its rules notice.
const MOST_STRETCHES: usize = 12;

impl Sender<'_, '_> {
    /// The light along chords where the diffuse light of some lights goes with a power that is not whole.
    #[inline(never)]
    pub(super) fn fractional<S: Simd>(
        &self,
        simd: S,
        chord: &Chord<S>,
        lines: &Lines<S>,
        noise: &mut Noise,
    ) -> Summed<S> {
        simd.vectorize(
            #[inline(always)]
            || {
                let apart = lines.lights & self.terminators;
                let rest = Lines {
                    diffuse: lines.lights & !apart,
                    ..*lines
                };
                let mut sum = Summed::nothing(simd);
                if rest.diffuse != 0 || self.finish.reflectance.highlight.is_some() {
                    sum = self.smooth(simd, chord, &rest, noise);
                }
                for index in set_bits(apart) {
                    let light = &self.scene.lights[index];
                    let ball = &self.active.ball;
                    let Some(plane) = self.active.terminators.plane(self.scene, ball, index) else {
                        continue;
                    };
                    let integrand = Integrand {
                        sender: self,
                        chord,
                        y: lines.y,
                        light,
                    };
                    let (of_light, samples) = integrand.integral(simd, &plane, noise);
                    let color = self.finish.reflectance.albedo * light.intensity;
                    for channel in 0..self.scene.channels {
                        sum.light[channel] += of_light.value * color[channel];
                    }
                    sum.doubt += of_light.doubt * color.max_element();
                    sum.samples += samples;
                }
                sum
            },
        )
    }
}

impl<S: Simd> Integrand<'_, '_, S> {
    /// The integral along the chords where the axis of the terminator faces normals, and the samples that it
    /// took.
    #[inline(always)]
    fn integral(&self, simd: S, plane: &Plane, noise: &mut Noise) -> (Integral<S>, u64) {
        let one = f64x8::splat(simd, 1.0);
        let roots = roots(simd, self.sender, self.chord, self.y, plane);
        let apart = roots.high - roots.low;
        let between = (roots.low + roots.high) * 0.5;
        let clamped = |place: f64x8<S>| place.max(-one).min(one);
        let (low, middle, high) = (clamped(roots.low), clamped(between), clamped(roots.high));
        let mut sum = Integral {
            value: one * 0.0,
            doubt: one * 0.0,
        };
        let mut samples = 24;
        for (root, near, far) in [
            (roots.low, low, -one),
            (roots.low, low, middle),
            (roots.high, high, middle),
            (roots.high, high, one),
        ] {
            let part = Part { root, near, far };
            let [constant, linear, square] = roots.polynomial;
            let inside = (near + far) * 0.5;
            let value = (square * inside + linear) * inside + constant;
            let is_lit = value.simd_gt(0.0) & near.simd_ne(far);
            if is_lit.to_bitmask() == 0 {
                continue;
            }
            let (of_part, more) = self.of_part(simd, &part, apart, roots.aside, noise);
            sum.value += of_part.value;
            sum.doubt += of_part.doubt;
            samples += more;
        }
        (sum, samples)
    }

    /// The integral over a part, from its near end to its far one: in stretches that reach the farther from the
    /// root, the farther they begin from it.
    #[inline(always)]
    fn of_part(
        &self,
        simd: S,
        part: &Part<S>,
        apart: f64x8<S>,
        aside: f64x8<S>,
        noise: &mut Noise,
    ) -> (Integral<S>, u64) {
        let zero = f64x8::splat(simd, 0.0);
        let before = (part.near - part.root).abs();
        let length = (part.far - part.near).abs();
        let end = before + length;
        let is_backward = part.far.simd_lt(part.root);
        let direction = is_backward.select(zero - 1.0, zero + 1.0);
        let from_root = before.simd_lt(apart.min(length) * 0.5) & aside.simd_eq(0.0);
        let first = from_root.select(apart, before + (before * 2.0).max(aside));
        let mut reach = first.min(end);
        let at = |distance: f64x8<S>| part.root + direction * distance;
        let start = from_root.select(part.root, part.near);
        let mut sum = self.stretch(simd, start, at(reach), from_root, noise);
        let mut samples = 14 * 8;
        let is_beyond = from_root & before.simd_gt(0.0);
        if is_beyond.to_bitmask() != 0 {
            let start = is_beyond.select(part.root, part.near);
            let more = self.stretch(simd, start, part.near, is_beyond, noise);
            sum.value -= more.value;
            sum.doubt += more.doubt;
            samples += 14 * 8;
        }
        for count in 1..=MOST_STRETCHES {
            if reach.simd_ge(end).to_bitmask() == 0xff {
                break;
            }
            let next = if count < MOST_STRETCHES {
                (reach * LONGER).min(end)
            } else {
                end
            };
            let never = zero.simd_gt(0.0);
            let more = self.stretch(simd, at(reach), at(next), never, noise);
            sum.value += more.value;
            sum.doubt += more.doubt;
            samples += 14 * 8;
            reach = next;
        }
        (sum, samples)
    }

    /// The integral from one place to another, in some lanes by the rule for a power that begins at the first.
    fn stretch(
        &self,
        simd: S,
        start: f64x8<S>,
        end: f64x8<S>,
        from_root: mask64x8<S>,
        noise: &mut Noise,
    ) -> Integral<S> {
        let PowerRules { fine, coarse, .. } = self.sender.rules;
        let way = (start, end - start);
        let fine = Nodes {
            of_power: (&fine.nodes, &fine.weights),
            plain: &EIGHT,
        };
        let coarse = Nodes {
            of_power: (&coarse.nodes, &coarse.weights),
            plain: &SIX,
        };
        let [fine, coarse] = both([fine, coarse], |rule| {
            self.by_rule(simd, way, &rule, from_root, noise)
        });
        let width = way.1.abs();
        Integral {
            value: fine * width,
            doubt: ((fine - coarse) * width).abs(),
        }
    }

    /// The average on the way from a place, in some lanes by the rule for a power that begins there.
    #[inline(never)]
    fn by_rule(
        &self,
        simd: S,
        (start, way): (f64x8<S>, f64x8<S>),
        rule: &Nodes<'_>,
        from_root: mask64x8<S>,
        noise: &mut Noise,
    ) -> f64x8<S> {
        simd.vectorize(
            #[inline(always)]
            || {
                let (nodes, weights) = rule.of_power;
                let mut sum = way.abs() * 0.0;
                for ((of_power, weight), plain) in nodes.iter().zip(weights).zip(rule.plain) {
                    let (node, weight) = chosen(simd, from_root, (*of_power, *weight), *plain);
                    sum += self.value(simd, start + way * node, noise) * weight;
                }
                sum
            },
        )
    }

    /// The light at some places of the chords, times how fast x goes with their parameter.
    #[inline(always)]
    fn value(&self, simd: S, sigma: f64x8<S>, noise: &mut Noise) -> f64x8<S> {
        let Sender {
            scene,
            cell,
            finish,
            active,
            ..
        } = *self.sender;
        let at = self.chord.homogeneous_lanes(sigma);
        let ray = ray_times(cell, &at, self.y);
        let (normal, length, _) = normal_times(simd, &active.ball, &ray, at.root);
        let one = f64x8::splat(simd, 1.0);
        let mut normal = [normal.times(one / (length * active.ball.radius))];
        finish.perturb(simd, scene, &mut normal, noise);
        let diffuse = &finish.reflectance.diffuse;
        let power = match &self.light.near {
            None => diffuse.of(normal[0].dot_one(self.light.toward)),
            Some(near) => {
                // A root beyond the contour lies on the far side: the way of light goes on there, too.
                let inverse = one / at.denominator;
                let places = places_of_roots(&active.ball, &ray.times(inverse), at.root * inverse);
                let (toward, factor) = near.seen_from(&places, Beyond::Continued);
                diffuse.of(normal[0].dot(&toward)) * factor
            }
        };
        power * at.slope / (at.denominator * at.denominator)
    }
}

/// The roots of P of the plane of a terminator or of a cutoff, on chords of lines with these y: from its values at their
/// ends and in their middle.
#[inline(always)]
pub(super) fn roots<S: Simd>(
    simd: S,
    sender: &Sender<'_, '_>,
    chord: &Chord<S>,
    y: f64x8<S>,
    plane: &Plane,
) -> Roots<S> {
    let zero = f64x8::splat(simd, 0.0);
    let Sender { cell, active, .. } = *sender;
    let mut values = [zero; 3];
    for (value, sigma) in values.iter_mut().zip([-1.0, 0.0, 1.0]) {
        let at = chord.homogeneous(sigma);
        let ray = ray_times(cell, &at, y);
        let (normal, length, along) = normal_times(simd, &active.ball, &ray, at.root);
        *value = normal.dot_one(plane.axis) * along / length;
        if plane.offset != 0.0 {
            *value -= along * plane.offset;
        }
    }
    let [first, constant, last] = values;
    let linear = (last - first) * 0.5;
    let square = (last + first) * 0.5 - constant;
    let discriminant = linear * linear - square * constant * 4.0;
    let is_real = discriminant.simd_ge(0.0);
    let root = discriminant.abs().sqrt();
    let is_falling = linear.simd_lt(0.0);
    let sum = (linear + is_falling.select(-root, root)) * -0.5;
    let middle = linear * -0.5 / square;
    let far = zero + FAR;
    let known = |place: f64x8<S>| place.abs().simd_lt(FAR).select(place, far);
    let one = known(is_real.select(sum / square, middle));
    let other = known(is_real.select(constant / sum, middle));
    Roots {
        low: one.min(other),
        high: one.max(other),
        aside: is_real.select(zero, (root * 0.5 / square).abs().min(far)),
        polynomial: [constant, linear, square],
    }
}

/// A node and its weight, of the rule for a power in some lanes.
#[inline(always)]
fn chosen<S: Simd>(
    simd: S,
    from_root: mask64x8<S>,
    of_power: (f64, f64),
    plain: (f64, f64),
) -> (f64x8<S>, f64x8<S>) {
    let node = from_root.select(f64x8::splat(simd, of_power.0), f64x8::splat(simd, plain.0));
    let weight = from_root.select(f64x8::splat(simd, of_power.1), f64x8::splat(simd, plain.1));
    (node, weight)
}

#[cfg(test)]
mod tests;
