//! The sky as a scene file has it.

use serde::{Deserialize, Deserializer};

use crate::text::{Names, Placed, Read, Slice, present, read_structure, token};
use crate::values::{Color, Point};

/// The light of the sky.
#[derive(Debug)]
pub(crate) enum Sky {
    /// The same radiance from everywhere.
    Uniform(Color),
    /// One radiance from the directions above a plane, and another from those below it.
    Halves(Halves),
}

/// The two halves of a sky. In a scene y points up by default; in a key, where it pointed before.
#[derive(Debug, Deserialize)]
#[serde(rename = "Sky", deny_unknown_fields)]
pub(crate) struct Halves {
    pub(crate) above: Placed<Color>,
    pub(crate) below: Placed<Color>,
    #[serde(default, deserialize_with = "present")]
    pub(crate) up: Option<Placed<Point>>,
}

const NAMES: Names = Names {
    noun: "sky",
    form: "a sky: a color, or `(above: …, below: …)`",
};

impl<'t> Read<'t> for Sky {
    fn read(slice: Slice<'t>) -> Option<Self> {
        match has_fields(slice.text) {
            true => read_structure(slice, NAMES).map(Self::Halves),
            false => Color::read(slice).map(Self::Uniform),
        }
    }

    fn read_strictly<D: Deserializer<'t>>(deserializer: D) -> Result<Option<Self>, D::Error> {
        // Colors without quotation marks break the syntax, in front of `above` or without it.
        Color::read_strictly(deserializer).map(|_| None)
    }
}

/// Returns whether a value is a structure, in contrast to a color: whether a name stands in front of its bracket or
/// after it.
fn has_fields(text: &str) -> bool {
    if text.starts_with(|c: char| c.is_ascii_alphabetic()) {
        return text.contains('(');
    }
    let Some(inside) = text.strip_prefix('(') else {
        return false;
    };
    let start = token::skip_trivia(inside, 0);
    let first = &inside[start..token::token_end(inside, start)];
    let next = token::skip_trivia(inside, start + first.len());
    first == ")" || inside[next..].starts_with(':')
}
