//! The edges of shadows that spheres cast on spheres.

use fearless_simd::mask64x8;
use fearless_simd::prelude::*;
use glam::{DVec2, DVec3};

use super::cell::{Ball, Cell};
use crate::numeric::quartic;
use crate::numeric::vectors::Vectors;
use fearless_simd::f64x8;

/// Where the planes of eight lines cut a sphere that the eye is outside of: circles, of which an
/// arc is seen.
///
/// With M the middle of a circle, U the vector from it to the point nearest the eye and V the one
/// of the same length in the direction of x, the points of the circle are
///
/// > M + (U (1 − τ²) + V 2τ) / (1 + τ²), τ = tan(φ / 2).
#[derive(Clone, Copy, Debug)]
pub(crate) struct Arcs<S: Simd> {
    middle: Vectors<S>,
    toward: Vectors<S>,
    across: Vectors<S>,
    /// The arc is seen from `low` to `high`, clipped to the cell where it reaches its sides; NaN
    /// where a line misses the sphere.
    low: f64x8<S>,
    high: f64x8<S>,
}

/// A sphere as a light sees it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Caster {
    pub(crate) center: DVec3,
    pub(crate) radius: f64,
    /// Unit vectors across the light.
    pub(crate) right: DVec3,
    pub(crate) up: DVec3,
}

/// Places on a line that edges of one kind may have.
pub(crate) const MOST_ROOTS: usize = 2;

impl<S: Simd> Arcs<S> {
    /// The circles in which the lines with these y cut a sphere.
    #[inline(always)]
    pub(crate) fn new(simd: S, cell: &Cell, ball: &Ball, y: f64x8<S>) -> Self {
        let [along, across_axis] = cell.axes();
        let one = f64x8::splat(simd, 1.0);
        let base = Vectors::splat(simd, cell.middle).moved(across_axis, y * cell.size[1]);
        // The plane's normal x̂ × d, where x̂ is a unit vector along the line.
        let axis = Vectors::splat(simd, DVec3::AXES[along]);
        let normal = axis.cross(&base);
        let normal = normal.times(one / normal.length_squared().sqrt());
        let center = Vectors::splat(simd, ball.center);
        let height = center.dot(&normal);
        let radius_sq = (f64x8::splat(simd, ball.radius) - height) * (height + ball.radius);
        let radius = radius_sq.sqrt();
        let middle = center.minus(&normal.times(height));
        let distance = middle.length_squared().sqrt();
        let toward = middle.times(-(radius / distance));
        let across = normal.cross(&toward);
        // The arc ends where the ray grazes: tan²(φ/2) = (|M| − R) / (|M| + R), and the product of
        // the two is K.
        let outline = f64x8::splat(simd, ball.outside.sqrt()) / (distance + radius);
        let arcs = Self {
            middle,
            toward,
            across,
            low: -outline,
            high: outline,
        };
        // A little beyond the sides, so that what ends there is there.
        const BEYOND: f64 = 0.5 + 1e-9;
        let step = one * (BEYOND * cell.size[0]);
        Self {
            low: arcs.parameter(&base.moved(along, -step), ball, radius_sq, arcs.low),
            high: arcs.parameter(&base.moved(along, step), ball, radius_sq, arcs.high),
            ..arcs
        }
    }

    /// The parameter τ of what is seen along a ray of the plane, or something else where the ray
    /// misses.
    #[inline(always)]
    fn parameter(
        &self,
        ray: &Vectors<S>,
        ball: &Ball,
        radius_sq: f64x8<S>,
        otherwise: f64x8<S>,
    ) -> f64x8<S> {
        let along_ray = ray.dot_one(ball.center);
        let root = (along_ray * along_ray - ray.length_squared() * ball.outside).sqrt();
        let t = (root * 0.0 + ball.outside) / (along_ray + root);
        let point = ray.times(t).minus(&self.middle);
        let tau = point.dot(&self.across) / (radius_sq + point.dot(&self.toward));
        let is_seen = root.simd_ge(0.0) & along_ray.simd_gt(0.0);
        is_seen.select(tau, otherwise)
    }

