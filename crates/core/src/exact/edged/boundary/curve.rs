//! Curves on which what is seen changes, and points of them.

use fearless_simd::Simd;
use glam::{DVec2, DVec3};

use super::circle::{Circle, Trace, along_circle, on_circle, placed};
use super::near_shadow::NearShadow;
use super::piece::{Piece, from_ends};
use crate::edges::cell::{Ball, Cell};
use crate::edges::shadow::{Caster, Cone};
use crate::numeric::lanes::f64x8;
use crate::numeric::vectors::Vectors;

/// The shape of a curve.
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

impl Shape {
    /// The shape of the shadow's edge near a visible point of the ball.
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
                    let rest = if piece.roots == [false; 2] {
                        one * *radius_sq - aside.length_squared()
                    } else {
                        let by_cos = -2.0 * circle.right.dot(circle.middle);
                        let by_sin = -2.0 * circle.up.dot(circle.middle);
                        from_ends(piece, s, e, [0.0, by_cos, by_sin])
                    };
                    let height = rest.max(zero).sqrt();
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
                    shadow.trace(simd, cell, (piece, s), (e, turn * slope))
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
                    let rest = if piece.roots == [false; 2] || *outside <= 0.0 {
                        half * half - way_sq * *outside
                    } else {
                        // h − |w| √K vanishes where it turns back; |w| is the same on all of the rim.
                        let by_cos = rim.right.dot(*to_center);
                        let by_sin = rim.up.dot(*to_center);
                        let tangent = (way_sq * *outside).sqrt();
                        from_ends(piece, s, e, [0.0, by_cos, by_sin]) * (half + tangent)
                    };
                    let root = rest.max(zero).sqrt();
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
