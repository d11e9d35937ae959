//! Faults with their lines and columns.

use std::ops::Range;
use std::path::Path;

use super::snippet::{Style, Window, bold, snippet};
use crate::text::token::{self, Unclosed};
use crate::text::{Fault, LocatedFault, Place, harmless, show};

/// A fault at a place in a file.
///
/// # Example
/// ```
/// # use std::path::Path;
/// # use marbles_scene::Scene;
/// // Two faults, in the second line.
/// let text = "(image: (width: 64, height: 48), lens: Fov(40), camera: Free(),
/// spheres: [(center: (0, 0, 5), radius: -1)], shadows: maybe)";
/// let error = Scene::parse(text, Path::new("ball.ron")).unwrap_err();
/// let places: Vec<_> = error.faults().iter().map(|fault| (fault.line, fault.column)).collect();
/// assert_eq!(places, [(2, 39), (2, 54)]);
/// assert_eq!(error.faults()[0].value, "spheres[0].radius");
/// ```
#[derive(Clone, Debug, Eq, PartialEq)]
pub struct SceneFault {
    /// The line, from 1; in a binary table the row.
    pub line: usize,
    /// The column, in characters from 1; in a binary table the column of the table.
    pub column: usize,
    /// The message: what was expected, and what was found.
    pub message: String,
    /// The value of the scene file that it concerns, such as `lights[0].toward`; for a fault in a table, the cloud that names
    /// it. Empty for the whole file.
    pub value: String,
}

impl SceneFault {
    /// The fault as programs see it.
    pub(super) fn new(fault: &LocatedFault, value: String) -> Self {
        let (line, column) = match fault.place {
            Place::Text {
                line,
                ref text,
                ref span,
            } => (line, text[..span.start].chars().count() + 1),
            Place::Row { row, column, .. } => (row, column),
            Place::File => (1, 1),
        };
        Self {
            line: usize::try_from(line).unwrap_or(usize::MAX),
            column,
            message: fault.message.clone(),
            value,
        }
    }
}

/// The message about a fault in the file at `path`: its place, the fault, and the line.
pub(super) fn message(path: &Path, fault: &LocatedFault, style: Style, window: Window) -> String {
    let SceneFault { line, message, .. } = SceneFault::new(fault, String::new());
    let snippet = match &fault.place {
        Place::Text { text, span, .. } => snippet(text, span.clone(), line, style, window),
        Place::Row { .. } | Place::File => None,
    };
    let header = format!("{} {message}", bold(&place(path, fault), style));
    match snippet {
        Some(snippet) => format!("{header}\n{snippet}"),
        None => header,
    }
}

/// The place of a fault in the file at `path`, and its message.
pub(crate) fn in_a_line(path: &Path, fault: &LocatedFault) -> String {
    format!("{} {}", place(path, fault), fault.message)
}

/// The place of a fault in the file at `path`, with a colon behind it.
fn place(path: &Path, fault: &LocatedFault) -> String {
    let SceneFault { line, column, .. } = SceneFault::new(fault, String::new());
    let path = harmless(&path.to_string_lossy());
    match &fault.place {
        Place::Text { .. } => format!("{path}:{line}:{column}:"),
        Place::Row { byte, .. } => {
            let byte = byte.map(|byte| format!(", byte {byte}"));
            let byte = byte.unwrap_or_default();
            format!("{path}: row {line}, column {column}{byte}:")
        }
        Place::File => format!("{path}:"),
    }
}

/// A fault of the text of a scene file at its line.
pub(crate) fn locate(text: &str, fault: Fault) -> LocatedFault {
    let (place, message) = match fault.found_is_open {
        true => with_found(text, fault),
        false => (fault.place, fault.message),
    };
    let (line, _) = token::line_and_column(text, place.start);
    let (before, after) = text.split_at(place.start);
    let start = before.rfind('\n').map_or(0, |newline| newline + 1);
    let end = after.find(['\n', '\r']);
    let end = end.map_or(text.len(), |end| place.start + end);
    let span = place.start - start..place.end.min(end) - start;
    LocatedFault::in_line(line as u64, &text.as_bytes()[start..end], span, message)
}

/// The place and the message of a fault that still lacks what was found.
///
/// If the text ends before its time, the thing left open is more telling than the end.
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
            let expected = token::lacks_bracket(text, start);
            (at..at, format!("{expected}, {END}"))
        }
        _ if at == text.len() => (at..at, format!("{}, {END}", fault.message)),
        _ => {
            let place = at..token::token_end(text, at);
            let found = show(&text[place.clone()]);
            (place, format!("{}, found {found}", fault.message))
        }
    }
}
