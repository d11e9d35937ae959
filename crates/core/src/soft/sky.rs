//! A sky, and the part of its light that reaches a point.

use std::f64::consts::PI;

use glam::DVec3;

use super::bodies::Bodies;
use super::cap::{Cap, NO_SPHERE};
use super::gather::{Neighborhood, gather};
use super::point::{Occluders, SurfacePoint};
use super::visible::{CapSlope, Hidden, sky_share};
use crate::model::color::Color;
use crate::model::sky::Sky;
use crate::patches::light::Shares;

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
        let place = Neighborhood {
            middle: point.position,
            around: 0.0,
            normal: point.normal,
            turn: 0.0,
        };
        for index in gather(occluders, point.sphere, &place) {
            bodies.push(&occluders.spheres[index as usize], NO_SPHERE);
        }
    }
    let reached = reached(sky, point, &bodies, hidden, &mut |_| {});
    light_of(sky, reached.shares)
}

/// The light that reaches a point, by the halves of the sky, and its derivatives.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Reached {
    pub(crate) shares: Shares,
    /// The derivatives of both shares by the shading normal.
    pub(crate) by_normal: [DVec3; 2],
}

/// How both shares change with the cap of a sphere: with the cosine of its angle, by the first and the second derivative, and
/// with its axis.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ShareSlope {
    pub(crate) cap: Cap,
    pub(crate) by_cosine: Shares,
    pub(crate) twice_by_cosine: Shares,
    pub(crate) by_axis: [DVec3; 2],
}

/// The light that reaches a point which only some spheres hide. Calls `visit` for the caps whose circles are visible.
pub(crate) fn reached(
    sky: &Sky,
    point: &SurfacePoint,
    bodies: &Bodies,
    hidden: &mut Hidden,
    visit: &mut dyn FnMut(&ShareSlope),
) -> Reached {
    hidden.clear();
    add_horizons(point, hidden);
    hidden.add_bodies(bodies, point);
    let count = hidden.len();
    let normal = point.shading / PI;
    let whole = hidden.seen(normal);
    let share = sky_share(whole, point.shading);
    if sky.above == sky.below {
        for slope in hidden.slopes() {
            visit(&ShareSlope {
                cap: slope.cap,
                by_cosine: Shares::new(slope.by_cosine, 0.0),
                twice_by_cosine: Shares::new(slope.twice_by_cosine, 0.0),
                by_axis: [slope.by_axis, DVec3::ZERO],
            });
        }
        return Reached {
            shares: Shares::new(share, 0.0),
            by_normal: [whole / PI, DVec3::ZERO],
        };
    }
    let slopes = hidden.slopes().to_vec();
    hidden.truncate(count);
    hidden.add(Cap::below(sky.up));
    let upper = hidden.seen(normal);
    let above = sky_share(upper, point.shading).min(share);
    for slope in slopes {
        let is_same = |other: &&CapSlope| other.cap.sphere == slope.cap.sphere;
        let above = hidden.slopes().iter().find(is_same);
        let halves = |of: &dyn Fn(&CapSlope) -> f64| {
            let above = above.map_or(0.0, of);
            Shares::new(of(&slope) - above, above)
        };
        let by_axis = above.map_or(DVec3::ZERO, |above| above.by_axis);
        visit(&ShareSlope {
            cap: slope.cap,
            by_cosine: halves(&|slope| slope.by_cosine),
            twice_by_cosine: halves(&|slope| slope.twice_by_cosine),
            by_axis: [slope.by_axis - by_axis, by_axis],
        });
    }
    Reached {
        shares: Shares::new(share - above, above),
        by_normal: [(whole - upper) / PI, upper / PI],
    }
}

/// Hides what lies below the surface, and what lies below the plane across the shading normal of a bump.
pub(super) fn add_horizons(point: &SurfacePoint, hidden: &mut Hidden) {
    hidden.add(Cap::below(point.normal));
    if point.shading != point.normal {
        hidden.add(Cap::below(point.shading));
    }
}
