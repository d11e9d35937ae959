//! Edges that coincide, which crossings cannot tell apart.

use glam::DVec3;

use crate::edges::cell::{Ball, Cell};
use crate::edges::shadow::Caster;
use crate::edges::terminator::Plane;
use crate::exact::scene::{InCamera, Light};
use crate::model::camera::Projection;
use crate::numeric::pair::both;
use crate::numeric::rounding::UNIT_ROUNDOFF;

/// By how much contours differ, in the tangents of angles, that count as one: more than rounding.
pub(super) const ALIKE: f64 = 64.0 * UNIT_ROUNDOFF;

/// Returns whether two spheres that the eye is outside of have the same contour: crossings cannot tell which of
/// them is seen beside it. Of such spheres one is the other, closer to the eye by some factor.
pub(super) fn has_same_contour(one: &Ball, other: &Ball) -> bool {
    if one.outside <= 0.0 || other.outside <= 0.0 {
        return false;
    }
    if one.is_parallel() {
        let slack = ALIKE * (one.center.length() + other.center.length() + one.radius);
        let aside = (one.center - other.center).truncate();
        return (one.radius - other.radius).abs() <= slack && aside.length() <= slack;
    }
    let far = both([one, other], |ball| ball.center.length());
    let slack = ALIKE * far[0] * far[1];
    (one.radius * far[1] - other.radius * far[0]).abs() <= slack
        && (one.center * far[1] - other.center * far[0]).length() <= slack
}

/// The distance in a cell, on the retina at distance 1 or across parallel rays, the contour of a ball and another may be
/// that count as the same.
///
/// The sine of the angle of a contour, r / |c|, changes the angle by 1 / cos = |c| / √K times as much, and an angle moves a
/// ray that is |d| long by |d|² times as much at distance 1.
pub(super) fn contours_apart(cell: &Cell, ball: &Ball) -> f64 {
    let (extent, distance) = (cell.extent(), ball.center.length());
    ALIKE
        * match cell.projection {
            Projection::Central => extent * extent * (1.0 + distance / ball.outside.sqrt()),
            Projection::Parallel => extent + distance,
        }
}

/// Returns whether a sphere lies inside another one, or around it; none where neither holds.
///
/// The world's numbers tell: differences of doubles that are close to each other are exact, and in the camera's frame
/// they are all rounding.
pub(super) fn nesting(scene: &InCamera<'_>, one: usize, other: usize) -> Option<bool> {
    let [one, other] = both([one, other], |sphere| &scene.world.spheres()[sphere]);
    let apart = (one.center() - other.center()).length();
    let larger = other.radius() - one.radius();
    (apart <= larger.abs()).then_some(larger > 0.0)
}

/// Returns whether parallel rays go along the axis of a terminator in the middle of a sphere: then it is a contour, and
/// no edge of its own. Beside the contour it leaves less than the square of this of a radius.
pub(crate) fn is_contour(terminator: &Plane) -> bool {
    const ALONG: f64 = 1e-9;
    terminator.offset == 0.0 && terminator.axis.truncate().length_squared() < ALONG * ALONG
}

/// Returns whether parallel rays come from where a light is, but for rounding: then spheres hide their own shadows.
pub(super) fn is_at_eye(toward: DVec3) -> bool {
    const ALONG: f64 = 4e-15;
    toward.z < 0.0 && toward.truncate().length() < ALONG
}

/// The least distance toward a light, in radii, by which a sphere with the same contour is at least that hides all of
/// another one: what contours that differ by 10⁻¹² then leave lit is less than the square of 10⁻⁶. One that is closer to
/// the other may be as well behind it.
pub(super) const FARTHER: f64 = 1e-6;

/// Returns whether an occluder keeps a light from a ball whose contour it has, seen along the light: its shadow
/// ends where the ball's own dark side begins, which edges must not be left to tell.
pub(super) fn hides_all(ball: &Ball, center: DVec3, radius: f64, toward: DVec3) -> bool {
    /// The difference, in radii, of lengths that count as equal: more than rounding.
    const ALIKE: f64 = 1e-12;
    let offset = center - ball.center;
    let ahead = offset.dot(toward);
    let aside = (offset - toward * ahead).length();
    ahead > FARTHER * ball.radius
        && aside + (radius - ball.radius).abs() < ALIKE * (ball.radius + offset.length())
}

/// Returns whether the shadows of two casters have the same edge, but for rounding: crossings cannot tell on which side of
/// the other one each of them lies. The caster that is nearer to the light shades all that the other one shades.
pub(super) fn has_same_shadow(one: &Caster, other: &Caster) -> bool {
    let slack = ALIKE * (one.center.length() + other.center.length() + one.radius + other.radius);
    if let (Some(cone), Some(other_cone)) = (&one.cone, &other.cone) {
        let [near, far] = both([cone, other_cone], |cone| cone.axis.length());
        let slack = slack * near.max(far);
        return (one.radius * far - other.radius * near).abs() <= slack
            && (cone.axis * far - other_cone.axis * near).length() <= slack;
    }
    let apart = other.center - one.center;
    (other.radius - one.radius).abs() <= slack
        && apart.dot(one.right).abs() <= slack
        && apart.dot(one.up).abs() <= slack
}

/// Returns whether a caster is nearer to a light than another one with the same shadow.
pub(super) fn is_nearer(one: &Caster, other: &Caster, light: &Light) -> bool {
    match (&one.cone, &other.cone) {
        (Some(one), Some(other)) => one.axis.length_squared() < other.axis.length_squared(),
        _ => (one.center - other.center).dot(light.toward) > 0.0,
    }
}
