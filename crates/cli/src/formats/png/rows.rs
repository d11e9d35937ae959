//! The samples of a PNG, row by row.

use std::fs::File;
use std::io::BufReader;

use png::{DecodingError, Reader};

use super::decoder::decoder;
use super::shape::Shape;
use crate::formats::source::Input;

/// A file that is being read.
pub(crate) struct Rows(Reader<Box<dyn Input>>);

impl Rows {
    pub(crate) fn begin(file: File) -> Result<Self, DecodingError> {
        let reader = decoder(Box::new(BufReader::new(file))).read_info();
        reader.map(Self)
    }

    pub(crate) fn shape(&self) -> Shape {
        Shape::of_file(self.0.info())
    }

    /// The samples of the next row; `None` if the file is truncated.
    pub(crate) fn next(&mut self) -> Result<Option<&[u8]>, DecodingError> {
        let row = self.0.next_row()?;
        Ok(row.map(|row| row.data()))
    }
}
