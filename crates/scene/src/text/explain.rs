//! The errors of `ron`, in this program's words.

use std::ops::Range;

use ron::error::{Error, Position, SpannedError};

use super::fault::{Fault, Names};
use super::show::show;
use super::slice::Slice;
use super::suggest::{did_you_mean, either};
use super::token::{self, Unclosed};

/// The fault that `ron` found in `slice`, which should have been what `names` says.
pub(super) fn explain(error: &SpannedError, slice: Slice<'_>, names: Names) -> Fault {
    let text = slice.text;
    let found = Found {
        slice,
        names,
        start: token::skip_trivia(text, offset(text, error.span.start)),
        stop: token::skip_trivia(text, offset(text, error.span.end)),
    };
    let about_names = found.about_names(&error.code);
    about_names.unwrap_or_else(|| found.about_syntax(&error.code))
}

/// The place at which `ron` stopped.
struct Found<'t> {
    slice: Slice<'t>,
    names: Names,
    /// The start of ron's span, which begins before the white space in front of the offending token.
    start: usize,
    /// The end of ron's span: the token that it did not expect, or the end of what it refused.
    stop: usize,
}

impl Found<'_> {
    /// The fault where fields, variants or structures have other names than expected.
    fn about_names(&self, error: &Error) -> Option<Fault> {
        let (text, start) = (self.slice.text, self.start);
        let message = match error {
            Error::MissingStructField { field, outer } => {
                let whole = self.whole(outer.as_deref());
                let message = format!("expected `{field}` in this {whole}, found none");
                return Some(Fault::new(first_line(self.slice), message));
            }
            Error::NoSuchStructField {
                expected,
                found,
                outer,
            } => {
                let whole = self.whole(outer.as_deref());
                let found_token = show(&text[start..token::token_end(text, start)]);
                let mut meant = did_you_mean(found, expected.iter().copied(), show);
                if meant.is_empty() {
                    meant = known_elsewhere(found, expected);
                }
                let known = match meant.is_empty() {
                    true => format!(" ({})", either(expected.iter().copied())),
                    false => String::new(),
                };
                format!("expected a field of this {whole}{known}, found {found_token}{meant}")
            }
            Error::DuplicateStructField { field, .. } => {
                format!("expected every field once, found `{field}` a second time")
            }
            Error::NoSuchEnumVariant {
                expected, found, ..
            } => {
                let known = || expected.iter().copied();
                let (kind, list) = (self.names.kind(), either(known()));
                let meant = did_you_mean(found, known(), show);
                format!("expected {kind} ({list}), found {}{meant}", show(found))
            }
            Error::ExpectedDifferentStructName { expected, found } => {
                let behind = token::skip_trivia(text, token::token_end(text, start));
                let expected = if text[behind..].starts_with('(') {
                    format!("`{expected}(…)` or `(…)`")
                } else {
                    self.names.form.to_owned()
                };
                format!("expected {expected}, found {}", show(found))
            }
            Error::NoSuchExtension(name) => {
                format!("expected an extension of RON, found {}", show(name))
            }
            _ => return None,
        };
        Some(Fault::new(self.token(start), message))
    }

    /// The fault where the syntax is broken.
    fn about_syntax(&self, error: &Error) -> Fault {
        let (text, stop, names) = (self.slice.text, self.stop, self.names);
        let expected = match error {
            Error::ExpectedStructLike if is_end_of_name(&text[..stop]) => {
                return self.alone(token::last_token(text, stop));
            }
            Error::ExpectedIdentifier | Error::SuggestRawIdentifier(_)
                if stop == 0 || is_before_value(&text[..stop]) =>
            {
                names.form
            }
            Error::ExpectedStructLike | Error::ExpectedNamedStructLike(_) => names.form,
            Error::Eof => "more",
            Error::ExpectedArray => "a list `[…]`",
            Error::ExpectedArrayEnd => "`]`",
            Error::ExpectedMap => "materials by name `{…}`",
            Error::ExpectedMapColon if text[stop..].starts_with('=') => {
                let name = &text[token::last_token(text, stop)];
                let message = format!("expected `:`, found `=`; write `{name}: …`");
                return Fault::new(self.token(stop), message);
            }
            Error::ExpectedMapColon => "`:`",
            Error::ExpectedMapEnd => "`}`",
            Error::ExpectedStructLikeEnd | Error::ExpectedOptionEnd => "`)`",
            Error::ExpectedComma => {
                if let Some(end) = self.end_of_line_before() {
                    let expected = self.comma();
                    let message = format!("expected {expected}, found the end of the line");
                    return Fault::new(end..end, message);
                }
                &self.comma()
            }
            Error::ExpectedIdentifier
            | Error::InvalidIdentifier(_)
            | Error::SuggestRawIdentifier(_) => {
                &format!("the name of a field of this {}", names.noun)
            }
            Error::TrailingCharacters if names.noun == "scene" => "the end of the file",
            Error::TrailingCharacters => "`,`",
            Error::ExceededRecursionLimit => {
                let message = "expected a value, found brackets nested too deep";
                return Fault::new(self.token(stop), message);
            }
            Error::InvalidEscape(_) => {
                let message =
                    r#"expected an escape such as \\ or \" in this string, found another"#;
                return Fault::new(self.token(token::token_start(text, stop)), message);
            }
            Error::ExpectedAttribute if !text[self.start..].starts_with("#!") => {
                return self.expected_at(token::skip_trivia(text, 0), names.form);
            }
            Error::ExpectedAttribute | Error::ExpectedAttributeEnd => {
                "an attribute such as `#![enable(unwrap_newtypes)]`"
            }
            Error::FloatUnderscore
            | Error::UnderscoreAtBeginning
            | Error::ExpectedFloat
            | Error::ExpectedInteger
            | Error::IntegerOutOfBounds
            | Error::InvalidIntegerDigit { .. } => {
                let at = token::token_start(text, self.start.min(stop));
                return self.expected_at(at, "a number");
            }
            Error::ExpectedChar => {
                let quote = text[..stop].rfind('\'').unwrap_or(stop);
                return self.expected_at(quote, "a value (put strings between `\"`)");
            }
            _ if names.noun == "color" && text[stop..].starts_with('#') => {
                r##"a color "#rrggbb" in quotation marks"##
            }
            _ => "a value",
        };
        self.expected_at(stop, expected)
    }

    /// A comma, or what else may stand where one is missing.
    fn comma(&self) -> String {
        format!("`,`{}", or_closing_bracket(self.slice.text, self.stop))
    }

    /// The place behind the token before, in the whole text, where that is on an earlier line.
    fn end_of_line_before(&self) -> Option<usize> {
        let (text, stop) = (self.slice.text, self.stop);
        let end = token::last_token(text, stop).end;
        // A token may reach beyond the place where `ron` stopped.
        let between = text.get(end..stop).filter(|_| stop < text.len())?;
        between.contains('\n').then_some(self.slice.start + end)
    }

    /// The fault where a name stands without its `(…)`.
    fn alone(&self, place: Range<usize>) -> Fault {
        let name = &self.slice.text[place.clone()];
        if self.stop < self.slice.text.len() {
            return self.expected_at(self.stop, &format!("`(` after `{name}`"));
        }
        let place = self.slice.start + place.start..self.slice.start + place.end;
        Fault::new(place, format!("expected `{name}(…)`, found `{name}` alone"))
    }

    /// The fault that something else was expected than the token at `at`.
    fn expected_at(&self, at: usize, expected: &str) -> Fault {
        if self.slice.text[at..].starts_with('#') && self.names.noun != "color" {
            let message = format!("expected {expected}, found `#`; comments begin with `//`");
            return Fault::new(self.slice.start + at..self.slice.start + at + 1, message);
        }
        Fault::at_token(self.slice.start + at, format!("expected {expected}"))
    }

    /// The place of the token at `at` in the whole text.
    fn token(&self, at: usize) -> Range<usize> {
        self.slice.start + at..self.slice.start + token::token_end(self.slice.text, at)
    }

    /// The name of a variant, or else the noun of the structure.
    fn whole(&self, outer: Option<&str>) -> String {
        let is_variant = |name: &&str| self.names.form.contains(&format!("`{name}("));
        match outer.filter(is_variant) {
            Some(variant) => format!("`{variant}`"),
            None => self.names.noun.to_owned(),
        }
    }
}

