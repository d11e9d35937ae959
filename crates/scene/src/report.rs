//! Messages for people: where a fault lies, what it is, and the line of the file.

use std::path::Path;

use annotate_snippets::renderer::Effects;
use annotate_snippets::{AnnotationKind, Group, Level, Renderer, Snippet};

use crate::error::SceneFault;
use crate::fault::{Fault, show};
use crate::table::{TableFault, TablePlace};
use crate::token::{self, Unclosed};

/// How many faults are told.
const MOST_FAULTS: usize = 10;

/// For a file or for a terminal.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub(crate) enum Style {
    Plain,
    Styled,
}

/// Faults in the order of the text, with lines and columns.
pub(crate) struct Located {
    faults: Vec<(SceneFault, std::ops::Range<usize>)>,
    untold: usize,
}

/// Finds out where the first faults lie.
pub(crate) fn locate(text: &str, mut faults: Vec<Fault>) -> Located {
    faults.sort_by_key(|fault| fault.place.start);
    faults.dedup();
    let untold = faults.len().saturating_sub(MOST_FAULTS);
    faults.truncate(MOST_FAULTS);
    let faults = faults
        .into_iter()
        .map(|fault| locate_one(text, fault))
        .collect();
    Located { faults, untold }
}

impl Located {
    /// The complete message about the file at `path` with this text.
    pub(crate) fn message(&self, path: &Path, text: &str, style: Style) -> String {
        let mut parts: Vec<String> = self
            .faults
            .iter()
            .map(|(fault, place)| {
                let position = Position::Line(fault.line as u64, fault.column);
                let header = header(path, &position, &fault.message, style);
                match snippet(text, place.clone(), fault.line as u64, style) {
                    Some(snippet) => format!("{header}\n{snippet}"),
                    None => header,
                }
            })
            .collect();
        match self.untold {
            0 => {}
            1 => parts.push(String::from("and 1 more fault")),
            untold => parts.push(format!("and {untold} more faults")),
        }
        parts.join("\n\n")
    }

    pub(crate) fn into_faults(self) -> Vec<SceneFault> {
        self.faults.into_iter().map(|(fault, _)| fault).collect()
    }
}

/// A place in a file, as a message says it.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Position {
    /// Line and column.
    Line(u64, usize),
    /// In a binary table.
    Row { row: u64, column: usize, byte: u64 },
    /// The file as a whole.
    None,
}

/// The complete message about a fault in a line of the table at `path`.
pub(crate) fn in_line(path: &Path, fault: &TableFault, style: Style) -> String {
    let TablePlace::Text { line, text, span } = &fault.place else {
        return header(path, &Position::None, &fault.message, style);
    };
    let column = text[..span.start].chars().count() + 1;
    let header = header(path, &Position::Line(*line, column), &fault.message, style);
    match snippet(text, span.clone(), *line, style) {
        Some(snippet) => format!("{header}\n{snippet}"),
        None => header,
    }
}

/// The line that starts a message.
pub(crate) fn header(path: &Path, position: &Position, message: &str, style: Style) -> String {
    let path = path.display();
    let place = match position {
        Position::Line(line, column) => format!("{path}:{line}:{column}:"),
        Position::Row { row, column, byte } => {
            format!("{path}: row {row}, column {column}, byte {byte}:")
        }
        Position::None => format!("{path}:"),
    };
    match style {
        Style::Plain => format!("{place} {message}"),
        Style::Styled => {
            let bold = annotate_snippets::renderer::Style::new().effects(Effects::BOLD);
            format!("{bold}{place}{bold:#} {message}")
        }
    }
}

fn locate_one(text: &str, fault: Fault) -> (SceneFault, std::ops::Range<usize>) {
    let (place, message) = if fault.found_is_open {
        with_found(text, fault)
    } else {
        (fault.place, fault.message)
    };
    let (line, column) = position(text, place.start);
    let fault = SceneFault {
        line,
        column,
        message,
    };
    (fault, place)
}

/// The place and the message of a fault that still lacks what was found.
///
/// Where the text ends before its time, what was left open is more telling than the end.
fn with_found(text: &str, fault: Fault) -> (std::ops::Range<usize>, String) {
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
            let (line, column) = position(text, start);
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
pub(crate) fn position(text: &str, at: usize) -> (usize, usize) {
    let before = &text[..at];
    let line_start = before.rfind('\n').map_or(0, |newline| newline + 1);
    let newlines = before.bytes().filter(|&byte| byte == b'\n').count();
    (newlines + 1, before[line_start..].chars().count() + 1)
}

/// The line of the text with the place underlined; `None` where there is nothing to see.
fn snippet(text: &str, place: std::ops::Range<usize>, line: u64, style: Style) -> Option<String> {
    const BEFORE: usize = 50;
    const AFTER: usize = 70;
    const WIDER_THAN_THE_WINDOW: usize = 1000;
    let line_start = text[..place.start]
        .rfind('\n')
        .map_or(0, |newline| newline + 1);
    let line_end = text[place.start..]
        .find(['\n', '\r'])
        .map_or(text.len(), |at| place.start + at);
    let window_start = text[line_start..place.start]
        .char_indices()
        .rev()
        .nth(BEFORE)
        .map_or(line_start, |(at, _)| line_start + at);
    let window_end = text[place.start..line_end]
        .char_indices()
        .nth(AFTER)
        .map_or(line_end, |(at, _)| place.start + at);
    if text[window_start..window_end].trim().is_empty() {
        return None;
    }
    let mut source = String::new();
    if window_start > line_start {
        source.push('…');
    }
    let shown_start = source.len() + (place.start - window_start);
    source.push_str(&text[window_start..window_end]);
    let shown_end = shown_start + (place.end.min(window_end) - place.start.min(window_end));
    if window_end < line_end {
        source.push('…');
    }
    let renderer = match style {
        Style::Plain => Renderer::plain(),
        Style::Styled => Renderer::styled(),
    }
    .term_width(WIDER_THAN_THE_WINDOW);
    let snippet = Snippet::source(source)
        .line_start(usize::try_from(line).unwrap_or(usize::MAX))
        .annotation(AnnotationKind::Primary.span(shown_start..shown_end));
    Some(renderer.render(&[Group::with_level(Level::ERROR).element(snippet)]))
}
