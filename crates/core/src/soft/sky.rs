//! A sky, and the part of its light that reaches a point.

use super::bodies::Bodies;
use super::cap::Cap;
use super::point::{Occluders, SurfacePoint};
use super::visible::{Hidden, sky_share};
use crate::model::color::Color;
use crate::model::sky::Sky;
use crate::patches::patch::Shares;
use crate::search::beyond::Beyond;

/// The light that a white matte surface reflects.
pub(crate) fn light_of(sky: &Sky, shares: Shares) -> Color {
    sky.below * shares.x + sky.above * shares.y
}

/// The light of a sky that a white matte surface at a point reflects.
pub(crate) fn sky_light(
    sky: &Sky,
    point: &SurfacePoint,
    occluders: Option<&Occluders<'_>>,
    hidden: &mut Hidden,
) -> Color {
    let mut bodies = Bodies::default();
    if let Some(occluders) = occluders {
        let above = Beyond::Plane {
            point: point.position,
            normal: point.normal,
            lowered: 0.0,
        };
        occluders.for_each_sphere(point.sphere, &above, |sphere| bodies.push(sphere));
    }
    light_of(sky, shares(sky, point, &bodies, hidden))
}

/// The light that reaches a point which only some spheres hide.
pub(crate) fn shares(
    sky: &Sky,
    point: &SurfacePoint,
    bodies: &Bodies,
    hidden: &mut Hidden,
) -> Shares {
    hidden.clear();
    hidden.add_bodies(bodies, point);
    add_horizons(point, hidden);
    hidden.leave_out_contained();
    let count = hidden.len();
    let share = sky_share(hidden.seen(), point.shading);
    if sky.above == sky.below {
        return Shares::new(share, 0.0);
    }
    hidden.truncate(count);
    hidden.add(Cap::below(sky.up));
    hidden.leave_out_contained();
    let above = sky_share(hidden.seen(), point.shading).min(share);
    Shares::new(share - above, above)
}

/// Hides what lies below the surface, and what lies below the plane across the shading normal of a bump.
pub(super) fn add_horizons(point: &SurfacePoint, hidden: &mut Hidden) {
    hidden.add(Cap::below(point.normal));
    if point.shading != point.normal {
        hidden.add(Cap::below(point.shading));
    }
}
