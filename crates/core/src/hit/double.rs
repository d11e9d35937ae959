//! The second floor: numbers of twice the precision, with bounds of their errors too.

use fearless_simd::{Level, dispatch};
use glam::DVec3;

use super::outcome::Hit;
use crate::model::ray::Ray;
use crate::model::sphere::Sphere;
use crate::numeric::double_double::DoubleDouble;
use crate::numeric::fused::is_fused;
use crate::numeric::rounding::{UNIT_ROUNDOFF, two_difference};

/// Bound of the errors of K relative to f·f + r², of Q relative to A (f·f + r²), and of B and
/// |d × f| relative to |d| |f|.
///
/// From the relative errors of [`DoubleDouble`], with u the unit roundoff and f exact: K is off
/// by at most 14u² (f·f + r²) and B by 11u² |d| |f|. Each component of d × f is off by
/// 8u² (|dⱼ fₖ| + |dₖ fⱼ|), so that the vector is off by 11.4u² |d| |f| and its square by 34u² A f·f;
/// A r² carries 16u²; with the last subtraction Q is off by at most 37u² A (f·f + r²).
const BOUND: f64 = 64.0 * UNIT_ROUNDOFF * UNIT_ROUNDOFF;

/// The largest error of distance and normal before their last rounding: 2⁻⁵⁷, of t and of the radius.
const TOLERANCE: f64 = UNIT_ROUNDOFF / 16.0;

/// The hit or the miss, `None` where the bounds do not decide or do not prove the last places.
///
/// Neither may be far from 1 in size, see [`Scaled`](super::scaled::Scaled).
pub(super) fn hit(sphere: &Sphere, ray: &Ray) -> Option<Option<Hit>> {
    dispatch!(Level::new(), simd => if is_fused(simd) {
        decide::<true>(sphere, ray)
    } else {
        decide::<false>(sphere, ray)
    })
}

/// K of a sphere of moderate size as seen from `origin`, rounded once.
#[inline(always)]
pub(super) fn outside<const FUSED: bool>(sphere: &Sphere, origin: DVec3) -> f64 {
    let to_center = to_center::<FUSED>(sphere, origin);
    (dot(to_center, to_center) - DoubleDouble::product(sphere.radius, sphere.radius)).high
}

#[inline(always)]
fn decide<const FUSED: bool>(sphere: &Sphere, ray: &Ray) -> Option<Option<Hit>> {
    // A, B and K.
    let to_center = to_center::<FUSED>(sphere, ray.origin);
    let directions = ray.direction.to_array().map(DoubleDouble::<FUSED>::from);
    let direction_sq = dot(directions, directions);
    let along = dot(directions, to_center);
    let distance_sq = dot(to_center, to_center);
    let radius_sq = DoubleDouble::product(sphere.radius, sphere.radius);
    let outside = distance_sq - radius_sq;
    let scale = distance_sq.high + radius_sq.high;

    // The decisions, as on the first floor.
    if outside.high.abs() <= BOUND * scale {
        return None;
    }
    let inner_side = outside.high < 0.0;
    if !inner_side && along.high <= 0.0 {
        return Some(None);
    }
    let across = cross(directions, to_center);
    let discriminant = direction_sq * radius_sq - dot(across, across);
    let discriminant_bound = BOUND * scale * direction_sq.high;
    if discriminant.high < -discriminant_bound {
        return Some(None);
    }
    if discriminant.high <= 2.0 * discriminant_bound {
        return None;
    }

    // √Q is off by the discriminant's bound over √Q at most, as Q is at least half the computed.
    let root = discriminant.sqrt();
    let root_error = discriminant_bound / root.high;
    let length = direction_sq.high.sqrt();
    let along_error = BOUND * length * distance_sq.high.sqrt();
    let backward = along.high < 0.0;
    let far = if backward { root - along } else { root + along };
    let by_product = !inner_side || backward;
    let outside_error = if by_product {
        BOUND * scale / outside.high.abs()
    } else {
        0.0
    };
    let distance_proved = (root_error + along_error) / far.high + outside_error <= TOLERANCE;
    // The point is off by |d| / A of the root's error, and by the error of d × (d × f) over A.
    let point_error = root_error / length + BOUND * distance_sq.high.sqrt();
    if !distance_proved || point_error > TOLERANCE * sphere.radius {
        return None;
    }

    // The distance, from the product of both roots where they would cancel.
    let t = if !by_product {
        far / direction_sq
    } else if inner_side {
        -outside / far
    } else {
        outside / far
    };
    // From the center: d × (d × f) / A to the foot of the perpendicular, half a chord from there.
    let foot = cross(directions, across);
    let half_chord = if inner_side { root } else { -root };
    // In full, so that the normal is as unit as it is straight.
    let inverse = DoubleDouble::from(1.0) / (direction_sq * DoubleDouble::from(sphere.radius));
    let component = |axis: usize| ((foot[axis] + half_chord * directions[axis]) * inverse).high;
    let normal = DVec3::new(component(0), component(1), component(2));
    Some(Some(Hit {
        t: t.high,
        normal,
        inner_side,
    }))
}

/// c − o, exactly.
#[inline(always)]
fn to_center<const FUSED: bool>(sphere: &Sphere, origin: DVec3) -> [DoubleDouble<FUSED>; 3] {
    [0, 1, 2].map(|axis| {
        let (high, low) = two_difference(sphere.center[axis], origin[axis]);
        DoubleDouble { high, low }
    })
}

#[inline(always)]
fn dot<const FUSED: bool>(
    a: [DoubleDouble<FUSED>; 3],
    b: [DoubleDouble<FUSED>; 3],
) -> DoubleDouble<FUSED> {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

#[inline(always)]
fn cross<const FUSED: bool>(
    a: [DoubleDouble<FUSED>; 3],
    b: [DoubleDouble<FUSED>; 3],
) -> [DoubleDouble<FUSED>; 3] {
    [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]
}
