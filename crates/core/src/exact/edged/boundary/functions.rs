//! Functions along curves that change their signs at events.

use fearless_simd::Simd;

use super::circle::Trace;
use super::primitive::ray;
use super::setting::Setting;
use crate::edges::cell::Ball;
use crate::edges::terminator::Plane;
use crate::exact::classify::face::Face;
use crate::exact::points::Points;
use crate::numeric::lanes::{f64x8, mask64x8};
use crate::numeric::polynomial::Quadratic;
use crate::numeric::vectors::Vectors;

/// A function that changes its sign at an event.
#[derive(Clone, Copy, Debug)]
pub(super) enum Function {
    /// The discriminant of an active sphere.
    Contour(usize),
    /// The polynomial of an edge.
    Conic(usize),
    /// The contour inside of which an active sphere's outline is not seen.
    Outline(usize),
    /// On which side of an active sphere on which they lie points lie.
    Facing(usize),
    /// The height of points above the middle of a caster, toward a light.
    Above(usize, usize),
    /// Whether points lie inside an active sphere.
    Inside(usize),
    /// The distance of points from the plane through the eye and a side of the cell, across an axis.
    Across(usize, f64),
    /// The slope of the curve itself in the cell.
    Rise,
    /// The cosine toward a light on the visible part of an active sphere.
    Lit(usize, usize),
    /// How far that part lies ahead of the plane of the cutoff of a light.
    Ahead(usize, usize),
    /// The depth of that part in the disc of a caster.
    Shaded(usize, usize),
}

/// The values of a polynomial.
#[inline(always)]
pub(super) fn polynomial<S: Simd>(q: &Quadratic, x: f64x8<S>, y: f64x8<S>) -> f64x8<S> {
    (x * q.xx + y * q.xy + q.x) * x + (y * q.yy + q.y) * y + q.one
}

/// The values of a function at some places.
#[inline(never)]
pub(super) fn value<S: Simd>(
    simd: S,
    setting: &Setting<'_, '_>,
    function: Function,
    places: &Trace<S>,
) -> f64x8<S> {
    simd.vectorize(
        #[inline(always)]
        || {
            let contents = setting.contents;
            match function {
                Function::Contour(sphere) => {
                    polynomial(&contents.active[sphere].discriminant, places.x, places.y)
                }
                Function::Conic(index) => polynomial(&contents.conics[index].1, places.x, places.y),
                Function::Outline(sphere) => match contents.face(sphere) {
                    Face::Inside(_, conic) => polynomial(conic, places.x, places.y),
                    Face::All => f64x8::splat(simd, 1.0),
                    Face::Nothing => f64x8::splat(simd, -1.0),
                },
                Function::Facing(sphere) => {
                    let ball = &contents.active[sphere].ball;
                    if ball.is_parallel() {
                        // From inside, the far side is seen.
                        let side = if ball.outside > 0.0 { -1.0 } else { 1.0 };
                        (places.point.z - ball.center.z) * side
                    } else if ball.outside > 0.0 {
                        places.point.dot_one(ball.center) - places.point.length_squared()
                    } else {
                        // From inside, all of it is seen.
                        f64x8::splat(simd, 1.0)
                    }
                }
                Function::Above(light, caster) => {
                    let caster = &contents.occluders[caster];
                    if let Some(cone) = &caster.cone {
                        let apex = Vectors::splat(simd, cone.apex);
                        let beyond = places.point.minus(&apex).dot_one(cone.axis);
                        return f64x8::splat(simd, cone.power) - beyond;
                    }
                    let toward = setting.scene.lights[light].toward;
                    places.point.dot_one(toward) - caster.center.dot(toward)
                }
                Function::Inside(sphere) => {
                    let ball = &contents.active[sphere].ball;
                    if ball.is_apart() {
                        let from = places.point.minus(&Vectors::splat(simd, ball.center));
                        from.length_squared() - ball.radius * ball.radius
                    } else {
                        let point = &places.point;
                        point.length_squared() - point.dot_one(2.0 * ball.center) + ball.power
                    }
                }
                Function::Across(axis, side) => {
                    let edge = setting.cell.middle[axis] + side * setting.cell.size[axis];
                    if setting.cell.is_parallel() {
                        places.point.along(axis) - edge
                    } else {
                        places.point.along(axis) - places.point.z * edge
                    }
                }
                Function::Rise => places.dy,
                Function::Lit(sphere, light) => {
                    let ball = &contents.active[sphere].ball;
                    let points =
                        Points::new(simd, ball, ray(simd, setting.cell, places.x, places.y));
                    let active = &contents.active[sphere];
                    match active.terminators.plane(setting.scene, ball, light) {
                        Some(plane) => facing(&plane, ball, &points.normal),
                        None => f64x8::splat(simd, 1.0),
                    }
                }
                Function::Ahead(sphere, light) => {
                    let ball = &contents.active[sphere].ball;
                    let points =
                        Points::new(simd, ball, ray(simd, setting.cell, places.x, places.y));
                    match setting.scene.lights[light].cutoff(ball) {
                        Some(plane) => ahead(&plane, setting, (sphere, light), &points),
                        None => f64x8::splat(simd, 1.0),
                    }
                }
                Function::Shaded(sphere, caster) => {
                    let ball = &contents.active[sphere].ball;
                    let points =
                        Points::new(simd, ball, ray(simd, setting.cell, places.x, places.y));
                    in_disc(simd, setting, caster, &points.place())
                }
            }
        },
    )
}

