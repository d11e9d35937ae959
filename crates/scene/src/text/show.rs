//! Pieces of a file, and words of the operating system, as messages show them.

use std::io;

/// A piece of the text as a message shows it: short, and harmless to a terminal.
pub(crate) fn show(text: &str) -> String {
    const LONGEST: usize = 40;
    let mut shown = String::new();
    let mut characters = text.chars();
    for c in characters.by_ref().take(LONGEST) {
        push_harmless(&mut shown, c);
    }
    if characters.next().is_some() {
        shown.push('…');
    }
    let is_plain = text.starts_with(|c: char| c == '"' || c.is_ascii_digit())
        || text.len() > 1 && text.starts_with(['-', '+', '.'])
        || matches!(text, "NaN" | "inf");
    if is_plain {
        shown
    } else {
        format!("`{shown}`")
    }
}

/// Makes a text from a file, or the name of a file, harmless to a terminal: characters that would move the cursor,
/// change colors or reverse text become escapes such as `\u{1b}`.
pub fn harmless(text: &str) -> String {
    let mut shown = String::new();
    for c in text.chars() {
        push_harmless(&mut shown, c);
    }
    shown
}

fn push_harmless(shown: &mut String, c: char) {
    if is_harmful(c) {
        shown.extend(c.escape_unicode());
    } else {
        shown.push(c);
    }
}

/// Returns whether a character does something to a terminal, but be shown.
pub(crate) fn is_harmful(c: char) -> bool {
    c.is_control() || turns_text(c)
}

/// A name in quotation marks, as a message shows it.
pub(crate) fn quoted(name: &str) -> String {
    show(&format!("\"{name}\""))
}

/// Returns whether a character changes the direction of the text around it.
fn turns_text(c: char) -> bool {
    matches!(c, '\u{200e}'..='\u{200f}' | '\u{202a}'..='\u{202e}' | '\u{2066}'..='\u{2069}')
}

/// The words of the operating system, without the number behind them and a capital letter before them.
pub(crate) fn reason(error: &io::Error) -> String {
    let words = error.to_string();
    let end = words.rfind(" (os error").unwrap_or(words.len());
    let mut letters = words[..end].chars();
    let first = letters.next().map(char::to_lowercase);
    first.into_iter().flatten().chain(letters).collect()
}
