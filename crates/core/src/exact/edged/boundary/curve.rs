//! Curves on which what is seen changes, and points of them.

use fearless_simd::Simd;
use glam::{DVec2, DVec3};

use crate::edges::cell::{Ball, Cell};
use crate::edges::seam::SeamPlane;
use crate::edges::shadow::{Caster, Cone};
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
    fn across(middle: DVec3, axis: DVec3, radius: f64) -> Self {
        let (right, up) = axis.any_orthonormal_pair();
        Self {
            middle,
            right: right * radius,
            up: up * radius,
        }
    }

    /// Where the rays touch a ball that they begin outside of.
    pub(super) fn limb(ball: &Ball) -> Self {
        if ball.is_parallel() {
            return Self::across(ball.center, DVec3::Z, ball.radius);
        }
        let distance_sq = ball.center.length_squared();
        let share = ball.outside / distance_sq;
        let axis = ball.center * (1.0 / distance_sq.sqrt());
        Self::across(ball.center * share, axis, ball.radius * share.sqrt())
    }

    /// Where rays meet a ball that touch a smaller one with the same center: at K / (√K' + √(r² − s²)) of unit rays,
    /// with the radii r and s, and K' of the smaller one.
    pub(super) fn stroke(ball: &Ball, inside: &Ball) -> Self {
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

    /// Where two balls meet.
    pub(super) fn seam(one: &Ball, other: &Ball) -> Option<Self> {
        let plane = SeamPlane::new(one, other);
        let radius_sq = plane.radius_sq();
        let middle = plane.small.center + plane.normal * plane.offset;
        (radius_sq > 0.0).then(|| Self::across(middle, plane.normal, radius_sq.sqrt()))
    }

    /// Where a light grazes a ball, in this plane.
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
    fn rim(cone: &Cone, radius: f64) -> Self {
        let distance_sq = cone.axis.length_squared();
        let share = cone.power / distance_sq;
        let unit = cone.axis / distance_sq.sqrt();
        Self::across(cone.axis * share, unit, radius * share.max(0.0).sqrt())
    }

    pub(super) fn at(&self, e: DVec2) -> DVec3 {
        self.middle + self.right * e.x + self.up * e.y
    }
}

