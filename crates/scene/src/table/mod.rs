//! Tables of spheres beside the scene file: CSV, NPY, PLY, XYZ.
//!
//! Files are read in blocks and never held as a whole: what stays is a sphere for each row and what
//! colors it. `columns` finds out which column is what, `text` and `binary` read rows, a file for
//! each format reads what stands before them.

mod binary;
mod colormap;
mod columns;
mod csv;
mod element;
mod fault;
mod lines;
mod npy;
mod ply;
mod python;
mod rows;
mod source;
mod text;
mod xyz;

use std::fs::File;
use std::io;
use std::path::Path;

use serde::Deserialize;

use self::source::Source;

pub(crate) use colormap::{Colormap, index as color_index};
pub(crate) use element::{Radii, colors as element_colors};
pub(crate) use fault::{TableFault, TablePlace};
pub(crate) use rows::{Paint, Rows};

/// What is to be made of a table.
#[derive(Clone, Debug, Default)]
pub(crate) struct Request {
    /// The radius of every sphere, instead of what the table says.
    pub(crate) radius: Option<f64>,
    /// Which radii elements have.
    pub(crate) radii: Radii,
    /// What gives the spheres their colors; `None` for the best that the table has.
    pub(crate) coloring: Option<Coloring>,
    /// The column of the numbers that a colormap turns into colors.
    pub(crate) value: Option<String>,
    /// Whether the colors of elements are to be left out unless they are asked for.
    pub(crate) has_material: bool,
}

/// What gives spheres their colors.
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

/// Why there is no table.
#[derive(Debug)]
pub(crate) enum TableError {
    /// The file cannot be opened or read.
    Unreadable(io::Error),
    /// The name has no ending that tells a format.
    UnknownFormat,
    /// There is no memory for it.
    OutOfMemory(u64),
    /// Something is wrong in it.
    Fault(TableFault),
}

impl From<io::Error> for TableError {
    fn from(error: io::Error) -> Self {
        Self::Unreadable(error)
    }
}

impl From<TableFault> for TableError {
    fn from(fault: TableFault) -> Self {
        Self::Fault(fault)
    }
}

/// The endings of names by which formats are told.
pub(crate) const ENDINGS: [&str; 5] = ["csv", "npy", "ply", "xyz", "extxyz"];

/// Reads the table at `path`, in the format that its ending tells. `watch` is called with the bytes
/// that were read and those that there are.
pub(crate) fn read(
    path: &Path,
    request: &Request,
    watch: &dyn Fn(u64, u64),
) -> Result<Rows, TableError> {
    let ending = path.extension().and_then(|ending| ending.to_str());
    let ending = ending.unwrap_or_default().to_ascii_lowercase();
    let read = match ending.as_str() {
        "csv" => csv::read,
        "npy" => npy::read,
        "ply" => ply::read,
        "xyz" | "extxyz" => xyz::read,
        _ => return Err(TableError::UnknownFormat),
    };
    let file = File::open(path)?;
    let metadata = file.metadata()?;
    if metadata.is_dir() {
        return Err(io::Error::from(io::ErrorKind::IsADirectory).into());
    }
    let watch = |read| watch(read, metadata.len());
    read(Source::new(file, &watch), request)
}

#[cfg(test)]
mod tests;
