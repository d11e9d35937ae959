//! Checks the directory of the first picture in a TIFF before a decoder relies on it.
//!
//! Source: "TIFF, Revision 6.0", Adobe, 1992, section 2, and "BigTIFF Design", 2007.

use std::io::{self, Read, Seek, SeekFrom};

use crate::base::failure::reason;

/// The largest number of entries in a directory; pictures have some dozens.
const MOST_ENTRIES: u64 = 1 << 12;
/// The largest count of numbers in an entry that describes the picture. It is larger than the number of rows may be.
const MOST_NUMBERS: u64 = 1 << 18;
/// The first tag that programs may define themselves.
const FIRST_PRIVATE_TAG: u16 = 1 << 15;

/// Refuses a directory if its numbers would fill the memory. Returns the position in the file where it ends.
pub(super) fn check(file: &mut (impl Read + Seek)) -> Result<u64, String> {
    let entries = read(file).map_err(|error| match error.kind() {
        io::ErrorKind::UnexpectedEof => "it ends early".to_owned(),
        _ => reason(&error),
    })?;
    let (end, longest) = entries?;
    if longest > MOST_NUMBERS {
        return Err(format!(
            "it describes its picture with {longest} numbers, expected at most {MOST_NUMBERS}"
        ));
    }
    Ok(end)
}

/// The end of the directory, and the count of numbers in its largest entry. The inner error is about the contents.
fn read(file: &mut (impl Read + Seek)) -> io::Result<Result<(u64, u64), String>> {
    file.rewind()?;
    let mut start = [0; 16];
    let length = read_all(file, &mut start)?;
    let is_little = start.starts_with(b"II");
    let number = |bytes: &[u8]| {
        let add = |number: u64, byte: &u8| number << 8 | u64::from(*byte);
        match is_little {
            true => bytes.iter().rev().fold(0, add),
            false => bytes.iter().fold(0, add),
        }
    };
    let is_big = number(&start[2..4]) == 43;
    if length < if is_big { 16 } else { 8 } {
        return Err(io::ErrorKind::UnexpectedEof.into());
    }
    // The lengths of a position in the file, of the number of entries and of an entry, and the first position.
    let (place_bytes, count_bytes, entry_bytes, place) = match is_big {
        true => (8, 8, 20, number(&start[8..16])),
        false => (4, 2, 12, number(&start[4..8])),
    };
    file.seek(SeekFrom::Start(place))?;
    let mut bytes = [0; 20];
    file.read_exact(&mut bytes[..count_bytes])?;
    let count = number(&bytes[..count_bytes]);
    if count > MOST_ENTRIES {
        return Ok(Err(format!(
            "its directory has {count} entries, expected at most {MOST_ENTRIES}"
        )));
    }
    let mut longest = 0;
    for _ in 0..count {
        let entry = &mut bytes[..entry_bytes];
        file.read_exact(entry)?;
        if (number(&entry[..2]) as u16) < FIRST_PRIVATE_TAG {
            longest = longest.max(number(&entry[4..4 + place_bytes]));
        }
    }
    // The position of the next directory follows.
    file.read_exact(&mut bytes[..place_bytes])?;
    let end = file.stream_position()?;
    Ok(Ok((end, longest)))
}

/// Reads bytes until the buffer is full or the file ends, and returns their number.
fn read_all(file: &mut impl Read, bytes: &mut [u8]) -> io::Result<usize> {
    let mut found = Vec::new();
    file.take(bytes.len() as u64).read_to_end(&mut found)?;
    bytes[..found.len()].copy_from_slice(&found);
    Ok(found.len())
}
