//! A sky, and the part of its light that reaches a point.

use super::cap::Cap;
use super::point::{Occluders, SurfacePoint};
use super::visible::{Hidden, sky_share};
use crate::model::color::Color;
use crate::model::sky::Sky;
use crate::search::beyond::Beyond;

/// The light of a sky that a white matte surface at a point reflects.
pub(crate) fn sky_light(
    sky: &Sky,
    point: &SurfacePoint,
    occluders: Option<&Occluders<'_>>,
    hidden: &mut Hidden,
) -> Color {
    hidden.clear();
    if let Some(occluders) = occluders {
        let above = Beyond::Plane {
            point: point.position,
            normal: point.normal,
            lowered: 0.0,
        };
        occluders.for_each(point, &above, |cap| {
            if cap.axis.dot(point.normal) > -cap.sine && cap.axis.dot(point.shading) > -cap.sine {
                hidden.add(cap);
            }
        });
    }
    add_horizons(point, hidden);
    hidden.leave_out_contained();
    let count = hidden.len();
    let share = sky_share(hidden.seen(), point.shading);
    if sky.above == sky.below {
        return sky.above * share;
    }
    hidden.truncate(count);
    hidden.add(Cap::below(sky.up));
    hidden.leave_out_contained();
    let above = sky_share(hidden.seen(), point.shading).min(share);
    sky.below * (share - above) + sky.above * above
}

/// Hides what lies below the surface, and what lies below the plane across the shading normal of a bump.
pub(super) fn add_horizons(point: &SurfacePoint, hidden: &mut Hidden) {
    hidden.add(Cap::below(point.normal));
    if point.shading != point.normal {
        hidden.add(Cap::below(point.shading));
    }
}
