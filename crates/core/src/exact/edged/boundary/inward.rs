//! The sides of curves on which their spheres, or the lit parts of these, lie.

use fearless_simd::Simd;
use glam::DVec3;

use super::circle::Trace;
use super::curve::Shape;
use super::setting::{Curve, Edge};
use crate::edges::cell::Cell;
use crate::exact::classify::contents::Contents;
use crate::exact::edged::rule::MIDDLE;
use crate::exact::scene::InCamera;
use crate::model::camera::Projection;
use crate::numeric::pair::both;

/// 1 where the inner side lies to the left of a curve, -1 to its right.
#[inline(always)]
pub(super) fn sign<S: Simd>(
    (scene, cell): (&InCamera<'_>, &Cell),
    contents: &Contents,
    curve: &Curve,
    places: &Trace<S>,
) -> f64 {
    let point = DVec3::new(
        places.point.x[MIDDLE],
        places.point.y[MIDDLE],
        places.point.z[MIDDLE],
    );
    let inward = match (curve.edge, &curve.shape) {
        (Edge::Left, _) => return -1.0,
        (Edge::Right, _) => return 1.0,
        (Edge::Limb | Edge::Outline, _) => {
            let ball = &contents.active[curve.own[0]].ball;
            if ball.is_parallel() {
                ball.center - point
            } else {
                ball.center
            }
        }
        (Edge::Seam, Shape::Circle(circle)) => {
            let [one, other] = both(curve.own, |own| contents.active[own].ball.center);
            let axis = one - other;
            let along = axis.cross(point - circle.middle);
            let across = (point - one).cross(along);
            // An eye inside the other sphere sees what of this one lies in there.
            let is_inside = contents.active[curve.own[1]].ball.outside <= 0.0;
            let factor = if is_inside { -1.0 } else { 1.0 };
            across * (factor * across.dot(axis).signum())
        }
        (Edge::Terminator(light), _) => {
            let terminators = &contents.active[curve.own[0]].terminators;
            let ball = &contents.active[curve.own[0]].ball;
            match (
                &scene.lights[light].near,
                terminators.plane(scene, ball, light),
            ) {
                // It grazes the surface there.
                (Some(near), _) => near.position - point,
                (None, Some(plane)) => plane.axis,
                (None, None) => return 0.0,
            }
        }
        (Edge::Cutoff(light), _) => {
            let ball = &contents.active[curve.own[0]].ball;
            let Some(plane) = scene.lights[light].cutoff(ball) else {
                return 0.0;
            };
            let normal = (point - ball.center).normalize();
            plane.axis - normal * normal.dot(plane.axis)
        }
        (
            Edge::Shadow(..),
            Shape::Shadow {
                circle,
                center,
                toward,
                ..
            },
        ) => {
            let from_center = point - *center;
            let height = from_center.dot(*toward);
            let aside = from_center - *toward * height;
            let away = aside - circle.middle;
            away - *toward * (aside.dot(away) / height)
        }
        (Edge::Shadow(..), Shape::NearShadow(shadow)) => {
            let toward = shadow.toward;
            let away = point - shadow.circle.middle;
            let away = away - toward * away.dot(toward);
            let normal = point - shadow.center;
            away - toward * (normal.dot(away) / normal.dot(toward))
        }
        (Edge::Shadow(..), Shape::Cone { cone, center, .. }) => {
            // The slope of what vanishes on the cone, along the surface.
            let from_apex = point - cone.apex;
            let slope = from_apex * cone.power - cone.axis * from_apex.dot(cone.axis);
            let normal = (point - *center).normalize();
            slope - normal * normal.dot(slope)
        }
        _ => return 0.0,
    };
    let (mut x, mut y) = (inward.x, inward.y);
    if scene.projection == Projection::Central {
        x = inward.x * point.z - point.x * inward.z;
        y = inward.y * point.z - point.y * inward.z;
    }
    // Steps are in sides of the cell.
    let [width, height] = cell.size;
    (places.dx[MIDDLE] * y - places.dy[MIDDLE] * (height / width) * x).signum()
}
