//! Numbers without a pattern, yet arbitrarily close to a tangent or to the surface.
//!
//! One coordinate of the origin is 0 at first. A tiny number in its place tunes the case far more finely than the other
//! numbers could.

use glam::DVec3;
use marbles_core::{Ray, Sphere};

use super::super::judge;
use super::{Draft, Random};

/// The distance from a tangent or from the surface: from within the reach of the first kind of arithmetic to beyond
/// that of the second.
fn gap(random: &mut Random) -> f64 {
    random.sign() * random.power_of_two(-110, -20) * random.between(1.0, 2.0)
}

/// K and Q / A of a draft.
fn powers(draft: Draft) -> (f64, f64) {
    let (origin, direction) = (draft.origin, draft.direction);
    let sphere = Sphere::new(draft.center, draft.radius).expect("ordinary numbers");
    judge::powers(&sphere, &Ray { origin, direction })
}

fn seen_from_zero(random: &mut Random) -> Draft {
    Draft {
        origin: DVec3::ZERO,
        direction: random.unit_vector() * random.magnitude(0.1, 10.0),
        center: random.in_cube(10.0),
        radius: random.magnitude(0.1, 10.0),
    }
}

/// Grazing rays: Q / A changes by twice the perpendicular's components.
pub(super) fn grazing(random: &mut Random) -> Draft {
    let mut draft = seen_from_zero(random);
    let perpendicular = draft.center.reject_from(draft.direction);
    draft.radius = perpendicular.length();
    let axis = perpendicular.abs().max_position();
    let wanted = gap(random) * draft.radius * draft.radius;
    draft.origin[axis] = (wanted - powers(draft).1) / (2.0 * perpendicular[axis]);
    draft
}

/// Origins near the surface: K changes by twice the center's components, the other way.
pub(super) fn near_surface(random: &mut Random) -> Draft {
    let mut draft = seen_from_zero(random);
    draft.radius = draft.center.length();
    let axis = draft.center.abs().max_position();
    let wanted = gap(random) * draft.radius * draft.radius;
    draft.origin[axis] = (powers(draft).0 - wanted) / (2.0 * draft.center[axis]);
    draft
}

/// Grazing rays that begin near the point of contact, and thus also near the surface.
pub(super) fn both(random: &mut Random) -> Draft {
    let mut draft = seen_from_zero(random);
    let along = draft.direction.cross(draft.center);
    draft.direction = along + draft.center * (random.sign() * random.magnitude(1e-20, 1e-2));
    draft.radius = draft.center.length();
    let axis = draft.center.abs().max_position();
    let wanted = gap(random) * draft.radius * draft.radius;
    draft.origin[axis] = (powers(draft).0 - wanted) / (2.0 * draft.center[axis]);
    draft
}
