//! Values that know where they stand in the file.

use std::ops::Range;

use ron::error::Error;
use serde::de::IgnoredAny;
use serde::{Deserialize, Deserializer};

use super::explain::explain;
use super::fault::{self, Fault, Names};
use super::raw::raw_text;
use super::slice::Slice;
use super::token;

/// A value that can be read from a part of the text.
pub(crate) trait Read<'t>: Sized {
    /// Reads the value from the whole of `slice`; reports why not where it returns `None`.
    fn read(slice: Slice<'t>) -> Option<Self>;

    /// Reads the value without leave to fail in silence: what is wrong in its structure is an
    /// error. Numbers and the like have no structure and are passed over.
    fn read_strictly<D: Deserializer<'t>>(deserializer: D) -> Result<Option<Self>, D::Error> {
        IgnoredAny::deserialize(deserializer).map(|_| None)
    }
}

/// A value and its place.
///
/// Whatever stands there is read without failing, so that the rest of the file is read too:
/// `value` is `None` where a fault has been reported.
#[derive(Clone, Debug)]
pub(crate) struct Placed<T> {
    /// The place, in bytes of the text; empty for a value that was left out.
    pub(crate) place: Range<usize>,
    /// The value, unless it was refused.
    pub(crate) value: Option<T>,
}

impl<T: Copy> Placed<T> {
    /// The value, unless it was refused.
    pub(crate) fn get(&self) -> Option<T> {
        self.value
    }
}

impl<T> From<T> for Placed<T> {
    /// The value of a field that was left out.
    fn from(value: T) -> Self {
        Self {
            place: 0..0,
            value: Some(value),
        }
    }
}

impl<T: Default> Default for Placed<T> {
    fn default() -> Self {
        Self::from(T::default())
    }
}

impl<'de, T: Read<'de>> Deserialize<'de> for Placed<T> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        if fault::is_strict() {
            return T::read_strictly(deserializer).map(|value| Self { place: 0..0, value });
        }
        let slice = without_trivia(raw_text(deserializer)?);
        Ok(Self {
            place: slice.place(),
            value: T::read(slice),
        })
    }
}

/// A raw value without the white space and the comments around it.
fn without_trivia(raw: &str) -> Slice<'_> {
    let start = token::skip_trivia(raw, 0);
    let end = if raw.contains('/') {
        token::value_end(raw, start)
    } else {
        raw.trim_end_matches(token::is_white_space).len()
    };
    Slice::of_text_being_read(&raw[start..end])
}

/// The result of `make` for a field that may be left out; `None` where a fault was reported.
pub(crate) fn optional<T, U>(
    field: &Option<Placed<T>>,
    make: impl FnOnce(&T) -> Option<U>,
) -> Option<Option<U>> {
    match field {
        Some(field) => make(field.value.as_ref()?).map(Some),
        None => Some(None),
    }
}

/// Reads a field that may be left out but not be `None`.
pub(crate) fn present<'de, D: Deserializer<'de>, T: Deserialize<'de>>(
    deserializer: D,
) -> Result<Option<T>, D::Error> {
    T::deserialize(deserializer).map(Some)
}

/// Reads a structure or an enumeration.
pub(crate) fn read_structure<'t, T: Deserialize<'t>>(slice: Slice<'t>, names: Names) -> Option<T> {
    match parse(slice.text) {
        Ok(value) => Some(value),
        Err(error) => {
            fault::report(explain(&error, slice, names));
            None
        }
    }
}

/// Reads the whole file.
///
/// In broken syntax the tolerant way has passed over the surrounding value without
/// knowing what it should be; the strict way knows, and so says better what was expected.
pub(crate) fn read_file<'t, T: Deserialize<'t>>(slice: Slice<'t>, names: Names) -> Option<T> {
    let error = match parse(slice.text) {
        Ok(value) => return Some(value),
        Err(error) => error,
    };
    let (strict, innermost) = fault::strictly(|| parse::<T>(slice.text).err());
    let strict = strict.filter(|strict| !matches!(strict.code, Error::MissingStructField { .. }));
    match strict {
        Some(strict) => {
            let is_about_names = matches!(
                strict.code,
                Error::NoSuchStructField { .. }
                    | Error::NoSuchEnumVariant { .. }
                    | Error::DuplicateStructField { .. }
                    | Error::ExpectedDifferentStructName { .. }
            );
            fault::report(explain(&strict, slice, innermost.unwrap_or(names)));
            if is_about_names && strict.span != error.span {
                fault::report(explain(&error, slice, names));
            }
        }
        None => fault::report(explain(&error, slice, names)),
    }
    if let Some((open, at)) = token::missing_bracket(slice.text) {
        // What was read behind it was taken for something else.
        fault::forget_from(slice.start + open);
        let expected = token::lacks_bracket(slice.text, open);
        fault::report(Fault::at_token(slice.start + at, expected));
    }
    None
}

/// Reads a value whose faults are all told by the same `expected`.
pub(crate) fn read_simple<'t, T: Deserialize<'t>>(slice: Slice<'t>, expected: &str) -> Option<T> {
    parse(slice.text).ok().or_else(|| slice.refuse(expected))
}

/// Reads a tuple of `N` values, or a list of as many.
pub(crate) fn read_tuple<'t, T: Read<'t>, const N: usize>(
    slice: Slice<'t>,
    expected: &str,
) -> Option<[T; N]>
where
    [Placed<T>; N]: Deserialize<'t>,
{
    let values = match plain_parts(slice) {
        Some(parts) => parts.map(T::read),
        None if slice.text.starts_with('[') => {
            let list: Vec<Placed<T>> = read_simple(slice, expected)?;
            let Ok(values) = <[Placed<T>; N]>::try_from(list) else {
                return slice.refuse(expected);
            };
            values.map(|placed| placed.value)
        }
        None => read_simple::<[Placed<T>; N]>(slice, expected)?.map(|placed| placed.value),
    };
    // A fault in the first value must not keep the others from being read.
    let values: Vec<T> = values.into_iter().collect::<Option<_>>()?;
    values.try_into().ok()
}

/// The parts of a tuple of `N` numbers without comments or anything unusual: what nearly all are,
/// without the detour over `ron`.
fn plain_parts<const N: usize>(slice: Slice<'_>) -> Option<[Slice<'_>; N]> {
    let text = slice.text;
    let inside = match text.as_bytes().first()? {
        b'(' => text[1..].strip_suffix(')')?,
        b'[' => text[1..].strip_suffix(']')?,
        _ => return None,
    };
    let is_usual = |byte: u8| byte.is_ascii_digit() || b"+-.eE, ".contains(&byte);
    if !inside.bytes().all(is_usual) {
        return None;
    }
    let mut parts = [slice; N];
    let mut texts = inside.split(',').map(str::trim_ascii);
    for part in &mut parts {
        let text = texts.next().filter(|text| !text.is_empty())?;
        *part = Slice::of_text_being_read(text);
    }
    texts.all(str::is_empty).then_some(parts)
}

fn parse<'t, T: Deserialize<'t>>(text: &'t str) -> ron::error::SpannedResult<T> {
    let mut deserializer = ron::Deserializer::from_str(text)?;
    T::deserialize(&mut deserializer)
        .and_then(|value| deserializer.end().map(|()| value))
        .map_err(|code| deserializer.span_error(code))
}
