//! The formats of tables, which the endings of their names tell.

use std::fs::File;
use std::io;
use std::path::Path;

use super::error::TableError;
use super::request::Request;
use super::rows::Rows;
use super::source::Source;
use super::{csv, npy, ply, xyz};

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