/// Names that fields have in other renderers, the field that is meant, and how it is written.
const ELSEWHERE: [(&str, &str, &str); 4] = [
    ("fov", "lens", "`lens: Fov(…)`"),
    ("size", "image", "`image: (width: …, height: …)`"),
    ("position", "center", "`center`"),
    ("color", "albedo", "`albedo`"),
];

/// The end of a message where an unknown field is known by another name among the expected ones, or nothing.
fn known_elsewhere(found: &str, expected: &[&str]) -> String {
    let known = ELSEWHERE
        .iter()
        .find(|(name, field, _)| found.eq_ignore_ascii_case(name) && expected.contains(field));
    known.map_or_else(String::new, |(.., written)| {
        format!(", did you mean {written}?")
    })
}

/// Returns whether a value is due behind this text.
fn is_before_value(text: &str) -> bool {
    text.trim_end().ends_with(':')
}

/// Returns whether the text ends with a name, apart from white space.
fn is_end_of_name(text: &str) -> bool {
    text.trim_end().ends_with(|c: char| c.is_alphanumeric())
}

/// The place of a value that may span lines: all of it on one line, else its first token.
fn first_line(slice: Slice<'_>) -> Range<usize> {
    if slice.text.contains('\n') {
        slice.start..slice.start + token::token_end(slice.text, 0)
    } else {
        slice.place()
    }
}

/// " or `)`", the bracket that would close the one that is open before `stop`.
fn or_closing_bracket(text: &str, stop: usize) -> String {
    match token::unclosed(&text[..stop]) {
        Some(Unclosed::Bracket(at)) => {
            let closing = char::from(token::closing_bracket(text.as_bytes()[at]));
            format!(" or `{closing}`")
        }
        _ => String::new(),
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
    let mut characters = text[line_start..].char_indices();
    let character = characters.nth(position.col.saturating_sub(1));
    character.map_or(text.len(), |(at, _)| line_start + at)
}
