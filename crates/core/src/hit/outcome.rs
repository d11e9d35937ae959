//! The outcome of the intersection of a ray and a sphere.

use glam::DVec3;

/// The point where a ray meets a sphere.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hit {
    /// Distance in multiples of the ray's direction.
    pub t: f64,
    /// Unit outward normal of the sphere.
    pub normal: DVec3,
    /// True where the ray started inside the sphere or on its surface, and so meets its inner side.
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
