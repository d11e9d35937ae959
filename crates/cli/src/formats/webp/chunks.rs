//! The chunks of a WebP: four letters, the number of data bytes, the data, and one more byte if that number is odd.
//!
//! Source: "WebP Container Specification", Google.

use std::io::{self, Read, Write};

use crate::base::failure::reason;

/// The number of bytes before the data of a chunk.
pub(super) const HEADER_BYTES: u64 = 8;

/// Writes the header of a chunk.
pub(super) fn write_header(file: &mut impl Write, name: &[u8; 4], bytes: u32) -> io::Result<()> {
    file.write_all(name)?;
    file.write_all(&bytes.to_le_bytes())
}

/// Parses the header of a chunk: its letters, and the number of its data bytes.
pub(super) fn header([name @ .., a, b, c, d]: [u8; 8]) -> ([u8; 4], u32) {
    (name, u32::from_le_bytes([a, b, c, d]))
}

/// Refuses a file with this number of bytes if it is shorter than its header states: the decoder of lossy data replaces
/// missing pixels without a word.
pub(in crate::formats) fn check_length(file: &mut impl Read, end: u64) -> Result<(), String> {
    let mut start = [0; HEADER_BYTES as usize];
    let read = file.read_exact(&mut start);
    read.map_err(|error| reason(&error))?;
    let (_, bytes) = header(start);
    let expected = HEADER_BYTES + u64::from(bytes);
    if end < expected {
        return Err(format!(
            "it ends early: expected {expected} bytes, found {end}"
        ));
    }
    Ok(())
}

/// The bytes of a number with 24 bits.
pub(super) fn bytes_of_24(number: u32) -> [u8; 3] {
    let [a, b, c, _] = number.to_le_bytes();
    [a, b, c]
}
