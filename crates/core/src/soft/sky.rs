//! A sky, and the part of its light that reaches a point.

use std::f64::consts::PI;

use glam::DVec3;

use super::bodies::Bodies;
use super::cap::{Cap, NO_SPHERE};
use super::point::{Occluders, SurfacePoint};
use super::visible::{Hidden, sky_share};
use crate::model::color::Color;
use crate::model::sky::Sky;
use crate::patches::light::Shares;
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
        occluders.for_each_sphere(point.sphere, &above, |sphere| {
            bodies.push(sphere, NO_SPHERE);
        });
    }
    light_of(sky, shares(sky, point, &bodies, hidden, &mut |_, _| {}))
}

/// The light that reaches a point which only some spheres hide. Calls `visit` with the spheres whose circles are visible, and
/// how the light changes with the cosines of their angles.
pub(crate) fn shares(
    sky: &Sky,
    point: &SurfacePoint,
    bodies: &Bodies,
    hidden: &mut Hidden,
    visit: &mut dyn FnMut(u32, Shares),
) -> Shares {
    hidden.clear();
    add_horizons(point, hidden);
    hidden.add_bodies(bodies, point);
    let count = hidden.len();
    let share = sky_share(hidden.seen(), point.shading);
    let slope = |by_cosine: DVec3| by_cosine.dot(point.shading) / PI;
    if sky.above == sky.below {
        for &(sphere, by_cosine) in hidden.slopes() {
            visit(sphere, Shares::new(slope(by_cosine), 0.0));
        }
        return Shares::new(share, 0.0);
    }
    let slopes = hidden.slopes().to_vec();
    hidden.truncate(count);
    hidden.add(Cap::below(sky.up));
    let above = sky_share(hidden.seen(), point.shading).min(share);
    for (sphere, by_cosine) in slopes {
        let same = hidden.slopes().iter().find(|(other, _)| *other == sphere);
        let above = same.map_or(0.0, |(_, by_cosine)| slope(*by_cosine));
        visit(sphere, Shares::new(slope(by_cosine) - above, above));
    }
    Shares::new(share - above, above)
}

/// Hides what lies below the surface, and what lies below the plane across the shading normal of a bump.
pub(super) fn add_horizons(point: &SurfacePoint, hidden: &mut Hidden) {
    hidden.add(Cap::below(point.normal));
    if point.shading != point.normal {
        hidden.add(Cap::below(point.shading));
    }
}
