//! NPY files as pictures: the numbers are linear, premultiplied light.

use std::fs::File;
use std::io::{BufReader, Read, Seek, SeekFrom};
use std::path::Path;

use super::array::{Array, Number};
use super::header::{self, Header};
use crate::base::failure::reason;
use crate::formats::picture::{Picture, Samples, size_of};
use crate::formats::source::{Input, Source};

/// The name of the format.
pub(crate) const NAME: &str = "NPY";

/// The numbers of a file.
struct Numbers {
    array: Array,
    file: Box<dyn Input>,
    /// The bytes of the row that was read last.
    row: Vec<u8>,
}

/// Returns whether the file at `path` is a table of particles rather than a picture: an array of two axes with a few
/// columns, which would be a picture a few pixels wide.
pub(crate) fn is_table(path: &Path) -> bool {
    /// The columns of a table without names, at most.
    const MOST_COLUMNS: u32 = 7;
    let file = File::open(path).map_err(|error| reason(&error));
    let header = file.and_then(|file| header::read(&mut BufReader::new(file)));
    header.is_ok_and(|Header { array, .. }| {
        array.channels.is_none() && array.size.width <= MOST_COLUMNS
    })
}

/// The picture in a file.
pub(crate) fn begin(source: &Source) -> Result<Picture, String> {
    begin_in(source.open().map_err(|error| reason(&error))?)
}

/// The picture in the array that a reader contains.
pub(super) fn begin_in(mut file: Box<dyn Input>) -> Result<Picture, String> {
    let header = header::read(&mut file)?;
    let array = header.array;
    let names = match array.channels {
        None | Some(1) => "Y",
        Some(2) => "YA",
        Some(3) => "RGB",
        Some(4) => "RGBA",
        Some(other) => return Err(format!("expected 1 to 4 channels, found {other}")),
    };
    let size = size_of(array.size.width as usize, array.size.height as usize)?;
    let end = file.seek(SeekFrom::End(0));
    let end = end.map_err(|error| reason(&error))?;
    file.seek(SeekFrom::Start(header.start))
        .map_err(|error| reason(&error))?;
    if array.bytes() != end.checked_sub(header.start) {
        return Err("it contains more or fewer numbers than its header states".to_owned());
    }
    let kind = match array.number {
        Number::F64 => "double",
        Number::F32 => "float",
        Number::U32 => "uint",
    };
    Ok(Picture {
        size,
        grey: names.starts_with('Y'),
        alpha: names.ends_with('A'),
        format: NAME,
        description: format!("NPY, {kind}, {names}"),
        warnings: Vec::new(),
        row: Box::new(Numbers {
            array,
            file,
            row: vec![0; array.row_bytes()],
        }),
    })
}

impl Samples for Numbers {
    fn advance(&mut self) -> Result<(), String> {
        let read = self.file.read_exact(&mut self.row);
        read.map_err(|error| reason(&error))
    }

    fn rgba(&self, col: u32) -> [f64; 4] {
        let of = |channel| self.number(col, channel);
        match self.array.numbers() {
            1 => [of(0), of(0), of(0), 1.0],
            2 => [of(0), of(0), of(0), of(1)],
            3 => [of(0), of(1), of(2), 1.0],
            _ => [of(0), of(1), of(2), of(3)],
        }
    }

    fn rounding(&self, col: u32) -> [f64; 4] {
        // Doubles hold what was computed.
        match self.array.number {
            Number::F64 => [0.0; 4],
            Number::F32 => self.rgba(col).map(half_step),
            Number::U32 => [0.5; 4],
        }
    }

    fn is_full(&self, col: u32) -> [bool; 4] {
        let largest = match self.array.number {
            Number::F64 => f64::MAX,
            Number::F32 => f32::MAX.into(),
            Number::U32 => u32::MAX.into(),
        };
        self.rgba(col).map(|value| value == largest)
    }
}

impl Numbers {
    fn number(&self, col: u32, channel: usize) -> f64 {
        let index = col as usize * self.array.numbers() + channel;
        let (pairs, _) = self.row.as_chunks::<8>();
        let (words, _) = self.row.as_chunks::<4>();
        match self.array.number {
            Number::F64 => f64::from_le_bytes(pairs[index]),
            Number::F32 => f32::from_le_bytes(words[index]).into(),
            Number::U32 => u32::from_le_bytes(words[index]).into(),
        }
    }
}

/// Half the distance from a float to the next one.
fn half_step(value: f64) -> f64 {
    let float = value.abs() as f32;
    if float.is_finite() {
        0.5 * (f64::from(float.next_up()) - f64::from(float))
    } else {
        0.0
    }
}

#[cfg(test)]
mod tests;
