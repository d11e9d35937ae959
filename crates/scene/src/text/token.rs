//! The places of the tokens of a text in RON.
//!
//! Values are read by `ron`; this module only finds places for messages: the value behind a
//! comment, the token at which a fault lies, the bracket that nobody closed. Any text will do,
//! valid or not, and every step is linear in what it passes over.

use std::ops::Range;

/// The first place at or after `from` that is neither white space nor in a comment.
pub(crate) fn skip_trivia(text: &str, from: usize) -> usize {
    let mut at = from;
    loop {
        let rest = &text[at..];
        let space = rest.len() - rest.trim_start_matches(is_white_space).len();
        at += space;
        match comment_length(&text[at..]) {
            Some(length) => at += length,
            None => return at,
        }
    }
}

/// The end of the token that starts at `start`, which is not in white space or a comment.
pub(crate) fn token_end(text: &str, start: usize) -> usize {
    let rest = &text[start..];
    let Some(first) = rest.chars().next() else {
        return start;
    };
    if let Some(length) = string_length(rest) {
        return start + length.min(rest.len());
    }
    // `r#name` is a name in RON, and `#rrggbb` is what a color without its quotation marks is.
    let prefix = match rest.as_bytes() {
        [b'r', b'#', ..] => 2,
        [b'#', ..] => 1,
        _ if is_word(first) => 0,
        _ => return start + first.len_utf8(),
    };
    let word = &rest[prefix..];
    start + prefix + word.find(|c| !is_word(c)).unwrap_or(word.len())
}

/// The tokens at and after `from`.
fn tokens(text: &str, from: usize) -> impl Iterator<Item = Range<usize>> {
    let mut end = from;
    std::iter::from_fn(move || {
        let start = skip_trivia(text, end);
        end = token_end(text, start);
        (start < end).then_some(start..end)
    })
}

/// The end of the value that starts at `start`: a token, and the brackets that belong to it.
pub(super) fn value_end(text: &str, start: usize) -> usize {
    let mut depth = 0_usize;
    let mut end = start;
    let mut tokens = tokens(text, start).peekable();
    while let Some(token) = tokens.next() {
        match text.as_bytes()[token.start] {
            b'(' | b'[' | b'{' => depth += 1,
            b')' | b']' | b'}' => depth = depth.saturating_sub(1),
            _ => {}
        }
        end = token.end;
        let opens = |next: &Range<usize>| text[next.start..].starts_with('(');
        if depth == 0 && !tokens.peek().is_some_and(opens) {
            break;
        }
    }
    end
}

/// The start of the token that holds `offset`, or the first after it.
pub(super) fn token_start(text: &str, offset: usize) -> usize {
    let token = tokens(text, 0).find(|token| token.end > offset);
    token.map_or(text.len(), |token| token.start)
}

/// The last token that starts before `offset`.
pub(super) fn last_token(text: &str, offset: usize) -> Range<usize> {
    let before = tokens(text, 0).take_while(|token| token.start < offset);
    before.last().unwrap_or(0..0)
}

/// The name of the field whose value starts at `value`, in the structure that starts at `start`.
pub(crate) fn field_name(text: &str, start: usize, value: usize) -> Range<usize> {
    let before = tokens(text, start).take_while(|token| token.start < value);
    let words = before.filter(|token| text[token.start..].starts_with(is_word));
    words.last().unwrap_or(start..start)
}

/// The start of something that a text opens and does not close.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub(crate) enum Unclosed {
    /// The innermost bracket.
    Bracket(usize),
    /// A string.
    String(usize),
    /// A comment between `/*` and `*/`.
    Comment(usize),
}

/// The string, comment or bracket that the text opens and does not close, if any.
pub(crate) fn unclosed(text: &str) -> Option<Unclosed> {
    let mut open = Vec::new();
    let mut end = 0;
    for token in tokens(text, 0) {
        let rest = &text[token.start..];
        match rest.as_bytes()[0] {
            b'(' | b'[' | b'{' => open.push(token.start),
            b')' | b']' | b'}' => {
                open.pop();
            }
            _ => {}
        }
        if string_length(rest).is_some_and(|length| length > rest.len()) {
            return Some(Unclosed::String(token.start));
        }
        end = token.end;
    }
    let comment = unclosed_comment(text, end).map(Unclosed::Comment);
    comment.or(open.pop().map(Unclosed::Bracket))
}