    /// The places x, rising and falling, at which the lines leave and enter the shadow of a sphere;
    /// NaN where they do not.
    ///
    /// `scratch` is overwritten.
    #[inline(never)]
    pub(crate) fn crossings(
        &self,
        simd: S,
        cell: &Cell,
        caster: &Caster,
        scratch: &mut Vec<f64>,
    ) -> [[f64x8<S>; MOST_ROOTS]; 2] {
        simd.vectorize(
            #[inline(always)]
            || {
                let nothing = f64x8::splat(simd, f64::NAN);
                let mut places = [[nothing; MOST_ROOTS]; 2];
                let (bernstein, summands) = self.shadow(simd, caster);
                let bernstein = without_grazed_ends(bernstein, summands * ROUNDINGS);
                let valid = self.low.simd_lt(self.high).to_bitmask();
                let mut is_inside = [0; 5];
                let (mut any, mut all) = (0, valid);
                for (is_inside, value) in is_inside.iter_mut().zip(&bernstein) {
                    *is_inside = value.simd_lt(0.0).to_bitmask();
                    any |= *is_inside;
                    all &= *is_inside;
                }
                // Neither wholly lit nor wholly dark.
                let mixed = any & valid & !all;
                if mixed == 0 {
                    return places;
                }
                // Lanes with one change of sign have one root (Descartes' rule in Bernstein form).
                let (mut once, mut twice) = (0, 0);
                for index in 0..4 {
                    let change = is_inside[index] ^ is_inside[index + 1];
                    twice |= once & change;
                    once |= change;
                }
                let single = mixed & once & !twice;
                if single != 0 {
                    let s = single_root(simd, &bernstein, single);
                    let tau = self.low + (self.high - self.low) * s;
                    let x = self.place(cell, tau);
                    let rises = bernstein[4].simd_gt(bernstein[0]);
                    let is_single = mask64x8::from_bitmask(simd, single);
                    let missing = nothing;
                    places[0][0] = (is_single & rises).select(x, missing);
                    places[1][0] = (is_single & !rises).select(x, missing);
                }
                let mut rest = mixed & twice;
                while rest != 0 {
                    let lane = rest.trailing_zeros() as usize;
                    rest &= rest - 1;
                    let mut row = [0.0; 5];
                    for (row, value) in row.iter_mut().zip(&bernstein) {
                        *row = value[lane];
                    }
                    scratch.clear();
                    quartic::roots(row, scratch);
                    drop_grazed(&row, ROUNDINGS * summands[lane], scratch);
                    let mut is_in = row[0] < 0.0;
                    let mut counts = [0, 0];
                    for &s in scratch.iter() {
                        let kind = usize::from(!is_in);
                        is_in = !is_in;
                        if counts[kind] < MOST_ROOTS {
                            let tau = self.low + (self.high - self.low) * s;
                            places[kind][counts[kind]][lane] = self.place(cell, tau)[lane];
                            counts[kind] += 1;
                        }
                    }
                }
                places
            },
        )
    }

    /// The Bernstein coefficients, from `low` to `high`, of |P|² − r² (1 + τ²)², where P / (1 + τ²)
    /// is the vector from the caster's center, seen along the light: negative in the caster's
    /// cylinder. And the size of what they are summed from.
    #[inline(always)]
    fn shadow(&self, simd: S, caster: &Caster) -> ([f64x8<S>; 5], f64x8<S>) {
        let from_caster = self.middle.minus(&Vectors::splat(simd, caster.center));
        let zero = f64x8::splat(simd, 0.0);
        let mut sums = [zero; 5];
        let span = self.high - self.low;
        let nearest = from_caster.plus(&self.toward);
        let farthest = from_caster.minus(&self.toward);
        for axis in [caster.right, caster.up] {
            let p0 = nearest.dot_one(axis);
            let p1 = self.across.dot_one(axis) * 2.0;
            let p2 = farthest.dot_one(axis);
            // The quadratic p₀ + p₁ τ + p₂ τ² in Bernstein form.
            let b0 = p0 + (p1 + p2 * self.low) * self.low;
            let b1 = b0 + (p1 + p2 * self.low * 2.0) * (span * 0.5);
            let b2 = p0 + (p1 + p2 * self.high) * self.high;
            sums[0] += b0 * b0;
            sums[1] += b0 * b1;
            sums[2] += (b0 * b2 + b1 * b1 * 2.0) * (1.0 / 3.0);
            sums[3] += b1 * b2;
            sums[4] += b2 * b2;
        }
        let (low, high) = (self.low, self.high);
        let (r0, r1, r2) = (low * low + 1.0, low * high + 1.0, high * high + 1.0);
        let radius_sq = caster.radius * caster.radius;
        let summands = sums[0] + sums[4] + (r0 * r0 + r2 * r2) * radius_sq;
        let bernstein = [
            sums[0] - r0 * r0 * radius_sq,
            sums[1] - r0 * r1 * radius_sq,
            sums[2] - (r0 * r2 + r1 * r1 * 2.0) * (radius_sq / 3.0),
            sums[3] - r1 * r2 * radius_sq,
            sums[4] - r2 * r2 * radius_sq,
        ];
        (bernstein, summands)
    }

