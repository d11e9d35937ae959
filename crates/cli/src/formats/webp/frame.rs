//! Checks the first frame of a WebP before a decoder relies on it.

use std::io::{Read, Seek, SeekFrom};

use super::chunks::{HEADER_BYTES, header};
use crate::base::failure::reason;

/// Refuses a file if its lossy data contains a larger picture than this one, for which the decoder would allocate memory.
///
/// Source: RFC 6386, 9.1, for the start of the data.
pub(in crate::formats) fn check(
    file: &mut (impl Read + Seek),
    (width, height): (u32, u32),
) -> Result<(), String> {
    /// The bytes before the first chunk: `RIFF`, a length, `WEBP`.
    const START: u64 = 12;
    /// The bytes before the chunks of a frame: its position and size, its duration, and flags.
    const FRAME_BYTES: u64 = 16;
    /// The largest number of chunks that are searched.
    const MOST_CHUNKS: usize = 1 << 16;
    let mut place = START;
    for _ in 0..MOST_CHUNKS {
        let mut start = [0; 8];
        let read = file.seek(SeekFrom::Start(place));
        if read.and_then(|_| file.read_exact(&mut start)).is_err() {
            break;
        }
        let (name, bytes) = header(start);
        place += HEADER_BYTES;
        match &name {
            b"ANMF" => place += FRAME_BYTES,
            b"VP8 " => {
                let mut start = [0; 10];
                let read = file.read_exact(&mut start);
                read.map_err(|error| reason(&error))?;
                let side = |low, high| u32::from(u16::from_le_bytes([low, high]) & 0x3fff);
                let found = (side(start[6], start[7]), side(start[8], start[9]));
                return match found.0 <= width && found.1 <= height {
                    true => Ok(()),
                    false => Err(format!(
                        "its data has {} x {} pixels, but the picture has {width} x {height}",
                        found.0, found.1
                    )),
                };
            }
            _ => place += u64::from(bytes).next_multiple_of(2),
        }
    }
    Ok(())
}
