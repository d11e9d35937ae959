//! Pieces of a file as messages show them.

/// A piece of the text as a message shows it: short, and harmless to a terminal.
pub(crate) fn show(text: &str) -> String {
    const LONGEST: usize = 40;
    let mut shown = String::new();
    let mut characters = text.chars();
    for c in characters.by_ref().take(LONGEST) {
        if c.is_control() || turns_text(c) {
            shown.extend(c.escape_unicode());
        } else {
            shown.push(c);
        }
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

/// A name in quotation marks, as a message shows it.
pub(crate) fn quoted(name: &str) -> String {
    show(&format!("\"{name}\""))
}

/// Returns whether a character changes the direction of the text around it.
fn turns_text(c: char) -> bool {
    matches!(c, '\u{200e}'..='\u{200f}' | '\u{202a}'..='\u{202e}' | '\u{2066}'..='\u{2069}')
}
