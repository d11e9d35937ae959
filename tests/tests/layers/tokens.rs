//! The tokens of a Rust file, as far as imports need them.

/// A word, a sign or a number, and its line from 1.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub(crate) struct Token<'t> {
    pub(crate) text: &'t str,
    pub(crate) line: usize,
}

impl Token<'_> {
    pub(crate) fn is_word(&self) -> bool {
        self.text.starts_with(is_word_start)
    }
}

/// The tokens of `source`. `::` is one token; comments, lifetimes, character literals and strings are not tokens.
pub(crate) fn tokens(source: &str) -> Vec<Token<'_>> {
    let mut tokens = Vec::new();
    let (mut rest, mut line) = (source, 1);
    while let Some(first) = rest.chars().next() {
        let (length, is_token) = token(rest, first);
        let (text, after) = rest.split_at(length);
        if is_token {
            let text = text.strip_prefix("r#").unwrap_or(text);
            tokens.push(Token { text, line });
        }
        line += text.matches('\n').count();
        rest = after;
    }
    tokens
}

/// The length of the first element of `rest`, and whether it is a token.
fn token(rest: &str, first: char) -> (usize, bool) {
    if rest.starts_with("//") {
        return (rest.find('\n').unwrap_or(rest.len()), false);
    }
    if rest.starts_with("/*") {
        return (block_comment(rest), false);
    }
    if let Some(length) = text(rest) {
        return (length, false);
    }
    if rest.starts_with("b'") {
        return (1 + quoted(&rest[1..], '\''), false);
    }
    if first == '\'' {
        let mut letters = rest[1..].chars();
        let (one, two) = (letters.next(), letters.next());
        let is_character = one == Some('\\') || two == Some('\'');
        let lifetime = 1 + word_length(&rest[1..]);
        return (
            if is_character {
                quoted(rest, '\'')
            } else {
                lifetime
            },
            false,
        );
    }
    if is_word_start(first) {
        let raw = if rest.starts_with("r#") { 2 } else { 0 };
        return (raw + word_length(&rest[raw..]), true);
    }
    if first.is_ascii_digit() {
        return (number_length(rest), true);
    }
    let length = if rest.starts_with("::") {
        2
    } else {
        first.len_utf8()
    };
    (length, !first.is_whitespace())
}

fn is_word_start(letter: char) -> bool {
    letter.is_alphabetic() || letter == '_'
}

fn word_length(rest: &str) -> usize {
    let is_end = |letter: char| !letter.is_alphanumeric() && letter != '_';
    rest.find(is_end).unwrap_or(rest.len())
}

/// A number with a fraction continues after its point; a range and the name of a method do not belong to it.
fn number_length(rest: &str) -> usize {
    let whole = word_length(rest);
    let fraction = rest[whole..].strip_prefix('.');
    let fraction = fraction.filter(|after| after.starts_with(|c: char| c.is_ascii_digit()));
    whole + fraction.map_or(0, |fraction| 1 + word_length(fraction))
}

fn block_comment(rest: &str) -> usize {
    let (mut depth, mut at) = (0, 0);
    while at < rest.len() {
        let tail = &rest.as_bytes()[at..];
        let (step, change) = match tail {
            [b'/', b'*', ..] => (2, 1),
            [b'*', b'/', ..] => (2, -1),
            _ => (1, 0),
        };
        depth += change;
        at += step;
        if depth == 0 {
            break;
        }
    }
    at
}

/// The length of the string literal, plain or raw, that `rest` starts with.
fn text(rest: &str) -> Option<usize> {
    let prefix = rest.find(|letter| !matches!(letter, 'b' | 'c' | 'r'))?;
    let (letters, behind) = rest.split_at(prefix);
    if !matches!(letters, "" | "b" | "c" | "r" | "br" | "cr") {
        return None;
    }
    if !letters.ends_with('r') {
        return behind
            .starts_with('"')
            .then(|| prefix + quoted(behind, '"'));
    }
    let inside = behind.trim_start_matches('#');
    let hashes = behind.len() - inside.len();
    let inside = inside.strip_prefix('"')?;
    let closing = format!("\"{}", "#".repeat(hashes));
    let length = inside.find(&closing).unwrap_or(inside.len());
    Some((prefix + hashes + 1 + length + closing.len()).min(rest.len()))
}

/// The length up to the closing quotation mark, which is not preceded by a backslash.
fn quoted(rest: &str, mark: char) -> usize {
    let mut is_escaped = false;
    for (at, letter) in rest.char_indices().skip(1) {
        match letter {
            _ if is_escaped => is_escaped = false,
            '\\' => is_escaped = true,
            _ if letter == mark => return at + 1,
            _ => {}
        }
    }
    rest.len()
}

#[test]
fn comments_texts_and_lifetimes_are_no_tokens() {
    let source =
        "a /* b /* c */ */ 'd' &'e f '\\'' \"g\\\"\" r#\"h\"\"# // i\nr#j::k 1.5..2 b'\\n'";
    let found: Vec<_> = tokens(source).iter().map(|token| token.text).collect();
    assert_eq!(found, ["a", "&", "f", "j", "::", "k", "1.5", ".", ".", "2"]);
    assert_eq!(tokens("a\n\"\n\"\nb")[1].line, 4);
}
