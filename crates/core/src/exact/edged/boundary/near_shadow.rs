//! Edges of shadows on balls that the eye is nearer to than their radius.

use fearless_simd::Simd;
use glam::DVec3;

use super::circle::{Circle, Trace, along_circle, on_circle, placed};
use super::piece::{Piece, from_ends};
use crate::edges::cell::{Ball, Cell};
use crate::edges::shadow::Caster;
use crate::numeric::lanes::f64x8;
use crate::numeric::vectors::Vectors;

/// The edge of the shadow of a caster on a ball, from numbers that are no larger than what is seen.
///
/// # Source
/// F(p) = |p|²/2r − p·c/r + K/2r is the height of a point above the ball, to first order, and N(p) = (p − c) / r its slope.
/// From the point p of a circle around the caster's axis along a light l, the edge is s l farther, with
/// s²/2r + g s + F(p) = 0 and g = N·l, which is the same on the whole circle: F is linear in cos θ and sin θ there.
#[derive(Clone, Copy, Debug)]
pub(super) struct NearShadow {
    /// The circle, beside what is seen.
    pub(super) circle: Circle,
    pub(super) center: DVec3,
    pub(super) radius: f64,
    pub(super) toward: DVec3,
    /// g.
    rise: f64,
    /// F on the circle: a constant, and what is multiplied by cos θ and by sin θ.
    height: [f64; 3],
    /// 1 on the side of the ball toward the light, -1 on the other one.
    side: f64,
}

impl NearShadow {
    pub(super) fn new(
        ball: &Ball,
        caster: &Caster,
        (toward, side): (DVec3, f64),
        beside: DVec3,
    ) -> Self {
        let along = (beside - caster.center).dot(toward);
        let circle = Circle {
            middle: caster.center + toward * along,
            right: caster.right * caster.radius,
            up: caster.up * caster.radius,
        };
        let inverse = 1.0 / ball.radius;
        let slope = (circle.middle - ball.center) * inverse;
        let rise = slope.dot(toward);
        let power = ball.power_of(circle.middle) + caster.radius * caster.radius;
        Self {
            circle,
            center: ball.center,
            radius: ball.radius,
            toward,
            rise,
            height: [
                power * (0.5 * inverse),
                slope.dot(circle.right),
                slope.dot(circle.up),
            ],
            side,
        }
    }

    /// D = g² − 2 F / r: a constant, and what is multiplied by cos θ and by sin θ.
    pub(super) fn discriminant(&self) -> [f64; 3] {
        let factor = -2.0 / self.radius;
        let [one, by_cos, by_sin] = self.height;
        [
            self.rise * self.rise + factor * one,
            factor * by_cos,
            factor * by_sin,
        ]
    }

    #[inline(always)]
    pub(super) fn trace<S: Simd>(
        &self,
        simd: S,
        cell: &Cell,
        (piece, s): (&Piece, f64x8<S>),
        (e, turn): ([f64x8<S>; 2], f64x8<S>),
    ) -> Trace<S> {
        let [one, by_cos, by_sin] = self.height;
        let [cos, sin] = e;
        let zero = f64x8::splat(simd, 0.0);
        let height = cos * by_cos + sin * by_sin + one;
        let change = (cos * by_sin - sin * by_cos) * turn;
        let (rise, radius, side) = (self.rise, self.radius, self.side);
        let root = from_ends(piece, s, e, self.discriminant()).max(zero).sqrt();
        // (±√D − g) r, without the difference of two large numbers.
        let way = if rise * side >= 0.0 {
            height * (-2.0 * side) / (root + rise.abs()).max(zero + 1e-150)
        } else {
            (root + rise.abs()) * (radius * side)
        };
        let rising = -(change * side) / root.max(zero + 1e-150);
        let toward = Vectors::splat(simd, self.toward);
        let point = on_circle(simd, &self.circle, e).plus(&toward.times(way));
        let step = along_circle(simd, &self.circle, e)
            .times(turn)
            .plus(&toward.times(rising));
        placed(cell, point, step)
    }
}
