//! Rays.

use glam::DVec3;

use crate::numeric::rounding::UNIT_ROUNDOFF;

/// A half line: the points `origin + t · direction` with `t > 0`, in the world frame.
///
/// # Example
/// ```
/// use marbles_core::Ray;
/// use marbles_core::glam::DVec3;
///
/// let ray = Ray { origin: DVec3::X, direction: DVec3::new(0.0, 0.0, 2.0) };
/// assert_eq!(ray.at(3.0), DVec3::new(1.0, 0.0, 6.0));
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ray {
    /// The point where the ray starts.
    pub origin: DVec3,
    /// Its direction; need not be unit.
    pub direction: DVec3,
}

impl Ray {
    /// The point at `t` multiples of the direction.
    pub fn at(&self, t: f64) -> DVec3 {
        self.origin + self.direction * t
    }

    /// A bound of the distance between [`Ray::at`] and the exact point, for a `t` that lies within
    /// a unit in the last place of the exact one.
    ///
    /// With u the unit roundoff, each component is off by 3u |t dᵢ| and the rounding of the sum,
    /// together 4u (|oᵢ| + |t dᵢ|) at most; the length of three of them is √3 times the largest.
    #[cfg_attr(
        not(test),
        allow(dead_code, reason = "what rays side by side are tested against")
    )]
    pub(crate) fn point_error(&self, t: f64) -> f64 {
        let largest = |vector: DVec3| vector.abs().max_element();
        7.0 * UNIT_ROUNDOFF * (largest(self.origin) + t * largest(self.direction))
    }
}
