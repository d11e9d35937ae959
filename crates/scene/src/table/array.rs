//! Columns and arrays of numbers that are in memory.

use std::borrow::Cow;

use super::kind::Kind;

/// A column that is in memory.
#[derive(Clone, Debug)]
pub(crate) struct Column<'a> {
    pub(crate) kind: Kind,
    pub(crate) bytes: Cow<'a, [u8]>,
    /// The place of its first value among the bytes, and the way to the next.
    pub(crate) offset: usize,
    pub(crate) step: usize,
    /// The byte of the file at which the bytes start, where they stand there as they are.
    pub(crate) start: Option<u64>,
}

/// Some rows of an array, whose values of a row lie side by side.
#[derive(Clone, Debug)]
pub(crate) struct Part<'a> {
    pub(crate) kind: Kind,
    pub(crate) bytes: Cow<'a, [u8]>,
    /// The byte of the file at which they start, where they stand there as they are.
    pub(crate) start: Option<u64>,
    /// All rows have the values of one.
    pub(crate) is_constant: bool,
}

impl Part<'_> {
    /// Rows that are not looked at.
    pub(crate) fn unused(kind: Kind) -> Self {
        Self {
            kind,
            bytes: Cow::Borrowed(&[]),
            start: None,
            is_constant: true,
        }
    }

    /// The column of a component, of so many.
    pub(crate) fn column(&self, size: u64, component: u64) -> Column<'_> {
        let each = self.kind.size();
        Column {
            kind: self.kind,
            bytes: Cow::Borrowed(&self.bytes),
            offset: (component * each) as usize,
            step: if self.is_constant {
                0
            } else {
                (size * each) as usize
            },
            start: self.start,
        }
    }

    /// The number of a row that has a single one.
    pub(crate) fn number(&self, row: usize) -> Option<f64> {
        let each = self.kind.size() as usize;
        let start = if self.is_constant { 0 } else { row * each };
        self.kind.decode(self.bytes.get(start..)?)
    }
}
