//! Rotations as matrices.

use glam::DMat3;
use marbles_core::{RotationError, nearest_rotation};

use super::point::Point;
use super::quantity::Coordinate;
use crate::text::{Placed, Read, Slice, read_simple, refuse};

/// The rotation next to a matrix that the file has as nine numbers row by row, or as three rows, in a list or a tuple.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Rotation(pub(crate) DMat3);

impl<'t> Read<'t> for Rotation {
    fn read(slice: Slice<'t>) -> Option<Self> {
        let expected = "a rotation matrix, nine numbers `[…]` row by row";
        let refused =
            |found: &str| refuse(slice.place(), format!("expected {expected}, found {found}"));
        let has_rows = slice
            .text
            .get(1..)
            .unwrap_or_default()
            .trim_ascii_start()
            .starts_with(['(', '[']);
        let is_tuple = slice.text.starts_with('(');
        let entries: Vec<f64> = if has_rows {
            let rows: Vec<Placed<Point>> = if is_tuple {
                read_simple::<[_; 3]>(slice, expected)?.into()
            } else {
                read_simple(slice, expected)?
            };
            let row = |row: &Placed<Point>| Some(row.get()?.0.to_array());
            rows.iter().map(row).collect::<Option<Vec<_>>>()?.concat()
        } else {
            let entries: Vec<Placed<Coordinate>> = if is_tuple {
                read_simple::<[_; 9]>(slice, expected)?.into()
            } else {
                read_simple(slice, expected)?
            };
            let entry = |entry: &Placed<Coordinate>| Some(entry.get()?.0);
            entries.iter().map(entry).collect::<Option<_>>()?
        };
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