/// What a curve is.
#[derive(Clone, Copy, Debug)]
pub(super) enum Shape {
    /// An upright side of the cell, at this x.
    Side(f64),
    Circle(Circle),
    /// The edge of the shadow of a caster on a ball: the circle is that of the caster across the
    /// light, seen from the ball's center, without its height.
    Shadow {
        circle: Circle,
        center: DVec3,
        radius_sq: f64,
        toward: DVec3,
        /// 1 on the side of the ball toward the light, -1 on the other one.
        side: f64,
    },
    /// The same on a ball that the eye is nearer to than its radius.
    NearShadow(NearShadow),
    /// The edge of the shadow on a ball that a cone from a point light makes.
    Cone {
        cone: Cone,
        /// The ways from the apex along the cone.
        rim: Circle,
        /// The ball's center, and the way there from the apex.
        center: DVec3,
        to_center: DVec3,
        /// The square of the way from the apex to where it touches the ball.
        outside: f64,
        /// 1 where the ways enter the ball, -1 where they leave it.
        side: f64,
    },
}

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
    fn new(ball: &Ball, caster: &Caster, (toward, side): (DVec3, f64), beside: DVec3) -> Self {
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
    fn trace<S: Simd>(
        &self,
        simd: S,
        cell: &Cell,
        (e, turn): ([f64x8<S>; 2], f64x8<S>),
    ) -> Trace<S> {
        let [one, by_cos, by_sin] = self.height;
        let [cos, sin] = e;
        let zero = f64x8::splat(simd, 0.0);
        let height = cos * by_cos + sin * by_sin + one;
        let change = (cos * by_sin - sin * by_cos) * turn;
        let (rise, radius, side) = (self.rise, self.radius, self.side);
        let root = (height * (-2.0 / radius) + rise * rise).max(zero).sqrt();
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

impl Shape {
    /// Of the shadow's edge near a point that is seen of the ball.
    pub(super) fn shadow(
        ball: &Ball,
        caster: &Caster,
        (toward, side): (DVec3, f64),
        beside: DVec3,
    ) -> Self {
        if let Some(cone) = caster.cone {
            return Self::Cone {
                cone,
                rim: Circle::rim(&cone, caster.radius),
                center: ball.center,
                to_center: ball.center - cone.apex,
                outside: ball.power_of(cone.apex),
                side,
            };
        }
        if !ball.is_apart() {
            return Self::NearShadow(NearShadow::new(ball, caster, (toward, side), beside));
        }
        let offset = caster.center - ball.center;
        Self::Shadow {
            circle: Circle {
                middle: offset - toward * offset.dot(toward),
                right: caster.right * caster.radius,
                up: caster.up * caster.radius,
            },
            center: ball.center,
            radius_sq: ball.radius * ball.radius,
            toward,
            side,
        }
    }
}

/// A part of a curve: between two unit vectors (cos θ, sin θ), by less than half a turn; of a side,
/// between two y, which are the second components.
#[derive(Clone, Copy, Debug)]
pub(super) struct Piece {
    pub(super) ends: [DVec2; 2],
    /// Whether the curve turns back at an end, where places go with the root of the angle.
    pub(super) roots: [bool; 2],
}

/// Eight points of a curve.
#[derive(Clone, Copy, Debug)]
pub(super) struct Trace<S: Simd> {
    /// In space; of a side, on the plane of the retina at distance 1.
    pub(super) point: Vectors<S>,
    /// Where they are seen in the cell.
    pub(super) x: f64x8<S>,
    pub(super) y: f64x8<S>,
    /// How the place changes with the parameter.
    pub(super) dx: f64x8<S>,
    pub(super) dy: f64x8<S>,
}

/// The points of a piece with these parameters, from 0 to 1.
#[inline(never)]
pub(super) fn trace<S: Simd>(
    simd: S,
    cell: &Cell,
    shape: &Shape,
    piece: &Piece,
    s: f64x8<S>,
) -> Trace<S> {
    simd.vectorize(
        #[inline(always)]
        || {
            let zero = f64x8::splat(simd, 0.0);
            let one = f64x8::splat(simd, 1.0);
            let [start, end] = piece.ends;
            match shape {
                Shape::Side(x) => {
                    let x = f64x8::splat(simd, *x);
                    let y = s * (end.y - start.y) + start.y;
                    Trace {
                        point: Vectors {
                            x: x * cell.size[0] + cell.middle.x,
                            y: y * cell.size[1] + cell.middle.y,
                            z: one,
                        },
                        x,
                        y,
                        dx: zero,
                        dy: one * (end.y - start.y),
                    }
                }
                Shape::Circle(circle) => {
                    let (e, turn) = turned(start, end, s);
                    let point = on_circle(simd, circle, e);
                    let step = along_circle(simd, circle, e).times(turn);
                    placed(cell, point, step)
                }
                Shape::Shadow {
                    circle,
                    center,
                    radius_sq,
                    toward,
                    side,
                } => {
                    let (s, slope) = warped(piece.roots, s);
                    let (e, turn) = turned(start, end, s);
                    let turn = turn * slope;
                    let aside = on_circle(simd, circle, e);
                    let step = along_circle(simd, circle, e).times(turn);
                    let rest = (one * *radius_sq - aside.length_squared()).max(zero);
                    let height = rest.sqrt();
                    let inverse = one * *side / height.max(one * 1e-150);
                    let toward = Vectors::splat(simd, *toward);
                    let point = aside
                        .plus(&Vectors::splat(simd, *center))
                        .plus(&toward.times(height * *side));
                    let rise = -(aside.dot(&step)) * inverse;
                    let step = step.plus(&toward.times(rise));
                    placed(cell, point, step)
                }
                Shape::NearShadow(shadow) => {
                    let (s, slope) = warped(piece.roots, s);
                    let (e, turn) = turned(start, end, s);
                    shadow.trace(simd, cell, (e, turn * slope))
                }
                Shape::Cone {
                    cone,
                    rim,
                    to_center,
                    outside,
                    side,
                    ..
                } => {
                    let (s, slope) = warped(piece.roots, s);
                    let (e, turn) = turned(start, end, s);
                    let turn = turn * slope;
                    let way = on_circle(simd, rim, e);
                    let way_step = along_circle(simd, rim, e).times(turn);
                    // t = K / (h + √q) where it enters, with h = w · a and q = h² − |w|² K.
                    let way_sq = way.length_squared();
                    let half = way.dot_one(*to_center);
                    let rest = (half * half - way_sq * *outside).max(zero);
                    let root = rest.sqrt();
                    let t = if *side > 0.0 {
                        one * *outside / (half + root)
                    } else {
                        (half + root) / way_sq
                    };
                    let inverse = one * *side / root.max(one * 1e-150);
                    let change = -(way_step.dot_one(*to_center) * t * inverse);
                    let point = way.times(t).plus(&Vectors::splat(simd, cone.apex));
                    let step = way_step.times(t).plus(&way.times(change));
                    placed(cell, point, step)
                }
            }
        },
    )
}

/// A parameter in which places are smooth that go with the root of the distance to an end, and how fast
/// the former changes.
#[inline(always)]
pub(super) fn warped<S: Simd>(roots: [bool; 2], s: f64x8<S>) -> (f64x8<S>, f64x8<S>) {
    let one = s * 0.0 + 1.0;
    match roots {
        [false, false] => (s, one),
        [true, false] => (s * s, s * 2.0),
        [false, true] => (s * (2.0 - s), 2.0 - s * 2.0),
        [true, true] => (s * s * (3.0 - s * 2.0), s * (one - s) * 6.0),
    }
}

/// The unit vectors between two, and how fast they turn.
#[inline(always)]
fn turned<S: Simd>(start: DVec2, end: DVec2, s: f64x8<S>) -> ([f64x8<S>; 2], f64x8<S>) {
    let x = s * (end.x - start.x) + start.x;
    let y = s * (end.y - start.y) + start.y;
    let inverse_sq = (x * 0.0 + 1.0) / (x * x + y * y);
    let inverse = inverse_sq.sqrt();
    let cross = start.x * end.y - start.y * end.x;
    ([x * inverse, y * inverse], inverse_sq * cross)
}

#[inline(always)]
fn on_circle<S: Simd>(simd: S, circle: &Circle, [cos, sin]: [f64x8<S>; 2]) -> Vectors<S> {
    let right = Vectors::splat(simd, circle.right).times(cos);
    let up = Vectors::splat(simd, circle.up).times(sin);
    Vectors::splat(simd, circle.middle).plus(&right).plus(&up)
}

#[inline(always)]
fn along_circle<S: Simd>(simd: S, circle: &Circle, [cos, sin]: [f64x8<S>; 2]) -> Vectors<S> {
    let right = Vectors::splat(simd, circle.right).times(-sin);
    let up = Vectors::splat(simd, circle.up).times(cos);
    right.plus(&up)
}

#[inline(always)]
fn placed<S: Simd>(cell: &Cell, point: Vectors<S>, step: Vectors<S>) -> Trace<S> {
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
