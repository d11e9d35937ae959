//! The colors of a table's spheres.

use std::collections::{HashSet, TryReserveError};

use super::categories::Categories;
use super::contents::Contents;
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
    /// Those of categories.
    Categories(Categories),
    /// None: these are the different numbers of a column.
    Distinct(Distinct),
    /// None: these are the contents of the columns.
    Contents(Vec<Contents>),
}

/// Different numbers, none of them NaN.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Distinct {
    /// Their bits, each number once.
    bits: HashSet<u64>,
    last: Option<f64>,
}

impl Distinct {
    pub(crate) fn add(&mut self, number: f64) {
        // The same number usually comes many times in a row.
        if self.last != Some(number) {
            self.last = Some(number);
            // Both zeros are one number.
            self.bits.insert((number + 0.0).to_bits());
        }
    }

    /// The numbers in rising order.
    pub(crate) fn sorted(&self) -> Vec<f64> {
        let mut numbers: Vec<f64> = self.bits.iter().map(|bits| f64::from_bits(*bits)).collect();
        numbers.sort_unstable_by(f64::total_cmp);
        numbers
    }
}

impl Paint {
    /// The colors of no spheres of a table with so many columns.
    pub(crate) fn new(coloring: Coloring, columns: usize) -> Self {
        match coloring {
            Coloring::Material => Self::Material,
            Coloring::Table => Self::Colors(Vec::new()),
            Coloring::Element => Self::Elements(Vec::new()),
            Coloring::Value => Self::Values(Vec::new()),
            Coloring::Category => Self::Categories(Categories::default()),
            Coloring::Distinct => Self::Distinct(Distinct::default()),
            Coloring::Contents(texts) => Self::Contents(Contents::of_columns(columns, texts)),
        }
    }

    /// Makes room for so many more spheres.
    pub(crate) fn reserve(&mut self, more: usize) -> Result<(), TryReserveError> {
        match self {
            Self::Material | Self::Distinct(_) | Self::Contents(_) => Ok(()),
            Self::Colors(colors) => colors.try_reserve_exact(more),
            Self::Elements(numbers) => numbers.try_reserve_exact(more),
            Self::Values(values) => values.try_reserve_exact(more),
            Self::Categories(categories) => categories.indices.try_reserve_exact(more),
        }
    }

    /// Removes the colors of so many spheres at the start.
    pub(super) fn remove_first(&mut self, count: usize) {
        match self {
            Self::Material | Self::Distinct(_) | Self::Contents(_) => {}
            Self::Colors(colors) => drop(colors.drain(..count)),
            Self::Elements(numbers) => drop(numbers.drain(..count)),
            Self::Values(values) => drop(values.drain(..count)),
            Self::Categories(categories) => drop(categories.indices.drain(..count)),
        }
    }

    /// Adds others from the same source; returns whether they have too many names together.
    pub(crate) fn append(&mut self, others: Self) -> bool {
        match (self, others) {
            (Self::Colors(own), Self::Colors(mut others)) => own.append(&mut others),
            (Self::Elements(own), Self::Elements(mut others)) => own.append(&mut others),
            (Self::Values(own), Self::Values(mut others)) => own.append(&mut others),
            (Self::Categories(own), Self::Categories(others)) => return own.append(others),
            (Self::Distinct(own), Self::Distinct(others)) => own.bits.extend(others.bits),
            (Self::Contents(own), Self::Contents(others)) => {
                own.iter_mut()
                    .zip(others)
                    .for_each(|(own, others)| own.append(others));
            }
            _ => {}
        }
        false
    }
}
