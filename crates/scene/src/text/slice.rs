//! A part of the text being read.

use std::ops::Range;

use super::fault::{refuse, text_address};
use super::show::show;

/// A part of the text being read.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Slice<'t> {
    /// The part.
    pub(crate) text: &'t str,
    /// The byte of the whole text at which it starts.
    pub(crate) start: usize,
}

impl<'t> Slice<'t> {
    /// The part `text` of the text being read; it must lie in that text's memory.
    pub(crate) fn of_text_being_read(text: &'t str) -> Self {
        let start = (text.as_ptr() as usize).wrapping_sub(text_address());
        Self { text, start }
    }

    /// The place of this part in the whole text.
    pub(crate) fn place(&self) -> Range<usize> {
        self.start..self.start + self.text.len()
    }

    /// Reports that something else was expected than this part; `None`, for the caller to return.
    pub(crate) fn refuse<T>(&self, expected: &str) -> Option<T> {
        let found = show(self.text);
        refuse(self.place(), format!("expected {expected}, found {found}"))
    }
}
