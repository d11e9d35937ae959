//! Rotations as matrices.

use glam::DMat3;
use marbles_core::{RotationError, nearest_rotation};

use super::quantity::Coordinate;
use crate::text::{Placed, Read, Slice, read_simple, refuse};

/// The rotation next to a matrix that the file has as nine numbers, row by row.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Rotation(pub(crate) DMat3);

impl<'t> Read<'t> for Rotation {
    fn read(slice: Slice<'t>) -> Option<Self> {
        let expected = "a rotation matrix, nine numbers `[…]` row by row";
        let entries: Vec<Placed<Coordinate>> = read_simple(slice, expected)?;
        let refused =
            |found: &str| refuse(slice.place(), format!("expected {expected}, found {found}"));
        let entries: Vec<f64> = entries
            .iter()
            .map(|entry| Some(entry.get()?.0))
            .collect::<Option<_>>()?;
        let Ok(rows) = <[f64; 9]>::try_from(entries.as_slice()) else {
            return refused(&format!("{} of them", entries.len()));
        };
        match nearest_rotation(DMat3::from_cols_array(&rows).transpose()) {
            Ok(rotation) => Some(Self(rotation)),
            Err(RotationError::Skewed(deviation)) => refused(&format!(
                "a matrix R whose RᵀR differs from 1 by {deviation:.1e}, more than 1e-6"
            )),
            Err(RotationError::Mirrors(determinant)) => refused(&format!(
                "a reflection, with the determinant {determinant:.3}"
            )),
            Err(other) => refused(&format!("a matrix that is no rotation: {other}")),
        }
    }
}
