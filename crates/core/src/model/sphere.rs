//! Spheres, as a scene describes them.

use std::fmt;

use glam::DVec3;

/// A sphere: an opaque surface, in the world frame.
///
/// # Example
/// ```
/// use marbles_core::glam::DVec3;
/// use marbles_core::{Ray, Sphere};
///
/// let sphere = Sphere::new(DVec3::new(0.0, 0.0, 5.0), 1.0)?;
/// let ray = Ray { origin: DVec3::ZERO, direction: DVec3::Z };
/// assert_eq!(sphere.hit(&ray).map(|hit| hit.t), Some(4.0));
/// // A ray that touches the sphere hits it, and one that passes by the least distance misses it.
/// let at_height = |y| Ray { origin: DVec3::new(0.0, y, 0.0), direction: DVec3::Z };
/// assert!(sphere.hit(&at_height(1.0)).is_some());
/// assert!(sphere.hit(&at_height(1.0_f64.next_up())).is_none());
/// # Ok::<(), marbles_core::SphereError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sphere {
    pub(crate) center: DVec3,
    pub(crate) radius: f64,
}

/// The reason for which a sphere was refused.
///
/// # Example
/// ```
/// use marbles_core::glam::DVec3;
/// use marbles_core::{Sphere, SphereError};
///
/// let refused = Sphere::new(DVec3::ZERO, -1.0);
/// assert_eq!(refused, Err(SphereError::Radius(-1.0)));
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum SphereError {
    /// The center is infinite or not a number.
    Center(DVec3),
    /// The radius is zero, negative, infinite or not a number.
    Radius(f64),
}

impl fmt::Display for SphereError {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Center(found) => write!(out, "expected a finite center, found {found}"),
            Self::Radius(found) => write!(
                out,
                "expected a finite radius greater than 0, found {found}"
            ),
        }
    }
}

impl std::error::Error for SphereError {}

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
