//! Faults with their lines and columns.

use std::ops::Range;
use std::path::Path;

use super::snippet::{Style, bold, snippet};
use crate::table::{TableFault, TablePlace};
use crate::text::token::{self, Unclosed};
use crate::text::{Fault, show};

/// A fault at a place in a file.
#[derive(Clone, Debug, Eq, PartialEq)]
pub struct SceneFault {
    /// The line, from 1; in a binary table the row.
    pub line: usize,
    /// The column, in characters from 1; in a binary table that of the table.
    pub column: usize,
    /// The expected thing and the found one.
    pub message: String,
}

/// A fault with its line and column.
pub(super) struct Located<'t> {
    position: Position,
    message: String,
    /// The text and the place in it, where there is something to see.
    source: Option<(&'t str, Range<usize>)>,
}

/// A place in a file, as a message says it.
#[derive(Clone, Copy, Debug)]
enum Position {
    /// Line and column.
    Line(u64, usize),
    /// A value in a binary table.
    Row { row: u64, column: usize, byte: u64 },
    /// The file as a whole.
    File,
}

impl<'t> Located<'t> {
    /// A fault of a file as a whole.
    pub(super) fn of_whole_file(message: &str) -> Self {
        Self {
            position: Position::File,
            message: message.to_owned(),
            source: None,
        }
    }

    /// A fault in the text of a scene file.
    pub(super) fn in_scene(text: &'t str, fault: Fault) -> Self {
        let (place, message) = match fault.found_is_open {
            true => with_found(text, fault),
            false => (fault.place, fault.message),
        };
        let (line, column) = line_and_column(text, place.start);
        Self {
            position: Position::Line(line as u64, column),
            message,
            source: Some((text, place)),
        }
    }

    /// A fault in a table.
    pub(super) fn in_table(fault: &'t TableFault) -> Self {
        let (position, source) = match &fault.place {
            TablePlace::Text { line, text, span } => {
                let (_, column) = line_and_column(text, span.start);
                let source = (&text[..], span.clone());
                (Position::Line(*line, column), Some(source))
            }
            &TablePlace::Row { row, column, byte } => (Position::Row { row, column, byte }, None),
            TablePlace::Header => (Position::File, None),
        };
        Self {
            position,
            message: fault.message.clone(),
            source,
        }
    }

    /// The fault as programs see it.
    pub(super) fn to_fault(&self) -> SceneFault {
        let (line, column) = match self.position {
            Position::Line(line, column) => (line, column),
            Position::Row { row, column, .. } => (row, column),
            Position::File => (1, 1),
        };
        SceneFault {
            line: usize::try_from(line).unwrap_or(usize::MAX),
            column,
            message: self.message.clone(),
        }
    }

    /// The message about this fault in the file at `path`: its place, the fault, and the line.
    pub(super) fn message(&self, path: &Path, style: Style) -> String {
        let path = path.display();
        let place = match self.position {
            Position::Line(line, column) => format!("{path}:{line}:{column}:"),
            Position::Row { row, column, byte } => {
                format!("{path}: row {row}, column {column}, byte {byte}:")
            }
            Position::File => format!("{path}:"),
        };
        let header = format!("{} {}", bold(&place, style), self.message);
        let line = self.to_fault().line;
        let source = self.source.as_ref();
        match source.and_then(|(text, place)| snippet(text, place.clone(), line, style)) {
            Some(snippet) => format!("{header}\n{snippet}"),
            None => header,
        }
    }
}

/// The place and the message of a fault that still lacks what was found.
///
/// Where the text ends before its time, what was left open is more telling than the end.
fn with_found(text: &str, fault: Fault) -> (Range<usize>, String) {
    const END: &str = "found the end of the file";
    let at = token::skip_trivia(text, fault.place.start);
    match token::unclosed(text) {
        Some(Unclosed::String(start)) if start <= at => (
            start..start + 1,
            format!("expected a `\"` where this string ends, {END}"),
        ),
        Some(Unclosed::Comment(start)) if start <= at => (
            start..start + 2,
            format!("expected a `*/` where this comment ends, {END}"),
        ),
        Some(Unclosed::Bracket(start)) if at == text.len() => {
            let (line, column) = line_and_column(text, start);
            let (opening, closing) = match text.as_bytes()[start] {
                b'(' => ('(', ')'),
                b'[' => ('[', ']'),
                _ => ('{', '}'),
            };
            let expected = format!("`{closing}` for the `{opening}` at {line}:{column}");
            (at..at, format!("expected {expected}, {END}"))
        }
        _ if at == text.len() => (at..at, format!("{}, {END}", fault.message)),
        _ => {
            let place = at..token::token_end(text, at);
            let found = show(&text[place.clone()]);
            (place, format!("{}, found {found}", fault.message))
        }
    }
}

/// Line and column of a byte, both from 1, the column in characters.
pub(super) fn line_and_column(text: &str, at: usize) -> (usize, usize) {
    let before = &text[..at];
    let line_start = before.rfind('\n').map_or(0, |newline| newline + 1);
    let newlines = before.bytes().filter(|&byte| byte == b'\n').count();
    (newlines + 1, before[line_start..].chars().count() + 1)
}
