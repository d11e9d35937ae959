//! Spheres, as a scene describes them.

use glam::DVec3;
use thiserror::Error;

/// A sphere: an opaque surface, in the world frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sphere {
    pub(crate) center: DVec3,
    pub(crate) radius: f64,
}

/// The reason for which a sphere was refused.
#[derive(Clone, Copy, Debug, Error, PartialEq)]
pub enum SphereError {
    /// The center is infinite or not a number.
    #[error("expected a finite center, found {0}")]
    Center(DVec3),
    /// The radius is zero, negative, infinite or not a number.
    #[error("expected a finite radius greater than 0, found {0}")]
    Radius(f64),
}

impl Sphere {
    /// The sphere around `center`.
    ///
    /// # Errors
    /// Refuses what is not finite, and radii that are not greater than 0.
    #[inline]
    pub fn new(center: DVec3, radius: f64) -> Result<Self, SphereError> {
        if !center.is_finite() {
            return Err(SphereError::Center(center));
        }
        if !(radius > 0.0 && radius.is_finite()) {
            return Err(SphereError::Radius(radius));
        }
        Ok(Self { center, radius })
    }

    /// The center, in the world frame.
    #[inline]
    pub fn center(&self) -> DVec3 {
        self.center
    }

    /// The radius, greater than 0.
    #[inline]
    pub fn radius(&self) -> f64 {
        self.radius
    }
}
