//! Rotations that others have written down, rounded.

use std::fmt;

use glam::{DMat3, DVec3};

/// The reason for which a matrix is no rotation.
///
/// # Example
/// ```
/// use marbles_core::glam::{DMat3, DVec3};
/// use marbles_core::{RotationError, nearest_rotation};
///
/// let mirror = DMat3::from_diagonal(DVec3::new(1.0, 1.0, -1.0));
/// assert_eq!(nearest_rotation(mirror), Err(RotationError::Mirrors(-1.0)));
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum RotationError {
    /// Its columns are not unit vectors at right angles: the largest entry of RᵀR − 1, which may be infinite.
    Skewed(f64),
    /// It mirrors: the determinant.
    Mirrors(f64),
}

impl fmt::Display for RotationError {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Skewed(found) => write!(out, "RᵀR differs from 1 by {found:.1e}"),
            Self::Mirrors(found) => write!(out, "its determinant is {found}"),
        }
    }
}

impl std::error::Error for RotationError {}

/// The rotation next to a matrix R.
///
/// A matrix that is a rotation to rounding is returned as it is, so that a rotation which was written
/// with all its digits comes back to the bit.
///
/// # Errors
/// Refuses a matrix with an entry of RᵀR − 1 above 1e-6, and one that mirrors.
///
/// # Accuracy
/// No entry of RᵀR − 1 is larger than 1e-14; `rotation/tests.rs` measures it.
///
/// # Source
/// N. J. Higham, Computing the polar decomposition, SIAM J. Sci. Stat. Comput. 7 (1986): Newton's
/// iteration R ← (R + R⁻ᵀ) / 2 leads to the nearest orthogonal matrix, and squares the deviation.
pub fn nearest_rotation(matrix: DMat3) -> Result<DMat3, RotationError> {
    /// The deviation that seven decimals of the entries leave.
    const LARGEST_DEVIATION: f64 = 1e-6;
    /// More than what rounding leaves of a product of three rotations.
    const ROUNDED: f64 = 1e-14;
    let found = match matrix.is_finite() {
        true => deviation(matrix),
        false => f64::INFINITY,
    };
    if found > LARGEST_DEVIATION {
        return Err(RotationError::Skewed(found));
    }
    let determinant = matrix.determinant();
    if determinant < 0.0 {
        return Err(RotationError::Mirrors(determinant));
    }
    let mut nearest = matrix;
    // From 1e-6 two steps reach rounding.
    while deviation(nearest) > ROUNDED {
        nearest = (nearest + nearest.inverse().transpose()) * 0.5;
    }
    Ok(nearest)
}

/// The largest entry of RᵀR − 1; infinite where the products are beyond the range of numbers.
fn deviation(matrix: DMat3) -> f64 {
    let difference = matrix.transpose() * matrix - DMat3::IDENTITY;
    let columns = [difference.x_axis, difference.y_axis, difference.z_axis];
    // `max` passes over NaN, which finite numbers make beside infinite squares only.
    let largest =
        |most: f64, column: DVec3| column.abs().to_array().into_iter().fold(most, f64::max);
    columns.into_iter().fold(0.0, largest)
}

#[cfg(test)]
mod tests;
