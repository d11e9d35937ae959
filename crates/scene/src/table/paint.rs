//! The colors of a table's spheres.

use std::collections::TryReserveError;

use super::request::Coloring;

/// The colors of a table's spheres.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Paint {
    /// Those of the material.
    Material,
    /// Linear red, green and blue of each.
    Colors(Vec<[f32; 3]>),
    /// Those of the elements with these atomic numbers.
    Elements(Vec<u8>),
    /// Those that a colormap gives to these numbers.
    Values(Vec<f64>),
}

impl Paint {
    /// The colors of no spheres.
    pub(crate) fn new(coloring: Coloring) -> Self {
        match coloring {
            Coloring::Material => Self::Material,
            Coloring::Table => Self::Colors(Vec::new()),
            Coloring::Element => Self::Elements(Vec::new()),
            Coloring::Value => Self::Values(Vec::new()),
        }
    }

    /// Makes room for so many more spheres.
    pub(crate) fn reserve(&mut self, more: usize) -> Result<(), TryReserveError> {
        match self {
            Self::Material => Ok(()),
            Self::Colors(colors) => colors.try_reserve_exact(more),
            Self::Elements(numbers) => numbers.try_reserve_exact(more),
            Self::Values(values) => values.try_reserve_exact(more),
        }
    }

    /// Adds the first `most` of others from the same source.
    pub(crate) fn append(&mut self, others: Self, most: usize) {
        fn append<T>(own: &mut Vec<T>, mut others: Vec<T>, most: usize) {
            others.truncate(most);
            own.append(&mut others);
        }
        match (self, others) {
            (Self::Colors(own), Self::Colors(others)) => append(own, others, most),
            (Self::Elements(own), Self::Elements(others)) => append(own, others, most),
            (Self::Values(own), Self::Values(others)) => append(own, others, most),
            _ => {}
        }
    }
}
