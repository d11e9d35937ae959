//! The outcome of the intersection of a ray and a sphere.

use glam::DVec3;

/// The point where a ray meets a sphere.
///
/// # Example
/// ```
/// use marbles_core::glam::DVec3;
/// use marbles_core::{Ray, Sphere};
///
/// let sphere = Sphere::new(DVec3::ZERO, 2.0)?;
/// let from_inside = Ray { origin: DVec3::ZERO, direction: DVec3::Z };
/// let hit = sphere.hit(&from_inside).expect("a ray from inside leaves the sphere");
/// assert_eq!(hit.t, 2.0);
/// assert_eq!(hit.normal, DVec3::Z);
/// assert!(hit.inner_side);
/// # Ok::<(), marbles_core::SphereError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Hit {
    /// Distance in multiples of the ray's direction.
    pub t: f64,
    /// Unit outward normal of the sphere.
    pub normal: DVec3,
    /// True if the ray started inside the sphere or on its surface, and so meets its inner side.
    pub inner_side: bool,
}

/// The point where a ray meets a sphere, by its coordinates.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Components {
    /// The distance in multiples of the ray's direction.
    pub(crate) t: f64,
    /// In the world frame.
    pub(crate) position: DVec3,
    /// The components of the unit outward normal along the axes that were asked for.
    pub(crate) normal: DVec3,
}

/// The arithmetic that settled a hit or a miss.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub enum Floor {
    /// Doubles, with a bound of their rounding errors.
    Fast,
    /// Numbers of twice the precision, with a bound too.
    Double,
    /// Integers: no rounding.
    Exact,
}