/// The square of the distance of points from the middle of a caster, seen along its light, less that
/// of its radius; of points from a cone, a function that vanishes on it and is negative inside.
#[inline(always)]
pub(super) fn in_disc<S: Simd>(
    simd: S,
    setting: &Setting<'_, '_>,
    caster: usize,
    place: &Vectors<S>,
) -> f64x8<S> {
    let caster = &setting.contents.occluders[caster];
    if let Some(cone) = &caster.cone {
        let from_apex = place.minus(&Vectors::splat(simd, cone.apex));
        let along = from_apex.dot_one(cone.axis);
        return from_apex.length_squared() * cone.power - along * along;
    }
    let from = place.minus(&Vectors::splat(simd, caster.center));
    let (right, up) = (from.dot_one(caster.right), from.dot_one(caster.up));
    right * right + up * up - caster.radius * caster.radius
}

/// The places that lie beyond a caster, away from its light.
#[inline(always)]
pub(super) fn is_beyond<S: Simd>(
    simd: S,
    setting: &Setting<'_, '_>,
    (light, caster): (usize, usize),
    place: &Vectors<S>,
) -> mask64x8<S> {
    let caster = &setting.contents.occluders[caster];
    match &caster.cone {
        Some(cone) => {
            let from_apex = place.minus(&Vectors::splat(simd, cone.apex));
            from_apex.dot_one(cone.axis).simd_gt(cone.power)
        }
        None => {
            let toward = setting.scene.lights[light].toward;
            let top = caster.center.dot(toward);
            place.dot_one(toward).simd_lt(top)
        }
    }
}

/// The distance of a ball's normals on the lit side of the plane of a terminator: the cosine of the angle to a
/// directional light.
#[inline(always)]
pub(super) fn facing<S: Simd>(plane: &Plane, ball: &Ball, normal: &Vectors<S>) -> f64x8<S> {
    let facing = normal.dot_one(plane.axis);
    if plane.offset == 0.0 {
        facing
    } else {
        facing - plane.offset / ball.radius
    }
}

/// How far points of an active sphere lie ahead of the plane of the cutoff of a light, in its radii.
#[inline(always)]
pub(super) fn ahead<S: Simd>(
    plane: &Plane,
    setting: &Setting<'_, '_>,
    (sphere, light): (usize, usize),
    points: &Points<S>,
) -> f64x8<S> {
    let ball = &setting.contents.active[sphere].ball;
    match &setting.scene.lights[light].near {
        // Near a large sphere the distance from its center would be all rounding.
        Some(near) if !ball.is_apart() => {
            let lamp = Vectors::splat(points.ray.x.simd(), near.position);
            points.place().minus(&lamp).dot_one(plane.axis) * (1.0 / ball.radius)
        }
        _ => facing(plane, ball, &points.normal),
    }
}
