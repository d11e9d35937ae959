//! The numbers of an array, row by row.

use std::fs::File;
use std::io::{self, BufReader, Read};

use super::array::Array;
use super::header;

/// A file that is being read.
pub(crate) struct Rows {
    file: BufReader<File>,
    array: Array,
    row: Vec<u8>,
    /// Rows that were not read.
    left: u32,
}

impl Rows {
    pub(crate) fn begin(file: File) -> Result<Self, String> {
        let mut file = BufReader::new(file);
        let array = header::read(&mut file)?.array;
        Ok(Self {
            file,
            array,
            row: vec![0; array.row_bytes()],
            left: array.size.height,
        })
    }

    pub(crate) fn array(&self) -> Array {
        self.array
    }

    /// The numbers of the next row; `None` after the last one.
    pub(crate) fn next(&mut self) -> io::Result<Option<&[u8]>> {
        if self.left == 0 {
            return Ok(None);
        }
        self.left -= 1;
        self.file.read_exact(&mut self.row)?;
        Ok(Some(&self.row))
    }
}
