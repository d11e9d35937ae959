//! Values that know where they stand in the file.

use std::ops::Range;

use ron::value::RawValue;
use serde::{Deserialize, Deserializer};

use crate::explain::explain;
use crate::fault::{self, Slice};
use crate::token;

/// A value that can be read from a part of the text.
pub(crate) trait Read<'t>: Sized {
    /// Reads the value from the whole of `slice`; reports why not where it returns `None`.
    fn read(slice: Slice<'t>) -> Option<Self>;
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
        let raw = <&'de RawValue>::deserialize(deserializer)?.get_ron();
        // The raw value comes with the comments around it.
        let start = token::skip_trivia(raw, 0);
        let end = if raw.contains('/') {
            token::value_end(raw, start)
        } else {
            raw.trim_end_matches(token::is_white_space).len()
        };
        let slice = Slice::of_text_being_read(&raw[start..end]);
        Ok(Self {
            place: slice.place(),
            value: T::read(slice),
        })
    }
}

/// Reads a field that may be left out but not be `None`.
pub(crate) fn present<'de, D: Deserializer<'de>, T: Deserialize<'de>>(
    deserializer: D,
) -> Result<Option<T>, D::Error> {
    T::deserialize(deserializer).map(Some)
}

/// What a structure or an enumeration is called in messages.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Names {
    /// The noun, as in "a field of this sphere".
    pub(crate) noun: &'static str,
    /// The whole, as in "a sphere `(center: …, radius: …)`".
    pub(crate) form: &'static str,
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

/// Reads a value whose faults are all told by the same `expected`.
pub(crate) fn read_simple<'t, T: Deserialize<'t>>(slice: Slice<'t>, expected: &str) -> Option<T> {
    parse(slice.text).ok().or_else(|| slice.refuse(expected))
}

fn parse<'t, T: Deserialize<'t>>(text: &'t str) -> ron::error::SpannedResult<T> {
    let mut deserializer = ron::Deserializer::from_str(text)?;
    T::deserialize(&mut deserializer)
        .and_then(|value| deserializer.end().map(|()| value))
        .map_err(|code| deserializer.span_error(code))
}
