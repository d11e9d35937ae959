//! Circles in space, and where eight of their points are seen.

use fearless_simd::Simd;
use glam::{DVec2, DVec3};

use crate::edges::cell::{Ball, Cell};
use crate::edges::seam::SeamPlane;
use crate::edges::shadow::Cone;
use crate::edges::terminator::Plane;
use crate::numeric::lanes::f64x8;
use crate::numeric::vectors::Vectors;

/// A circle in space: the points `middle` + `right` cos θ + `up` sin θ.
#[derive(Clone, Copy, Debug)]
pub(super) struct Circle {
    pub(super) middle: DVec3,
    pub(super) right: DVec3,
    pub(super) up: DVec3,
}

impl Circle {
    /// The circle around a middle, across a unit vector.
    pub(super) fn across(middle: DVec3, axis: DVec3, radius: f64) -> Self {
        let (right, up) = axis.any_orthonormal_pair();
        Self {
            middle,
            right: right * radius,
            up: up * radius,
        }
    }

    /// The circle in which rays touch a ball that they begin outside of.
    pub(super) fn limb(ball: &Ball) -> Self {
        if ball.is_parallel() {
            return Self::across(ball.center, DVec3::Z, ball.radius);
        }
        let distance_sq = ball.center.length_squared();
        let share = ball.outside / distance_sq;
        let axis = ball.center * (1.0 / distance_sq.sqrt());
        Self::across(ball.center * share, axis, ball.radius * share.sqrt())
    }

    /// The circle in which rays meet a ball that touch a smaller one with the same center: at K / (√K' + √(r² − s²)) of
    /// unit rays, with the radii r and s, and K' of the smaller one.
    pub(super) fn outline(ball: &Ball, inside: &Ball) -> Self {
        let (radius, smaller) = (ball.radius, inside.radius);
        let half_chord = ((radius - smaller) * (radius + smaller)).sqrt();
        if ball.is_parallel() {
            return Self::across(ball.center - DVec3::Z * half_chord, DVec3::Z, smaller);
        }
        let distance = ball.center.length();
        let axis = ball.center * (1.0 / distance);
        let tangent = inside.outside.sqrt();
        let way = ball.outside / (tangent + half_chord);
        let along = way * tangent / distance;
        Self::across(axis * along, axis, way * smaller / distance)
    }

    /// The circle in which two balls meet.
    pub(super) fn seam(one: &Ball, other: &Ball) -> Option<Self> {
        let plane = SeamPlane::new(one, other);
        let radius_sq = plane.radius_sq();
        let middle = plane.small.center + plane.normal * plane.offset;
        (radius_sq > 0.0).then(|| Self::across(middle, plane.normal, radius_sq.sqrt()))
    }

    /// The circle in which a light grazes a ball, in this plane.
    pub(super) fn terminator(ball: &Ball, plane: &Plane) -> Self {
        if plane.offset == 0.0 {
            return Self::across(ball.center, plane.axis, ball.radius);
        }
        let middle = ball.center + plane.axis * plane.offset;
        let radius_sq = (ball.radius - plane.offset) * (ball.radius + plane.offset);
        Self::across(middle, plane.axis, radius_sq.max(0.0).sqrt())
    }

    /// The ways from the apex of a cone to the circle in which it touches a ball of this radius: all are as long as
    /// the root of the cone's power.
    pub(super) fn rim(cone: &Cone, radius: f64) -> Self {
        let distance_sq = cone.axis.length_squared();
        let share = cone.power / distance_sq;
        let unit = cone.axis / distance_sq.sqrt();
        Self::across(cone.axis * share, unit, radius * share.max(0.0).sqrt())
    }

    pub(super) fn at(&self, e: DVec2) -> DVec3 {
        self.middle + self.right * e.x + self.up * e.y
    }
}

/// Eight points of a curve.
#[derive(Clone, Copy, Debug)]
pub(super) struct Trace<S: Simd> {
    /// In space; of a side, on the plane of the retina at distance 1.
    pub(super) point: Vectors<S>,
    /// Their places in the cell.
    pub(super) x: f64x8<S>,
    pub(super) y: f64x8<S>,
    /// The derivatives of the place by the parameter.
    pub(super) dx: f64x8<S>,
    pub(super) dy: f64x8<S>,
}

#[inline(always)]
pub(super) fn on_circle<S: Simd>(
    simd: S,
    circle: &Circle,
    [cos, sin]: [f64x8<S>; 2],
) -> Vectors<S> {
    let right = Vectors::splat(simd, circle.right).times(cos);
    let up = Vectors::splat(simd, circle.up).times(sin);
    Vectors::splat(simd, circle.middle).plus(&right).plus(&up)
}

#[inline(always)]
pub(super) fn along_circle<S: Simd>(
    simd: S,
    circle: &Circle,
    [cos, sin]: [f64x8<S>; 2],
) -> Vectors<S> {
    let right = Vectors::splat(simd, circle.right).times(-sin);
    let up = Vectors::splat(simd, circle.up).times(cos);
    right.plus(&up)
}

/// The places of points that move by a step for the parameter.
#[inline(always)]
pub(super) fn placed<S: Simd>(cell: &Cell, point: Vectors<S>, step: Vectors<S>) -> Trace<S> {
    let (across, upward) = (1.0 / cell.size[0], 1.0 / cell.size[1]);
    if cell.is_parallel() {
        return Trace {
            point,
            x: (point.x - cell.middle.x) * across,
            y: (point.y - cell.middle.y) * upward,
            dx: step.x * across,
            dy: step.y * upward,
        };
    }
    let inverse = (point.x * 0.0 + 1.0) / point.z;
    let (u, v) = (point.x * inverse, point.y * inverse);
    Trace {
        point,
        x: (u - cell.middle.x) * across,
        y: (v - cell.middle.y) * upward,
        dx: (step.x - u * step.z) * inverse * across,
        dy: (step.y - v * step.z) * inverse * upward,
    }
}
