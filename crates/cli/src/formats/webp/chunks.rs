//! The chunks of a WebP: four letters, the number of data bytes, the data, and one more byte if that number is odd.
//!
//! Source: "WebP Container Specification", Google.

use std::io::{self, Write};

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

/// The bytes of a number with 24 bits.
pub(super) fn bytes_of_24(number: u32) -> [u8; 3] {
    let [a, b, c, _] = number.to_le_bytes();
    [a, b, c]
}
