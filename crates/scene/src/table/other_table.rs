//! Tables that are read besides the one that the scene names.

use super::error::TableError;
use super::format::Format;
use super::other_file::{OtherFile, OtherName};
use super::request::Request;
use super::rows::Rows;

/// The first frame of another table.
pub(crate) struct OtherTable {
    pub(crate) rows: Rows,
    pub(crate) format: Format,
    /// The length of an ångström, in the table's unit.
    pub(crate) angstrom: f64,
    pub(crate) file: OtherFile,
}

/// Reads the first frame of another table.
pub(crate) type ReadOther = fn(&OtherName, &Request) -> Result<OtherTable, TableError>;
