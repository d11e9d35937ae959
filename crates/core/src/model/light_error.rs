//! The reasons for which lights are refused.

use std::fmt;

use glam::DVec3;

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
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum LightError {
    /// The vector toward a directional light is zero, infinite or not a number.
    Toward(DVec3),
    /// The diameter of a sun is negative, not a number, or not less than a straight angle.
    Diameter(f64),
    /// The direction that is up for a sky is zero, infinite or not a number.
    Up(DVec3),
    /// The position of a point light is infinite or not a number.
    Position(DVec3),
    /// The reference distance of a point light is zero, negative, infinite or not a number.
    Reference(f64),
    /// The direction that a lamp faces is zero, infinite or not a number.
    Direction(DVec3),
    /// The power of a lamp's emission is negative, infinite or not a number.
    Mu(f64),
}

impl fmt::Display for LightError {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Toward(found) => write!(
                out,
                "expected a finite vector toward the light that is not zero, found {found}"
            ),
            Self::Diameter(found) => write!(
                out,
                "expected a diameter of at least 0 and less than 180 degrees, found {} degrees",
                found.to_degrees()
            ),
            Self::Up(found) => write!(
                out,
                "expected a finite direction that is not zero, found {found}"
            ),
            Self::Position(found) => write!(out, "expected a finite position, found {found}"),
            Self::Reference(found) => write!(
                out,
                "expected a finite reference distance greater than 0, found {found}"
            ),
            Self::Direction(found) => write!(
                out,
                "expected a finite direction that is not zero, found {found}"
            ),
            Self::Mu(found) => write!(
                out,
                "expected a finite power `mu` of at least 0, found {found}"
            ),
        }
    }
}

impl std::error::Error for LightError {}
