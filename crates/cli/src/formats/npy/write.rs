//! Whole files, from rows.

use std::io::Write;
use std::ops::Range;
use std::path::Path;

use super::array::Array;
use super::header;
use super::stamp::Stamp;
use crate::files::save::{Fault, Unwritten, save};

/// Writes an array, completely or not at all; `numbers` returns those of some rows, row by row, little-endian.
pub(crate) fn write_array(
    path: &Path,
    array: &Array,
    stamp: Option<&Stamp>,
    mut numbers: impl FnMut(Range<u32>) -> Result<Vec<u8>, Fault>,
) -> Result<(), Unwritten> {
    /// The number of rows that are requested together.
    const ROWS: u32 = 16;
    let height = array.size.height;
    save(path, |mut file| {
        file.file().write_all(&header::bytes(array, stamp))?;
        for first in (0..height).step_by(ROWS as usize) {
            let rows = first..height.min(first + ROWS);
            file.file().write_all(&numbers(rows)?)?;
        }
        Ok(file)
    })
}
