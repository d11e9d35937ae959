//! A scene in words and numbers.

use std::ops::Range;
use std::path::PathBuf;

use glam::DVec3;

use crate::world::ScaleKind;

/// The spheres of a table.
#[derive(Clone, Debug, PartialEq)]
pub struct CloudDescription {
    /// The table as the scene file names it.
    pub file: PathBuf,
    /// The range of its spheres in the world of the first frame.
    pub spheres: Range<usize>,
    /// The rows of the table, those that were not kept among them, in the first frame.
    pub rows: u64,
    /// The axes of the table are right-handed: the scene file says so, or else its format is one of those that have
    /// such axes.
    pub is_right_handed: bool,
    /// The number of its steps, where it changes over time.
    pub steps: Option<usize>,
    /// The column that colors stand for, where one does.
    pub colors: Option<ColorDescription>,
}

/// The meaning of the colors of a table's spheres.
#[derive(Clone, Debug, PartialEq)]
pub struct ColorDescription {
    /// The column; the length of a vector has none.
    pub column: Option<String>,
    /// The unit that the table has behind the column's name.
    pub unit: Option<String>,
    /// The meaning of each color.
    pub meaning: ColorMeaning,
}

/// The meaning of colors.
#[derive(Clone, Debug, PartialEq)]
pub enum ColorMeaning {
    /// Numbers on a scale.
    Scale {
        /// The number of the first color, and what is below.
        low: f64,
        /// The number of the last color, and what is above.
        high: f64,
        /// The way from numbers to places between them.
        kind: ScaleKind,
        /// The linear colors, from the low end to the high one.
        colors: Vec<DVec3>,
        /// The numbers are times, in seconds since the start of 1970.
        are_times: bool,
    },
    /// Categories, in their order, each with its linear color.
    Categories(Vec<(String, DVec3)>),
}

/// A scene in words and numbers, for people.
#[derive(Clone, Debug, Eq, PartialEq)]
pub struct Description {
    /// The names of the materials that the file defines, in the order of the world's.
    pub materials: Vec<String>,
    /// The names of the lights, where they have any, in the order of the world's.
    pub lights: Vec<Option<String>>,
    /// The kind of camera, for example `LookAt`.
    pub camera: &'static str,
    /// The kind of animation, `Keyframes` or `Turntable`; `None` for a still.
    pub animation: Option<&'static str>,
    /// The lens as the file writes it, for example `Fov(50)`.
    pub lens: String,
}
