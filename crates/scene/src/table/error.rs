//! The faults of tables, and their places.

use std::io;
use std::ops::Range;

use crate::text::show;

/// The reason for which there is no table.
#[derive(Debug)]
pub(crate) enum TableError {
    /// The file cannot be opened or read.
    Unreadable(io::Error),
    /// The name has no ending that tells a format.
    UnknownFormat,
    /// There is no memory for it.
    OutOfMemory(u64),
    /// Something is wrong in it.
    Fault(TableFault),
}

impl From<io::Error> for TableError {
    fn from(error: io::Error) -> Self {
        Self::Unreadable(error)
    }
}

impl From<TableFault> for TableError {
    fn from(fault: TableFault) -> Self {
        Self::Fault(fault)
    }
}

/// Something that is wrong at a place of a table.
#[derive(Clone, Debug, Eq, PartialEq)]
pub(crate) struct TableFault {
    pub(crate) place: TablePlace,
    /// The expected thing and the found one.
    pub(crate) message: String,
}

/// A place in a table.
#[derive(Clone, Debug, Eq, PartialEq)]
pub(crate) enum TablePlace {
    /// In a file of text.
    Text {
        /// The line, from 1.
        line: u64,
        /// That line.
        text: String,
        /// The place in it, in bytes.
        span: Range<usize>,
    },
    /// In a row of a binary file.
    Row {
        /// The row, from 1.
        row: u64,
        /// The column, from 1.
        column: usize,
        /// The byte of the file at which the value starts, from 0.
        byte: u64,
    },
    /// In the header of a binary file.
    Header,
}

impl TableFault {
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
        let place = TablePlace::Text {
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

    /// A fault in the header of a binary file.
    pub(crate) fn in_header(message: String) -> Self {
        let place = TablePlace::Header;
        Self { place, message }
    }

    /// The same fault so many lines further down.
    pub(crate) fn lower(mut self, lines: u64) -> Self {
        if let TablePlace::Text { line, .. } = &mut self.place {
            *line += lines;
        }
        self
    }
}