/// The start of a bracket that is not closed where it should be, and that of the token which tells so: a closing
/// bracket of another kind, or in a list the name of a field.
pub(super) fn missing_bracket(text: &str) -> Option<(usize, usize)> {
    let mut open: Vec<usize> = Vec::new();
    let mut tokens = tokens(text, 0).peekable();
    while let Some(token) = tokens.next() {
        let kind = |at: usize| text.as_bytes()[at];
        let is_in_list = open.last().is_some_and(|&at| kind(at) == b'[');
        let is_name = |token: &Range<usize>| text[token.start..].starts_with(is_word);
        match kind(token.start) {
            b'(' | b'[' | b'{' => open.push(token.start),
            closing @ (b')' | b']' | b'}') => {
                let &start = open.last()?;
                if closing != closing_bracket(kind(start)) {
                    return Some((start, token.start));
                }
                open.pop();
            }
            _ if is_in_list
                && is_name(&token)
                && tokens.peek().is_some_and(|next| kind(next.start) == b':') =>
            {
                return Some((*open.last()?, token.start));
            }
            _ => {}
        }
    }
    None
}

/// The bracket that closes this one.
pub(crate) fn closing_bracket(opening: u8) -> u8 {
    match opening {
        b'(' => b')',
        b'[' => b']',
        _ => b'}',
    }
}

/// Line and column of a byte, both from 1, the column in characters.
pub(crate) fn line_and_column(text: &str, at: usize) -> (usize, usize) {
    let before = &text[..at];
    let line_start = before.rfind('\n').map_or(0, |newline| newline + 1);
    let newlines = before.bytes().filter(|&byte| byte == b'\n').count();
    (newlines + 1, before[line_start..].chars().count() + 1)
}

/// The words that a bracket which opens at `start` lacks the one that closes it.
pub(crate) fn lacks_bracket(text: &str, start: usize) -> String {
    let (line, column) = line_and_column(text, start);
    let opening = text.as_bytes()[start];
    let (opening, closing) = (char::from(opening), char::from(closing_bracket(opening)));
    format!("expected `{closing}` for the `{opening}` at {line}:{column}")
}

/// White space as `ron` has it.
pub(super) fn is_white_space(c: char) -> bool {
    matches!(c, '\t'..='\r' | ' ' | '\u{85}' | '\u{200E}'..='\u{200F}' | '\u{2028}'..='\u{2029}')
}

/// Characters of names and numbers.
fn is_word(c: char) -> bool {
    c.is_alphanumeric() || matches!(c, '_' | '.' | '+' | '-')
}

/// The length of the comment at the start of `rest`; all of it where the comment has no end.
fn comment_length(rest: &str) -> Option<usize> {
    if rest.starts_with("//") {
        return Some(rest.find('\n').map_or(rest.len(), |at| at + 1));
    }
    block_comment(rest).map(|(length, _)| length)
}

/// The length of the block comment at the start of `rest`, and whether it has an end.
fn block_comment(rest: &str) -> Option<(usize, bool)> {
    if !rest.starts_with("/*") {
        return None;
    }
    let bytes = rest.as_bytes();
    let (mut depth, mut at) = (0_usize, 0);
    while at < bytes.len() {
        match bytes[at..] {
            [b'/', b'*', ..] => {
                depth += 1;
                at += 2;
            }
            [b'*', b'/', ..] => {
                depth -= 1;
                at += 2;
                if depth == 0 {
                    return Some((at, true));
                }
            }
            _ => at += 1,
        }
    }
    Some((rest.len(), false))
}

/// The start of the block comment without an end among the trivia at `from`.
fn unclosed_comment(text: &str, from: usize) -> Option<usize> {
    let mut at = from;
    loop {
        let rest = &text[at..];
        at += rest.len() - rest.trim_start_matches(is_white_space).len();
        if let Some((_, false)) = block_comment(&text[at..]) {
            return Some(at);
        }
        at += comment_length(&text[at..])?;
    }
}

/// The length of the string at the start of `rest`, plain or raw; more than `rest` has where the
/// string has no end.
fn string_length(rest: &str) -> Option<usize> {
    let endless = rest.len() + 1;
    if let Some(inside) = rest.strip_prefix('"') {
        let mut escaped = false;
        for (at, byte) in inside.bytes().enumerate() {
            match byte {
                _ if escaped => escaped = false,
                b'\\' => escaped = true,
                b'"' => return Some(at + 2),
                _ => {}
            }
        }
        return Some(endless);
    }
    let hashes_and_more = rest.strip_prefix('r')?;
    let inside = hashes_and_more.trim_start_matches('#');
    let hashes = hashes_and_more.len() - inside.len();
    let inside = inside.strip_prefix('"')?;
    let closing = format!("\"{}", "#".repeat(hashes));
    let opening = 1 + hashes + 1;
    Some(
        inside
            .find(&closing)
            .map_or(endless, |at| opening + at + closing.len()),
    )
}

#[cfg(test)]
mod tests;
