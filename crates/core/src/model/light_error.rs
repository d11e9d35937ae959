//! The reasons for which lights are refused.

use glam::DVec3;
use thiserror::Error;

/// The reason for which a light was refused.
///
/// # Example
/// ```
/// use marbles_core::glam::DVec3;
/// use marbles_core::{Light, LightError};
///
/// let refused = Light::directional(DVec3::ZERO, DVec3::ONE);
/// assert_eq!(refused, Err(LightError::Toward(DVec3::ZERO)));
/// ```
#[derive(Clone, Copy, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum LightError {
    /// The vector toward a directional light is zero, infinite or not a number.
    #[error("expected a finite vector toward the light that is not zero, found {0}")]
    Toward(DVec3),
    /// The position of a point light is infinite or not a number.
    #[error("expected a finite position, found {0}")]
    Position(DVec3),
    /// The reference distance of a point light is zero, negative, infinite or not a number.
    #[error("expected a finite reference distance greater than 0, found {0}")]
    Reference(f64),
    /// The direction that a lamp faces is zero, infinite or not a number.
    #[error("expected a finite direction that is not zero, found {0}")]
    Direction(DVec3),
    /// The power of a lamp's emission is negative, infinite or not a number.
    #[error("expected a finite power `mu` of at least 0, found {0}")]
    Mu(f64),
}
