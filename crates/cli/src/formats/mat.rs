//! MAT-files of version 5, for MATLAB, Octave and SciPy: one array of doubles.
//!
//! # Source
//! *MAT-File Format*, The MathWorks: a header of 128 bytes, then elements, each with its type and length in bytes and
//! aligned to 8 bytes. Arrays are stored column by column.

use std::io::{self, Write};

/// Types of elements.
const INT8: u32 = 1;
const INT32: u32 = 5;
const UINT32: u32 = 6;
const DOUBLE: u32 = 9;
const MATRIX: u32 = 14;

/// The class of arrays of doubles.
const CLASS_OF_DOUBLES: u32 = 6;

/// The alignment of elements, in bytes.
const ALIGNMENT: usize = 8;

/// Bytes of the type and the length of an element.
const TAG: usize = 8;

/// Bytes of the text at the start of a file.
const TEXT: usize = 116;

/// Writes an array of rows × columns × layers with a name; `value` returns the number for a row, a column and a layer.
///
/// # Errors
/// If the file cannot be written, or would exceed the format's 4 GiB.
pub(crate) fn write_array(
    to: &mut dyn Write,
    name: &str,
    [rows, columns, layers]: [usize; 3],
    value: impl Fn(usize, usize, usize) -> f64,
) -> io::Result<()> {
    let too_large = || io::Error::other("too large for a MAT-file");
    let length = |bytes: usize| u32::try_from(bytes).map_err(|_| too_large());
    let count = rows
        .checked_mul(columns)
        .and_then(|count| count.checked_mul(layers));
    let bytes = count.and_then(|count| count.checked_mul(size_of::<f64>()));
    let bytes = bytes.ok_or_else(too_large)?;
    let dimensions = [rows, columns, layers].map(|side| side as i32);

    let mut elements = Vec::new();
    let flags = [CLASS_OF_DOUBLES, 0].map(u32::to_le_bytes).concat();
    element(&mut elements, UINT32, &flags);
    element(
        &mut elements,
        INT32,
        &dimensions.map(i32::to_le_bytes).concat(),
    );
    element(&mut elements, INT8, name.as_bytes());
    elements.extend(tag(DOUBLE, length(bytes)?));
    // The numbers end at a multiple of 8 as well.
    let matrix = tag(MATRIX, length(elements.len() + bytes)?);

    to.write_all(&header())?;
    to.write_all(&matrix)?;
    to.write_all(&elements)?;
    for layer in 0..layers {
        for column in 0..columns {
            for row in 0..rows {
                to.write_all(&value(row, column, layer).to_le_bytes())?;
            }
        }
    }
    Ok(())
}

/// A text, no subsystem data, the version, and the byte order: `MI` as a little-endian number.
fn header() -> Vec<u8> {
    const VERSION: [u8; 2] = [0, 1];
    let mut header = b"MATLAB 5.0 MAT-file, written by marbles".to_vec();
    header.resize(TEXT, b' ');
    header.extend([0; 8]);
    header.extend(VERSION);
    header.extend(b"IM");
    header
}

fn tag(kind: u32, bytes: u32) -> [u8; TAG] {
    let mut tag = [0; TAG];
    tag[..4].copy_from_slice(&kind.to_le_bytes());
    tag[4..].copy_from_slice(&bytes.to_le_bytes());
    tag
}

/// Appends a short element.
fn element(to: &mut Vec<u8>, kind: u32, bytes: &[u8]) {
    to.extend(tag(kind, bytes.len() as u32));
    to.extend(bytes);
    to.resize(to.len().next_multiple_of(ALIGNMENT), 0);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_array_has_the_bytes_of_the_format() {
        let mut file = Vec::new();
        let value = |row, column, layer| (row + 10 * column + 100 * layer) as f64;
        write_array(&mut file, "Normal_gt", [2, 3, 2], value).unwrap();
        let word = |at: usize| u32::from_le_bytes(file[at..at + 4].try_into().unwrap());
        assert_eq!(&file[124..128], [0, 1, b'I', b'M']);
        // The matrix: flags, dimensions, name, numbers.
        assert_eq!([word(128), word(132)], [14, file.len() as u32 - 136]);
        assert_eq!([136, 140, 144].map(word), [6, 8, 6]);
        assert_eq!(
            [152, 156, 160, 164, 168, 172].map(word),
            [5, 12, 2, 3, 2, 0]
        );
        assert_eq!([176, 180].map(word), [1, 9]);
        assert_eq!(&file[184..200], b"Normal_gt\0\0\0\0\0\0\0");
        assert_eq!([200, 204].map(word), [9, 12 * 8]);
        let (numbers, rest) = file[208..].as_chunks::<8>();
        assert!(rest.is_empty());
        let numbers: Vec<f64> = numbers
            .iter()
            .map(|bytes| f64::from_le_bytes(*bytes))
            .collect();
        let expected = [0, 1, 10, 11, 20, 21, 100, 101, 110, 111, 120, 121];
        assert_eq!(numbers, expected.map(f64::from));
    }

    #[test]
    fn what_the_format_cannot_hold_is_refused() {
        let mut file = Vec::new();
        assert!(write_array(&mut file, "a", [1 << 16, 1 << 16, 3], |_, _, _| 0.0).is_err());
        assert!(file.is_empty());
    }
}
