//! Faults at their lines, rows or bytes.

use std::ops::Range;

use super::show::show;

/// Something that is wrong at a place of a file, a scene or a table.
#[derive(Clone, Debug, Eq, PartialEq)]
pub(crate) struct LocatedFault {
    pub(crate) place: Place,
    /// The expected thing and the found one.
    pub(crate) message: String,
}

/// A place in a file.
#[derive(Clone, Debug, Eq, PartialEq)]
pub(crate) enum Place {
    /// In a file of text.
    Text {
        /// The line, from 1.
        line: u64,
        /// That line.
        text: String,
        /// The place in it, in bytes.
        span: Range<usize>,
    },
    /// In a row of a binary table.
    Row {
        /// The row, from 1.
        row: u64,
        /// The column, from 1.
        column: usize,
        /// The byte of the file at which the value starts, from 0, where it stands there as it is.
        byte: Option<u64>,
    },
    /// The file as a whole, or the header of a binary file.
    File,
}

impl LocatedFault {
    /// Something else was expected than this part of a line.
    pub(crate) fn expected(number: u64, line: &[u8], span: Range<usize>, expected: &str) -> Self {
        let found = String::from_utf8_lossy(&line[span.clone()]);
        let found = match &*found {
            "" if line[span.end..].trim_ascii().is_empty() => String::from("the end of the line"),
            "" => String::from("nothing"),
            found => show(found),
        };
        let message = format!("expected {expected}, found {found}");
        Self::in_line(number, line, span, message)
    }

    /// A fault in a part of a line.
    pub(crate) fn in_line(number: u64, line: &[u8], span: Range<usize>, message: String) -> Self {
        // Bytes that are no text become characters of other lengths.
        let before = String::from_utf8_lossy(&line[..span.start]).into_owned();
        let inside = String::from_utf8_lossy(&line[span.clone()]).into_owned();
        let after = String::from_utf8_lossy(&line[span.end..]);
        let place = Place::Text {
            line: number,
            span: before.len()..before.len() + inside.len(),
            text: before + &inside + &after,
        };
        Self { place, message }
    }

    /// A fault behind the last line of a text.
    pub(crate) fn at_end(number: u64, expected: &str) -> Self {
        let message = format!("expected {expected}, found the end of the file");
        Self::in_line(number, b"", 0..0, message)
    }

    /// A fault of a file as a whole, or of its header.
    pub(crate) fn of_file(message: impl Into<String>) -> Self {
        Self {
            place: Place::File,
            message: message.into(),
        }
    }

    /// The same fault so many lines further down.
    pub(crate) fn lower(mut self, lines: u64) -> Self {
        if let Place::Text { line, .. } = &mut self.place {
            *line += lines;
        }
        self
    }
}
