//! The samples of a TIFF that marbles wrote, row by row.

use std::fs::File;
use std::io::BufReader;

use super::decoder::{Opened, open};
use super::shape::Shape;
use crate::formats::guard::guarded;
use crate::formats::source::Input;

/// A file that is being read.
pub(crate) struct Rows {
    file: Opened,
    shape: Shape,
    /// The samples of a strip.
    strip: Vec<u8>,
    /// The number of the next row.
    next: u32,
}

impl Rows {
    pub(crate) fn begin(file: File) -> Result<Self, String> {
        let file: Box<dyn Input> = Box::new(BufReader::new(file));
        let file = open(file)?;
        let shape =
            Shape::of_file(&file).ok_or("its samples differ from those that marbles writes")?;
        Ok(Self {
            file,
            shape,
            strip: Vec::new(),
            next: 0,
        })
    }

    pub(crate) fn shape(&self) -> Shape {
        self.shape
    }

    /// The samples of the next row; `None` after the last one.
    pub(crate) fn next(&mut self) -> Result<Option<&[u8]>, String> {
        if self.next == self.shape.size.height {
            return Ok(None);
        }
        let (_, rows) = self.file.chunk;
        let within = self.next % rows;
        if within == 0 {
            let rows = rows.min(self.shape.size.height - self.next);
            self.strip.resize(rows as usize * self.shape.row_bytes(), 0);
            let index = self.next / self.file.chunk.1;
            guarded(|| self.file.decoder.read_chunk_bytes(index, &mut self.strip))?;
        }
        self.next += 1;
        let first = within as usize * self.shape.row_bytes();
        Ok(self.strip.get(first..first + self.shape.row_bytes()))
    }
}
