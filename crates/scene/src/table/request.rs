//! The settings of a cloud that concern its table.

use glam::DVec3;
use serde::Deserialize;

use super::columns::Test;
use super::element::Radii;

/// The settings by which a table is read.
#[derive(Clone, Debug, Default)]
pub(crate) struct Request {
    /// The radius of every sphere, instead of what the table says.
    pub(crate) radius: Option<f64>,
    /// The kind of radii that elements have.
    pub(crate) radii: Radii,
    /// The radii of elements, or of other names, that the scene file gives.
    pub(crate) own_radii: Vec<(String, f64)>,
    /// The radius of what is no element, where the scene file gives it.
    pub(crate) other_radius: Option<f64>,
    /// The names to which the scene file gives colors.
    pub(crate) palette: Vec<String>,
    /// The columns that the scene file names.
    pub(crate) columns: Columns,
    /// The source of the colors; `None` for the best that the table has.
    pub(crate) coloring: Option<Coloring>,
    /// The source of the numbers that a colormap turns into colors, or of categories.
    pub(crate) value: Option<Value>,
    /// The treatment of rows that have no such number.
    pub(crate) missing: Missing,
    /// The conditions on rows that are kept.
    pub(crate) keep: Vec<Filter>,
    /// The cells that are shown.
    pub(crate) periodic: Periodic,
    /// The places of rows are wanted.
    pub(crate) has_places: bool,
}

/// The choices of a scene file about the cell of a table.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub(crate) struct Periodic {
    /// The number of cells along each edge.
    pub(crate) repeat: [u32; 3],
    /// Every center is moved into the cell.
    pub(crate) wraps: bool,
    /// Image flags move particles back out of the cell.
    pub(crate) unwraps: bool,
    /// What lies on a face is shown on the opposite one, too.
    pub(crate) shows_edges: bool,
}

impl Default for Periodic {
    fn default() -> Self {
        Self {
            repeat: [1; 3],
            wraps: false,
            unwraps: false,
            shows_edges: false,
        }
    }
}

impl Periodic {
    /// The first field of the scene file that needs a cell.
    pub(crate) fn field(self) -> Option<&'static str> {
        let fields = [
            (self.is_repeated(), "repeat"),
            (self.wraps, "wrap"),
            (self.unwraps, "unwrap"),
            (self.shows_edges, "edges"),
        ];
        let mut fields = fields.into_iter();
        fields.find(|field| field.0).map(|field| field.1)
    }

    /// Says whether there are several cells.
    pub(crate) fn is_repeated(self) -> bool {
        self.repeat != [1; 3]
    }
}

/// A condition on a column.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Filter {
    pub(crate) column: ColumnRef,
    pub(crate) test: Test,
}

/// The columns that the scene file names; those that it does not are found by their names.
#[derive(Clone, Debug, Default)]
pub(crate) struct Columns {
    pub(crate) position: [Option<ColumnRef>; 3],
    pub(crate) radius: Option<ColumnRef>,
    pub(crate) element: Option<ColumnRef>,
    /// The factor on radii.
    pub(crate) radius_scale: Option<f64>,
    /// The way from the numbers of the column to radii.
    pub(crate) radius_law: RadiusLaw,
}

/// The way from numbers to radii.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) enum RadiusLaw {
    /// They are radii.
    #[default]
    Linear,
    /// Radii are `offset + factor × number ^ exponent`, with the exponent 1/2 for areas, 1/3 for volumes.
    Power {
        factor: f64,
        exponent: f64,
        offset: f64,
    },
    /// Radii are 10 to the power of this many of them, as of magnitudes.
    Exponential(f64),
}

impl RadiusLaw {
    /// The radius for a number.
    #[inline(always)]
    pub(crate) fn of(self, number: f64) -> f64 {
        match self {
            Self::Linear => number,
            Self::Power {
                factor,
                exponent,
                offset,
            } => offset + factor * libm::pow(number, exponent),
            Self::Exponential(factor) => libm::pow(10.0, factor * number),
        }
    }
}

/// A column.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum ColumnRef {
    Name(String),
    /// By its place, from 1.
    Number(usize),
    /// None: every row has this number.
    Constant(f64),
}

/// The source of numbers.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Value {
    Column(ColumnRef),
    /// The length of a vector.
    Length([ColumnRef; 3]),
}

/// The numbers that have the first and the last color of a colormap.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum ValueRange {
    Fixed(f64, f64),
    /// Those below which so many in a hundred lie.
    Percentile(f64, f64),
}

/// The treatment of rows without a number to color them.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) enum Missing {
    /// They are a fault.
    #[default]
    Refuse,
    /// They are left out.
    Hide,
    /// They have this color.
    Color(DVec3),
}

/// The source of the colors of spheres.
#[derive(Clone, Copy, Debug, Deserialize, Eq, PartialEq)]
pub(crate) enum Coloring {
    /// The material.
    Material,
    /// Columns of red, green and blue.
    Table,
    /// The elements.
    Element,
    /// A column of numbers, by a colormap.
    Value,
    /// A column of names or numbers, each with a color of its own.
    Category,
    /// None: only the different numbers of a column are wanted, and no spheres.
    #[serde(skip)]
    Distinct,
    /// None: only the contents of the columns are wanted, and no spheres. Those whose bit is set have texts.
    #[serde(skip)]
    Contents(u64),
}
