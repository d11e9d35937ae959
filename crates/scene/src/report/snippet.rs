//! The line of a file with a place in it underlined.

use std::ops::Range;

use annotate_snippets::renderer::Effects;
use annotate_snippets::{AnnotationKind, Group, Level, Renderer, Snippet, renderer};

use crate::text::is_harmful;

/// The kind of a message: for a file or for a terminal.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub(super) enum Style {
    Plain,
    Styled,
}

/// The part of a long line that is shown: characters before and after the start of the place.
#[derive(Clone, Copy, Debug)]
pub(super) struct Window {
    before: usize,
    after: usize,
}

impl Window {
    /// For readers of whom nothing is known.
    pub(super) const WIDE: Self = Self {
        before: 50,
        after: 70,
    };

    /// No more than what a terminal with so many columns has room for.
    pub(super) fn of_columns(columns: usize) -> Self {
        /// Columns of the number of the line, its edge and two marks for what is cut off.
        const BESIDE: usize = 12;
        let room = columns.saturating_sub(BESIDE).max(BESIDE);
        let before = Self::WIDE.before.min(2 * room / 5);
        Self {
            before,
            after: Self::WIDE.after.min(room - before),
        }
    }
}

/// The text in bold letters, in a terminal.
pub(super) fn bold(text: &str, style: Style) -> String {
    match style {
        Style::Plain => text.to_owned(),
        Style::Styled => {
            let bold = renderer::Style::new().effects(Effects::BOLD);
            format!("{bold}{text}{bold:#}")
        }
    }
}

/// The line of this number with the place underlined; `None` where there is nothing to see.
pub(super) fn snippet(
    text: &str,
    place: Range<usize>,
    line: usize,
    style: Style,
    window: Window,
) -> Option<String> {
    const WIDER_THAN_THE_WINDOW: usize = 1000;
    let (before, after) = text.split_at(place.start);
    let line_end = after.find(['\n', '\r']).unwrap_or(after.len());
    let mut characters = before.char_indices().rev();
    let start = characters.nth(window.before).map_or(0, |(at, _)| at);
    let mut characters = after[..line_end].char_indices();
    let end = characters.nth(window.after).map_or(line_end, |(at, _)| at);
    let (before, after) = (&before[start..], &after[..end]);
    if before.trim().is_empty() && after.trim().is_empty() {
        return None;
    }
    let cut = |is_cut: bool| if is_cut { "…" } else { "" };
    let (opening, closing) = (cut(start > 0), cut(end < line_end));
    let (inside, after) = after.split_at(place.len().min(end));
    let [before, inside, after] = [before, inside, after].map(replaced);
    let source = format!("{opening}{before}{inside}{after}{closing}");
    let shown_start = opening.len() + before.len();
    let shown = shown_start..shown_start + inside.len();
    let renderer = match style {
        Style::Plain => Renderer::plain(),
        Style::Styled => Renderer::styled(),
    };
    let snippet = Snippet::source(source)
        .line_start(line)
        .annotation(AnnotationKind::Primary.span(shown));
    let group = Group::with_level(Level::ERROR).element(snippet);
    Some(renderer.term_width(WIDER_THAN_THE_WINDOW).render(&[group]))
}

/// A part of a line in which a mark stands for each character that would do something to a terminal.
fn replaced(text: &str) -> String {
    let characters = text.chars().map(|c| match is_harmful(c) && c != '\t' {
        true => '\u{fffd}',
        false => c,
    });
    characters.collect()
}
