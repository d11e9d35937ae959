//! What `ron` says about a file, in this program's words.

use ron::error::{Error, Position, SpannedError};

use crate::fault::{Fault, Names, Slice, show};
use crate::suggest::{closest, either};
use crate::token;

/// The fault that `ron` found in `slice`, which should have been what `names` says.
pub(crate) fn explain(error: &SpannedError, slice: Slice<'_>, names: Names) -> Fault {
    let text = slice.text;
    // ron's span starts before the white space in front of the offending token, and ends where it
    // stopped reading: at the token that it did not expect, or after the one that it refused.
    let start = token::skip_trivia(text, offset(text, error.span.start));
    let stop = token::skip_trivia(text, offset(text, error.span.end));
    let token_at = |at: usize| slice.start + at..slice.start + token::token_end(text, at);
    let at_stop =
        |expected: &str| Fault::at_token(slice.start + stop, format!("expected {expected}"));
    let at_start = |expected: &str| {
        let at = token::token_start(text, start.min(stop));
        Fault::at_token(slice.start + at, format!("expected {expected}"))
    };
    match &error.code {
        Error::MissingStructField { field, outer } => {
            let whole = whole(outer.as_deref(), names);
            Fault::new(
                first_line(slice),
                format!("expected `{field}` in this {whole}, found none"),
            )
        }
        Error::NoSuchStructField {
            expected,
            found,
            outer,
        } => {
            let whole = whole(outer.as_deref(), names);
            let list = either(expected.iter().copied());
            let found_token = &text[start..token::token_end(text, start)];
            let message = match closest(found, expected.iter().copied()) {
                Some(close) => format!(
                    "expected a field of this {whole}, found {}, did you mean `{close}`?",
                    show(found_token)
                ),
                None => format!(
                    "expected a field of this {whole} ({list}), found {}",
                    show(found_token)
                ),
            };
            Fault::new(token_at(start), message)
        }
        Error::DuplicateStructField { field, .. } => Fault::new(
            token_at(start),
            format!("expected every field once, found `{field}` a second time"),
        ),
        Error::NoSuchEnumVariant {
            expected, found, ..
        } => {
            let kind = names.kind();
            let list = either(expected.iter().copied());
            let mut message = format!("expected {kind} ({list}), found {}", show(found));
            if let Some(close) = closest(found, expected.iter().copied()) {
                message += &format!(", did you mean `{close}`?");
            }
            Fault::new(token_at(start), message)
        }
        Error::ExpectedDifferentStructName { expected, found } => {
            let stop = token::skip_trivia(text, token::token_end(text, start));
            let expected = if text[stop..].starts_with('(') {
                format!("`{expected}(…)` or `(…)`")
            } else {
                String::from(names.form)
            };
            let found = show(found);
            Fault::new(
                token_at(start),
                format!("expected {expected}, found {found}"),
            )
        }
        Error::ExpectedStructLike if is_end_of_name(&text[..stop]) => {
            let name = token::last_token(text, stop);
            let place = slice.start + name.start..slice.start + name.end;
            let name = &text[name];
            if stop == text.len() {
                let message = format!("expected `{name}(…)`, found `{name}` alone");
                Fault::new(place, message)
            } else {
                at_stop(&format!("`(` after `{name}`"))
            }
        }
        Error::ExpectedIdentifier | Error::SuggestRawIdentifier(_)
            if stop == 0 || is_before_value(&text[..stop]) =>
        {
            at_stop(names.form)
        }
        Error::ExpectedStructLike | Error::ExpectedNamedStructLike(_) => at_stop(names.form),
        Error::Eof => at_stop("more"),
        Error::ExpectedArray => at_stop("a list `[…]`"),
        Error::ExpectedArrayEnd => at_stop("`]`"),
        Error::ExpectedMap => at_stop("materials by name `{…}`"),
        Error::ExpectedMapColon => at_stop("`:`"),
        Error::ExpectedMapEnd => at_stop("`}`"),
        Error::ExpectedStructLikeEnd | Error::ExpectedOptionEnd => at_stop("`)`"),
        Error::ExpectedComma => at_stop(&format!("`,`{}", or_closing_bracket(text, stop))),
        Error::ExpectedIdentifier
        | Error::InvalidIdentifier(_)
        | Error::SuggestRawIdentifier(_) => {
            at_stop(&format!("the name of a field of this {}", names.noun))
        }
        Error::TrailingCharacters if names.noun == "scene" => at_stop("the end of the file"),
        Error::TrailingCharacters => at_stop("`,`"),
        Error::ExceededRecursionLimit => Fault::new(
            token_at(stop),
            String::from("expected a value, found brackets nested too deep"),
        ),
        Error::InvalidEscape(_) => Fault::new(
            token_at(token::token_start(text, stop)),
            String::from(r#"expected an escape such as \\ or \" in this string, found another"#),
        ),
        Error::NoSuchExtension(name) => Fault::new(
            token_at(start),
            format!("expected an extension of RON, found {}", show(name)),
        ),
        Error::ExpectedAttribute | Error::ExpectedAttributeEnd => {
            at_stop("an attribute such as `#![enable(unwrap_newtypes)]`")
        }
        Error::FloatUnderscore
        | Error::UnderscoreAtBeginning
        | Error::ExpectedFloat
        | Error::ExpectedInteger
        | Error::IntegerOutOfBounds
        | Error::InvalidIntegerDigit { .. } => at_start("a number"),
        Error::ExpectedChar => {
            let quote = text[..stop].rfind('\'').unwrap_or(stop);
            let expected = String::from("expected a value (a string stands between `\"`)");
            Fault::at_token(slice.start + quote, expected)
        }
        _ if names.noun == "color" && text[stop..].starts_with('#') => {
            at_stop(r##"a color "#rrggbb" in quotation marks"##)
        }
        _ => at_stop("a value"),
    }
}

/// The name of a variant, or else the noun of the structure.
fn whole(outer: Option<&str>, names: Names) -> String {
    match outer {
        Some(variant) if names.form.contains(&format!("`{variant}(")) => format!("`{variant}`"),
        _ => String::from(names.noun),
    }
}

/// Whether a value is due behind this text.
fn is_before_value(text: &str) -> bool {
    text.trim_end().ends_with(':')
}

/// Whether the text ends with a name, apart from white space.
fn is_end_of_name(text: &str) -> bool {
    text.trim_end().ends_with(|c: char| c.is_alphanumeric())
}

/// The place of a value that may span lines: all of it on one line, else its first token.
fn first_line(slice: Slice<'_>) -> std::ops::Range<usize> {
    if slice.text.contains('\n') {
        slice.start..slice.start + token::token_end(slice.text, 0)
    } else {
        slice.place()
    }
}

/// " or `)`", the bracket that would close the one that is open before `stop`.
fn or_closing_bracket(text: &str, stop: usize) -> &'static str {
    match token::unclosed(&text[..stop]) {
        Some(token::Unclosed::Bracket(at)) => match text.as_bytes()[at] {
            b'(' => " or `)`",
            b'[' => " or `]`",
            _ => " or `}`",
        },
        _ => "",
    }
}

/// The byte at a position of ron's, whose lines and columns count characters from 1.
fn offset(text: &str, position: Position) -> usize {
    let mut line_start = 0;
    for _ in 1..position.line {
        match text[line_start..].find('\n') {
            Some(at) => line_start += at + 1,
            None => return text.len(),
        }
    }
    text[line_start..]
        .char_indices()
        .nth(position.col.saturating_sub(1))
        .map_or(text.len(), |(at, _)| line_start + at)
}
