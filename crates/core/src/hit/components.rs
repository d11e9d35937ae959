//! The point in which a ray meets a sphere, each coordinate to its own last places.
//!
//! [`Hit`](super::outcome::Hit) has the distance and the normal to within a unit in the last place of their
//! lengths. A coordinate that is small beside them needs more: on a floor with a radius of 1e9, the normal
//! leans by less than 1e-9. With the numbers of the [module](super) and an axis a,
//!
//! > p = o + d (B ± √Q) / A, a·n = a·(B d − A f ± √Q d) / (A r).
//!
//! Numbers of twice the precision answer where a bound of their errors proves it, and integers where not.

use fearless_simd::{Level, dispatch};
use glam::DVec3;

use super::double::{BOUND, Crossing};
use super::exact;
use super::outcome::Components;
use super::scaled::Scaled;
use crate::model::ray::Ray;
use crate::model::sphere::Sphere;
use crate::numeric::double_double::DoubleDouble;
use crate::numeric::fused::is_fused;
use crate::numeric::pair::three;
use crate::numeric::rounding::UNIT_ROUNDOFF;

/// The relative error of each number before its last rounding, at most: 2⁻⁵⁷.
const TOLERANCE: f64 = UNIT_ROUNDOFF / 16.0;

/// Sizes of numbers whose parts of twice the precision neither overflow nor underflow.
const MODERATE: std::ops::Range<f64> = 1e-200..1e200;

impl Sphere {
    /// [`Sphere::hit`] with the position, and with the normal's components along three unit vectors.
    ///
    /// # Accuracy
    /// Bounds: each number is within a relative error of 2⁻⁵⁷ before it is rounded. The second floor derives
    /// it from the errors of [`DoubleDouble`], term by term; the third computes with integers.
    pub(crate) fn hit_components(&self, ray: &Ray, axes: &[DVec3; 3]) -> Option<Components> {
        let found = dispatch!(Level::new(), simd => if is_fused(simd) {
            find::<true>(self, ray, axes)
        } else {
            find::<false>(self, ray, axes)
        });
        found.or_else(|| exact::components(self, ray, axes))
    }
}

/// The components, `None` where there is no hit or the bounds do not prove it.
#[inline(always)]
fn find<const FUSED: bool>(sphere: &Sphere, ray: &Ray, axes: &[DVec3; 3]) -> Option<Components> {
    let scaled = Scaled::new(sphere, ray);
    let crossing = Crossing::<FUSED>::new(&scaled.sphere, &scaled.ray)??;
    let (distance, distance_error) = crossing.distance();
    let normal = normal(&crossing, scaled.sphere.radius, axes)?;
    let mut position = DVec3::ZERO;
    for axis in 0..3 {
        let way = distance * crossing.directions[axis];
        let way = DoubleDouble::<FUSED> {
            high: scaled.world_length(way.high),
            low: scaled.world_length(way.low),
        };
        let origin = ray.origin[axis];
        let sum = way + DoubleDouble::from(origin);
        let error = (distance_error + BOUND) * way.high.abs() + BOUND * origin.abs();
        position[axis] = proved(sum, error)?;
    }
    let t = proved(distance, distance_error * distance.high)?;
    Some(Components {
        t: scaled.world_distance(t),
        position,
        normal,
    })
}

/// The components of the normal, whose errors are added up term by term.
///
/// A component of d × f is off by 8u² (|dⱼ fₖ| + |dₖ fⱼ|) ([`BOUND`] is eight times that), and d × (d × f)
/// inherits that times |d| and adds as much of its own terms.
#[inline(always)]
fn normal<const FUSED: bool>(
    crossing: &Crossing<FUSED>,
    radius: f64,
    axes: &[DVec3; 3],
) -> Option<DVec3> {
    let (foot, half_chord) = (crossing.foot(), crossing.half_chord());
    let sizes = |vector: &[DoubleDouble<FUSED>; 3]| {
        DVec3::from_array(three([0, 1, 2], |axis| vector[axis].high.abs()))
    };
    let (directions, across) = (sizes(&crossing.directions), sizes(&crossing.across));
    let across_error = terms(directions, sizes(&crossing.to_center)) * BOUND;
    let foot_error = terms(directions, across_error) + terms(directions, across) * BOUND;
    let root_error = crossing.root_error + BOUND * half_chord.high.abs();
    let error = foot_error + directions * root_error;

    let from_center = three([0, 1, 2], |axis| {
        foot[axis] + half_chord * crossing.directions[axis]
    });
    let length = crossing.direction_sq * DoubleDouble::from(radius);
    let mut components = DVec3::ZERO;
    for (component, axis) in components.as_mut().iter_mut().zip(axes) {
        let part = |index: usize| from_center[index] * DoubleDouble::from(axis[index]);
        let sum = part(0) + part(1) + part(2);
        let own_error = sizes(&from_center) * BOUND + error;
        let size = axis.abs().dot(own_error);
        *component = proved(sum / length, size / length.high)?;
    }
    Some(components)
}

/// The sizes of the terms of a vector product, added up, from those of the factors.
#[inline(always)]
fn terms(a: DVec3, b: DVec3) -> DVec3 {
    DVec3::new(
        a.y * b.z + a.z * b.y,
        a.z * b.x + a.x * b.z,
        a.x * b.y + a.y * b.x,
    )
}

/// The number, where this bound of its error proves its last places.
#[inline(always)]
fn proved<const FUSED: bool>(number: DoubleDouble<FUSED>, error: f64) -> Option<f64> {
    let size = number.high.abs();
    let is_moderate = MODERATE.contains(&size) || (size == 0.0 && error == 0.0);
    (is_moderate && error <= TOLERANCE * size).then_some(number.high)
}

#[cfg(test)]
mod tests;
