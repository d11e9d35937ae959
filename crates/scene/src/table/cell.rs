//! The cell of a periodic table: the box that repeats along its three edges.

use glam::{DMat3, DVec3};
use marbles_core::Angle;

use super::number::parse;
use crate::text::LocatedFault;

/// The cell of a periodic table.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Cell {
    /// The edges a, b and c, as columns.
    pub(crate) edges: DMat3,
    /// The corner from which the edges go out.
    pub(crate) origin: DVec3,
    /// The edges along which the cell repeats.
    pub(crate) is_periodic: [bool; 3],
    /// The fractions of the edges that a displacement is.
    inverse: DMat3,
}

/// The cell that a table tells, or what is wrong in it; this matters only if something asks for the cell.
pub(crate) type ToldCell = Result<Cell, LocatedFault>;

/// The volume of a cell beside that of a box with the same edges, below which it is flat.
const FLAT: f64 = 1e-9;

impl Cell {
    /// The cell with these edges, as columns, and this corner, which repeats along all of them.
    ///
    /// # Errors
    /// Returns what is found instead of three finite edges that span a volume.
    pub(crate) fn new(edges: DMat3, origin: DVec3) -> Result<Self, String> {
        let expected = "expected a cell of three finite edges that span a volume";
        if !edges.is_finite() || !origin.is_finite() {
            return Err(format!("{expected}, found an infinite one"));
        }
        let longest = edges
            .x_axis
            .abs()
            .max(edges.y_axis.abs())
            .max(edges.z_axis.abs());
        // Divided by the longest edge, no product of edges overflows.
        let unit = edges.mul_scalar(longest.max_element().recip());
        let [a, b, c] = [unit.x_axis, unit.y_axis, unit.z_axis];
        let volume = unit.determinant().abs();
        let is_solid = volume > FLAT * a.length() * b.length() * c.length();
        let inverse = edges.inverse();
        if !is_solid || !inverse.is_finite() {
            return Err(format!("{expected}, found one without a volume"));
        }
        Ok(Self {
            edges,
            origin,
            is_periodic: [true; 3],
            inverse,
        })
    }

    /// The cell with these lengths of the edges, and these angles between b and c, a and c, a and b, in degrees: a
    /// points along x, and b lies in the plane of x and y.
    ///
    /// # Errors
    /// As [`Self::new`].
    pub(crate) fn of_lengths(lengths: [f64; 3], degrees: [f64; 3]) -> Result<Self, String> {
        let is_length = lengths
            .iter()
            .all(|length| length.is_finite() && *length > 0.0);
        let is_angle = degrees.iter().all(|angle| (0.0..180.0).contains(angle));
        if !is_length || !is_angle {
            return Err(format!(
                "expected a cell with lengths greater than 0 and angles between 0 and 180 degrees, found {lengths:?} \
                 and {degrees:?}"
            ));
        }
        let [a, b, c] = lengths;
        let [alpha, beta, gamma] = degrees.map(Angle::from_degrees);
        let along = (alpha.cos - beta.cos * gamma.cos) / gamma.sin;
        let up = 1.0 - beta.cos * beta.cos - along * along;
        let edges = DMat3::from_cols(
            DVec3::new(a, 0.0, 0.0),
            b * DVec3::new(gamma.cos, gamma.sin, 0.0),
            c * DVec3::new(beta.cos, along, up.max(0.0).sqrt()),
        );
        Self::new(edges, DVec3::ZERO)
    }

    /// The cell that repeats along these edges alone.
    pub(crate) fn periodic_along(self, is_periodic: [bool; 3]) -> Self {
        Self {
            is_periodic,
            ..self
        }
    }

    /// The fractions of the edges that lead from the corner to a point.
    pub(crate) fn fractions(&self, point: DVec3) -> DVec3 {
        self.inverse * (point - self.origin)
    }

    /// The point to which these fractions of the edges lead from the corner.
    pub(crate) fn point(&self, fractions: DVec3) -> DVec3 {
        self.edges * fractions + self.origin
    }

    /// The lengths of the edges.
    pub(crate) fn lengths(&self) -> [f64; 3] {
        [self.edges.x_axis, self.edges.y_axis, self.edges.z_axis].map(DVec3::length)
    }

    /// The angles between b and c, a and c, a and b, in degrees.
    pub(crate) fn angles(&self) -> [f64; 3] {
        let [a, b, c] = [self.edges.x_axis, self.edges.y_axis, self.edges.z_axis];
        let between = |one: DVec3, other: DVec3| {
            let sine = one.cross(other).length();
            libm::atan2(sine, one.dot(other)).to_degrees()
        };
        [between(b, c), between(a, c), between(a, b)]
    }
}

/// The numbers of these texts; `None` if one of them is none, or if there are not as many.
pub(crate) fn numbers<const COUNT: usize>(texts: &[&[u8]]) -> Option<[f64; COUNT]> {
    let numbers: Option<Vec<f64>> = texts.iter().map(|text| parse(text, false)).collect();
    numbers?.try_into().ok()
}

#[cfg(test)]
mod tests;
