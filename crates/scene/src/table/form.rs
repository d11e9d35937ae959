//! The form of a text's rows.

use std::ops::Range;

use super::element;
use super::elements::Atom;
use super::fields::Division;

/// The form of the rows of a text.
#[derive(Clone, Debug)]
pub(crate) struct Form {
    pub(crate) division: Division,
    /// Lines may have more fields than there are columns.
    pub(crate) may_be_longer: bool,
    /// Numbers have commas where others have points.
    pub(crate) has_decimal_commas: bool,
    /// The kind of a line, used if the header does not tell how many rows follow.
    pub(crate) kind: fn(&[u8]) -> LineKind,
    /// The atomic number that a line tells in this field.
    pub(crate) element: ElementOf,
    /// The place of what atoms are called where nothing is in the field of the element.
    pub(crate) name: Range<usize>,
    /// Rows end before one that has something else in this column.
    pub(crate) same: Option<(usize, Vec<u8>)>,
}

/// The atomic number that a line tells in a field.
pub(crate) type ElementOf = fn(&[u8], Range<usize>) -> Option<u8>;

/// The kind of a line.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub(crate) enum LineKind {
    Row,
    /// It says nothing of spheres.
    Other,
    /// It is not of this table any more.
    End,
}

impl Form {
    /// Rows that are divided so, as long as the header says; blank lines and comments are passed over.
    pub(crate) fn new(division: Division) -> Self {
        Self {
            division,
            may_be_longer: false,
            has_decimal_commas: false,
            kind: of_table,
            element: |line, field| element::of_label(&line[field]),
            name: 0..0,
            same: None,
        }
    }

    /// The atom of a line that has its element in this field.
    #[inline]
    pub(crate) fn atom<'a>(&self, line: &'a [u8], field: Range<usize>) -> Atom<'a> {
        let number = (self.element)(line, field.clone()).unwrap_or(0);
        let label = match line[field.clone()].is_empty() {
            true => line.get(self.name.clone()).unwrap_or_default(),
            false => &line[field],
        };
        Atom {
            number,
            label: label.trim_ascii(),
        }
    }
}

/// The kind of a line in a table that may have comments.
pub(crate) fn of_table(line: &[u8]) -> LineKind {
    match line.trim_ascii_start().first() {
        None | Some(b'#' | b'%') => LineKind::Other,
        Some(_) => LineKind::Row,
    }
}
