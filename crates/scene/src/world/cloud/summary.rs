//! What is in the columns of a table.

use crate::table::Paint;

/// A column of a table.
#[derive(Clone, Debug, PartialEq)]
pub struct ColumnSummary {
    /// The name, or the number from 1 where the table has no names.
    pub name: String,
    /// The unit that the table has behind the name.
    pub unit: Option<String>,
    /// What is in it.
    pub contents: ColumnContents,
}

/// What is in a column.
#[derive(Clone, Debug, PartialEq)]
pub enum ColumnContents {
    /// Numbers.
    Numbers {
        /// The least, infinite where there are none.
        low: f64,
        /// The largest.
        high: f64,
        /// The rows without one.
        missing: usize,
        /// They are times, in seconds since the start of 1970.
        are_times: bool,
    },
    /// Texts.
    Texts {
        /// The number of different ones.
        count: usize,
        /// Some of them, in the order of the table.
        examples: Vec<String>,
    },
    /// Bytes that are neither.
    Other,
}

impl ColumnContents {
    pub(super) fn of_numbers(values: &[f64], are_times: bool) -> Self {
        let present = || values.iter().copied().filter(|value| !value.is_nan());
        Self::Numbers {
            low: present().fold(f64::INFINITY, f64::min),
            high: present().fold(f64::NEG_INFINITY, f64::max),
            missing: values.len() - present().count(),
            are_times,
        }
    }

    pub(super) fn of_texts(paint: &Paint) -> Self {
        const EXAMPLES: usize = 4;
        match paint {
            Paint::Categories(categories) => Self::Texts {
                count: categories.names.len(),
                examples: categories.names.iter().take(EXAMPLES).cloned().collect(),
            },
            _ => Self::Other,
        }
    }
}
