//! Outlines as a material has them.

use serde::{Deserialize, Deserializer};

use crate::text::{Names, Placed, Read, Slice, note_failure, read_structure};
use crate::values::{Color, OutlineUnits, OutlineWidth};

/// A line along the outline of spheres; black and 1.5 pixels wide by default.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Outline {
    #[serde(default)]
    pub(crate) width: Placed<Width>,
    #[serde(default = "super::black")]
    pub(crate) color: Placed<Color>,
}

/// The width of an outline.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Width {
    Pixels(f64),
    Units(f64),
}

impl Default for Width {
    fn default() -> Self {
        Self::Pixels(OutlineWidth::default().0)
    }
}

const NAMES: Names = Names {
    noun: "width of an outline",
    form: "a width in pixels, or in scene units: `Units(…)`",
};

impl<'t> Read<'t> for Width {
    fn read(slice: Slice<'t>) -> Option<Self> {
        #[derive(Deserialize)]
        enum Form {
            Units(Placed<OutlineUnits>),
        }
        if !slice.text.starts_with(|c: char| c.is_ascii_alphabetic()) {
            return OutlineWidth::read(slice).map(|OutlineWidth(width)| Self::Pixels(width));
        }
        let Form::Units(width) = read_structure(slice, NAMES)?;
        let OutlineUnits(width) = width.value?;
        Some(Self::Units(width))
    }

    fn read_strictly<D: Deserializer<'t>>(deserializer: D) -> Result<Option<Self>, D::Error> {
        serde::de::IgnoredAny::deserialize(deserializer)
            .inspect_err(|_| note_failure(NAMES))
            .map(|_| None)
    }
}
