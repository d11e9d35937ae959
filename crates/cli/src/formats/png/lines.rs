//! The samples of any PNG, row by row, including interlaced files.
//!
//! An interlaced file contains seven smaller pictures, one after the other, and each row of the picture has samples
//! from up to four of them. Each of the seven has its own reader, so that only rows are in memory. Together they decode
//! about twice the data of the file.

use std::ops::Range;

use png::{ColorType, Reader, Transformations};

use super::decoder::decoder;
use crate::base::failure::reason;
use crate::formats::source::{Input, Source};

/// The first column and row of each of the seven passes, and the steps to the next ones.
///
/// Source: PNG, third edition, 8.2 "Interlace methods".
const INTERLACED: [[u32; 4]; 7] = [
    [0, 0, 8, 8],
    [4, 0, 8, 8],
    [0, 4, 4, 8],
    [2, 0, 4, 4],
    [0, 2, 2, 4],
    [1, 0, 2, 2],
    [0, 1, 1, 2],
];
/// The pass of a picture that is not interlaced.
const WHOLE: [u32; 4] = [0, 0, 1, 1];

/// A file that is being read.
pub(super) struct Lines {
    passes: Vec<Pass>,
    /// The number of the next row.
    next: u32,
    /// Bytes of a pixel.
    pixel: usize,
    /// The samples of the current row.
    row: Vec<u8>,
    /// The samples of the current row of a pass.
    part: Vec<u8>,
}

/// One of the pictures in a file.
struct Pass {
    reader: Reader<Box<dyn Input>>,
    place: [u32; 4],
    /// The number of remaining rows.
    left: u32,
}

impl Lines {
    /// Begins to read the file. `reader` has already read its header from `source`.
    pub(super) fn begin(reader: Reader<Box<dyn Input>>, source: &Source) -> Result<Self, String> {
        let info = reader.info();
        let (width, height) = (info.width, info.height);
        let places = if info.interlaced {
            &INTERLACED[..]
        } else {
            &[WHOLE]
        };
        let length = reader.output_line_size(width).ok_or("too large")?;
        let mut lines = Self {
            passes: Vec::new(),
            next: 0,
            pixel: length / width as usize,
            row: vec![0; length],
            part: vec![0; length],
        };
        let mut reader = Some(reader);
        let mut before = 0;
        for &place in places {
            let [first_col, first_row, _, row_step] = place;
            if first_col >= width || first_row >= height {
                continue;
            }
            let rows = (height - first_row).div_ceil(row_step);
            let mut reader = match reader.take() {
                Some(reader) => reader,
                None => open(source)?,
            };
            for _ in 0..before {
                reader
                    .read_row(&mut lines.part)
                    .map_err(|error| error.to_string())?;
            }
            before += rows;
            lines.passes.push(Pass {
                reader,
                place,
                left: rows,
            });
        }
        Ok(lines)
    }

    /// The samples of the current row.
    pub(super) fn row(&self) -> &[u8] {
        &self.row
    }

    /// The columns of the row that may differ from those of another picture of the same size and kind; outside of them
    /// all samples are equal.
    pub(super) fn differing(&self, other: &Self) -> Range<u32> {
        // Many times as quick as byte by byte.
        if self.row == other.row {
            return 0..0;
        }
        let mut bytes = self.row.iter().zip(&other.row);
        let is_different = |(a, b): (&u8, &u8)| a != b;
        let first = bytes.clone().position(is_different);
        let last = bytes.rposition(is_different);
        match (first, last) {
            (Some(first), Some(last)) => {
                let [first, last] = [first, last].map(|byte| (byte / self.pixel) as u32);
                first..last + 1
            }
            _ => 0..0,
        }
    }

    /// The end of the columns, starting with this one, that have the same samples.
    pub(super) fn end_of_run(&self, col: u32) -> u32 {
        let from = &self.row[col as usize * self.pixel..];
        let pairs = from.iter().zip(&from[self.pixel..]);
        let equal = pairs.take_while(|(this, next)| this == next).count();
        col + 1 + (equal / self.pixel) as u32
    }

    /// Reads the next row.
    pub(super) fn advance(&mut self) -> Result<(), String> {
        let row = self.next;
        self.next += 1;
        let last = self.passes.len() - 1;
        for (index, pass) in self.passes.iter_mut().enumerate() {
            let [first_col, first_row, col_step, row_step] = pass.place;
            if row < first_row || !(row - first_row).is_multiple_of(row_step) {
                continue;
            }
            let read = pass.reader.read_row(&mut self.part);
            if read.map_err(|error| error.to_string())?.is_none() {
                return Err("its rows end early".to_owned());
            }
            if pass.place == WHOLE {
                self.row.copy_from_slice(&self.part);
            } else {
                let to = self.row.chunks_exact_mut(self.pixel);
                let to = to.skip(first_col as usize).step_by(col_step as usize);
                for (to, from) in to.zip(self.part.chunks_exact(self.pixel)) {
                    to.copy_from_slice(from);
                }
            }
            pass.left -= 1;
            if pass.left == 0 && index == last {
                // What is left of the samples must be whole as well.
                let end = pass.reader.read_row(&mut self.part);
                end.map_err(|error| error.to_string())?;
            }
        }
        Ok(())
    }
}

/// Reads the header of a file.
pub(super) fn open(source: &Source) -> Result<Reader<Box<dyn Input>>, String> {
    let file = source.open().map_err(|error| reason(&error))?;
    let mut decoder = decoder(file);
    // Samples of at least 8 bit, and colors for the numbers of a palette.
    decoder.set_transformations(Transformations::EXPAND);
    decoder.read_info().map_err(|error| error.to_string())
}

/// Returns whether samples of this kind include alpha.
pub(super) fn has_alpha(color_type: ColorType) -> bool {
    matches!(color_type, ColorType::GrayscaleAlpha | ColorType::Rgba)
}
