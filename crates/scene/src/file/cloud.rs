//! The clouds of a scene file.

use serde::Deserialize;

use super::table::{ElementRadii, Keep, Palette, RadiusColumn};
use crate::table::{Coloring, Colormap, ColumnRef, Missing, Value, ValueRange};
use crate::text::{Placed, present};
use crate::values::{
    Color, Coordinate, Every, Exponent, FileName, Flag, FrameRange, LineCount, MaterialName, Point,
    Radius, RadiusScale, Repeat, Scale, Speed, from_srgb,
};

/// Spheres of a table; matte white without a material, and where the table puts them.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Cloud {
    pub(crate) file: Placed<FileName>,
    #[serde(default, deserialize_with = "present")]
    pub(crate) topology: Option<Placed<FileName>>,
    #[serde(default)]
    pub(crate) frames: Placed<TakenFrames>,
    #[serde(default, deserialize_with = "present")]
    pub(crate) time: Option<Placed<ColumnRef>>,
    #[serde(default)]
    pub(crate) skip_lines: Placed<LineCount>,
    #[serde(default, deserialize_with = "present")]
    pub(crate) steps: Option<Placed<FrameRange>>,
    #[serde(default)]
    pub(crate) every: Placed<Every>,
    #[serde(default)]
    pub(crate) speed: Placed<Speed>,
    #[serde(default)]
    pub(crate) end: Placed<End>,
    #[serde(default)]
    pub(crate) columns: Placed<Columns>,
    #[serde(default)]
    pub(crate) keep: Vec<Placed<Keep>>,
    #[serde(default, deserialize_with = "present")]
    pub(crate) material: Option<Placed<MaterialName>>,
    #[serde(default, deserialize_with = "present")]
    pub(crate) radius: Option<Placed<Radius>>,
    #[serde(default)]
    pub(crate) radii: Placed<ElementRadii>,
    #[serde(default, deserialize_with = "present")]
    pub(crate) others: Option<Placed<Others>>,
    #[serde(default, deserialize_with = "present")]
    pub(crate) color: Option<Placed<Coloring>>,
    #[serde(default, deserialize_with = "present")]
    pub(crate) value: Option<Placed<Value>>,
    #[serde(default, deserialize_with = "present")]
    pub(crate) colormap: Option<Placed<Colormap>>,
    #[serde(default, deserialize_with = "present")]
    pub(crate) color_scale: Option<Placed<ColorScale>>,
    #[serde(default = "no")]
    pub(crate) reversed: Placed<Flag>,
    #[serde(default, deserialize_with = "present")]
    pub(crate) range: Option<Placed<ValueRange>>,
    #[serde(default)]
    pub(crate) missing: Placed<Missing>,
    #[serde(default, deserialize_with = "present")]
    pub(crate) palette: Option<Placed<Palette>>,
    #[serde(default)]
    pub(crate) repeat: Placed<Repeat>,
    #[serde(default = "no")]
    pub(crate) wrap: Placed<Flag>,
    #[serde(default = "no")]
    pub(crate) unwrap: Placed<Flag>,
    #[serde(default = "no")]
    pub(crate) edges: Placed<Flag>,
    #[serde(default = "no")]
    pub(crate) center: Placed<Flag>,
    #[serde(default, deserialize_with = "present")]
    pub(crate) right_handed: Option<Placed<Flag>>,
    #[serde(default)]
    pub(crate) up: Placed<Up>,
    #[serde(default)]
    pub(crate) scale: Placed<Scale>,
    #[serde(default)]
    pub(crate) rotate_degrees: Placed<Point>,
    #[serde(default)]
    pub(crate) position: Placed<Point>,
}

/// The frames of a file that are taken.
#[derive(Clone, Copy, Debug, Default, Deserialize, Eq, PartialEq)]
pub(crate) enum TakenFrames {
    /// The first alone.
    #[default]
    First,
    /// All of them, one after another.
    All,
}

/// The radius and the color of rows whose element is unknown.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Others {
    #[serde(default = "one")]
    pub(crate) radius: Placed<Radius>,
    #[serde(default = "pink")]
    pub(crate) color: Placed<Color>,
}

/// The axis of a table, or of what a turntable turns, that points up.
#[derive(Clone, Copy, Debug, Default, Deserialize, Eq, PartialEq)]
pub(crate) enum Up {
    X,
    /// As in the scene.
    #[default]
    Y,
    /// As in maps and most simulations.
    Z,
}

/// The look of a cloud after its last step.
#[derive(Clone, Copy, Debug, Default, Deserialize, Eq, PartialEq)]
pub(crate) enum End {
    /// The last step.
    #[default]
    Hold,
    /// The steps once more.
    Loop,
    /// Nothing.
    Hide,
}

/// The columns of a table; those that are left out are found by their names.
#[derive(Debug, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Columns {
    #[serde(default, deserialize_with = "present")]
    pub(crate) x: Option<Placed<ColumnRef>>,
    #[serde(default, deserialize_with = "present")]
    pub(crate) y: Option<Placed<ColumnRef>>,
    #[serde(default, deserialize_with = "present")]
    pub(crate) z: Option<Placed<ColumnRef>>,
    #[serde(default, deserialize_with = "present")]
    pub(crate) radius: Option<Placed<RadiusColumn>>,
    #[serde(default, deserialize_with = "present")]
    pub(crate) radius_scale: Option<Placed<RadiusScale>>,
    #[serde(default, deserialize_with = "present")]
    pub(crate) radius_law: Option<Placed<RadiusLaw>>,
    #[serde(default, deserialize_with = "present")]
    pub(crate) element: Option<Placed<ColumnRef>>,
    #[serde(default, deserialize_with = "present")]
    pub(crate) value: Option<Placed<Value>>,
}

/// The way from the numbers of a column to radii.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) enum RadiusLaw {
    /// They are radii.
    Linear,
    /// Radii are this power of them.
    Power(Placed<Exponent>),
    /// Radii are 10 to the power of this many of them.
    Exponential(Placed<Exponent>),
}

/// The way from numbers to the colors of a colormap.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) enum ColorScale {
    /// Equal steps of numbers are equal steps of colors.
    Linear,
    /// Equal factors of numbers are equal steps of colors.
    Log,
    /// This number has the middle color, and both sides have one scale.
    Diverging(Placed<Coordinate>),
}

fn one() -> Placed<Radius> {
    Radius(1.0).into()
}

fn pink() -> Placed<Color> {
    Color(from_srgb(OTHERS_COLOR)).into()
}

/// The color of what is no element, which none has.
pub(crate) const OTHERS_COLOR: u32 = 0xff80c0;

fn no() -> Placed<Flag> {
    Flag(false).into()
}