    /// The place x at which a point of the arc is seen.
    #[inline(always)]
    fn place(&self, cell: &Cell, tau: f64x8<S>) -> f64x8<S> {
        let [along, _] = cell.axes();
        let tau_sq = tau * tau;
        // Times 1 + τ², which makes no difference.
        let (plus, minus, twice) = (tau_sq + 1.0, 1.0 - tau_sq, tau * 2.0);
        let along_line = self.middle.along(along) * plus
            + self.toward.along(along) * minus
            + self.across.along(along) * twice;
        let depth = self.middle.z * plus + self.toward.z * minus + self.across.z * twice;
        (along_line / depth - cell.middle[along]) * (1.0 / cell.size[0])
    }
}

/// What rounding makes of a polynomial's values, relative to what they are summed from.
const ROUNDINGS: f64 = 4e-15;

/// Drops pairs of roots between which the polynomial is as good as zero: a cylinder that touches a
/// sphere all along a line, as a caster's of the same size right before a sphere does.
fn drop_grazed(bernstein: &[f64; 5], rounding: f64, roots: &mut Vec<f64>) {
    let mut index = 0;
    while index + 1 < roots.len() {
        let middle = 0.5 * (roots[index] + roots[index + 1]);
        if quartic::value(bernstein, middle).abs() <= rounding {
            roots.drain(index..index + 2);
        } else {
            index += 1;
        }
    }
}

/// The coefficients, with the signs of their neighbors where at the ends they are as good as zero: a
/// cylinder may touch a sphere there.
#[inline(always)]
fn without_grazed_ends<S: Simd>(
    [first, second, third, fourth, fifth]: [f64x8<S>; 5],
    rounding: f64x8<S>,
) -> [f64x8<S>; 5] {
    let second = signed_like(second, third, rounding);
    let fourth = signed_like(fourth, third, rounding);
    [
        signed_like(first, second, rounding),
        second,
        third,
        fourth,
        signed_like(fifth, fourth, rounding),
    ]
}

/// The value, with the sign of its neighbor where it is as good as zero.
#[inline(always)]
fn signed_like<S: Simd>(value: f64x8<S>, like: f64x8<S>, rounding: f64x8<S>) -> f64x8<S> {
    let is_zero = value.abs().simd_le(rounding);
    let signed = like.simd_lt(0.0).select(-rounding, rounding);
    is_zero.select(signed, value)
}

/// The root on 0 to 1 of the lanes in `which`, which have one change of sign between their first
/// and last coefficient: Newton's steps, and halvings where they leave what is known to hold it.
#[inline(always)]
fn single_root<S: Simd>(simd: S, bernstein: &[f64x8<S>; 5], which: u64) -> f64x8<S> {
    const MOST_STEPS: u32 = 60;
    /// Relative to the whole interval.
    const CLOSE: f64 = 1e-13;
    let (mut low, mut high) = (f64x8::splat(simd, 0.0), f64x8::splat(simd, 1.0));
    let rises = bernstein[4].simd_gt(bernstein[0]);
    let first = bernstein[0] / (bernstein[0] - bernstein[4]);
    let mut s = (first.simd_gt(0.0) & first.simd_lt(1.0)).select(first, high * 0.5);
    for _ in 0..MOST_STEPS {
        let mut row = *bernstein;
        for level in 1..4 {
            for index in 0..5 - level {
                row[index] += s * (row[index + 1] - row[index]);
            }
        }
        let slope = row[1] - row[0];
        let value = row[0] + s * slope;
        let is_beyond = !(value.simd_gt(0.0) ^ rises);
        high = is_beyond.select(s, high);
        low = is_beyond.select(low, s);
        let newton = s - value / (slope * 4.0);
        let is_inside = newton.simd_ge(low) & newton.simd_le(high);
        let next = is_inside.select(newton, (low + high) * 0.5);
        let moved = (next - s).abs().simd_gt(CLOSE).to_bitmask();
        s = next;
        if moved & which == 0 {
            break;
        }
    }
    s
}

impl Caster {
    /// Where the light sees a point, from the caster's center.
    pub(crate) fn project(&self, point: DVec3) -> DVec2 {
        let from_center = point - self.center;
        DVec2::new(from_center.dot(self.right), from_center.dot(self.up))
    }
}

#[cfg(test)]
mod tests;
