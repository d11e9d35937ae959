//! The settings of a cloud that concern its table.

use serde::Deserialize;

use super::element::Radii;

/// The settings by which a table is read.
#[derive(Clone, Debug, Default)]
pub(crate) struct Request {
    /// The radius of every sphere, instead of what the table says.
    pub(crate) radius: Option<f64>,
    /// The kind of radii that elements have.
    pub(crate) radii: Radii,
    /// The source of the colors; `None` for the best that the table has.
    pub(crate) coloring: Option<Coloring>,
    /// The column of the numbers that a colormap turns into colors.
    pub(crate) value: Option<String>,
    /// The colors of elements are left out unless they are asked for.
    pub(crate) has_material: bool,
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
}
