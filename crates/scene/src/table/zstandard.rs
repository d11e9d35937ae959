//! The frames of Zstandard files, one after another, those that hold nothing among them.
//!
//! # Source
//! RFC 8878, "Zstandard Compression and the 'application/zstd' Media Type".

use std::fmt::Display;
use std::io::{self, BufRead, Cursor, ErrorKind, Read};

use ruzstd::decoding::{FrameDecoder, StreamingDecoder};

use super::compression::{ZSTANDARD_FRAME as MAGIC, ZSTANDARD_SKIPPABLE as SKIPPABLE};
use super::packed::{Blocks, Packed};

/// Sends what the frames of a file hold, each compared with its checksum and its size where it has them.
///
/// # Errors
/// Fails at frames that are damaged or cut, and at other bytes between or after them.
pub(super) fn decode(packed: &mut Packed, blocks: &mut Blocks) -> io::Result<()> {
    let mut decoder = FrameDecoder::new();
    loop {
        let start = packed.position;
        let mut magic = Vec::new();
        packed.by_ref().take(4).read_to_end(&mut magic)?;
        let magic = match magic[..] {
            [] => return Ok(()),
            [a, b, c, d] => u32::from_le_bytes([a, b, c, d]),
            _ => return Err(damaged(start, "is cut: the file ends within it")),
        };
        if SKIPPABLE.contains(&magic) {
            skip(packed, start)?;
            continue;
        }
        if magic != MAGIC {
            let message = format!(
                "expected another Zstandard frame or the end at byte {start}, found the bytes {:02x?}",
                magic.to_le_bytes()
            );
            return Err(io::Error::new(ErrorKind::InvalidData, message));
        }
        let whole = Cursor::new(MAGIC.to_le_bytes()).chain(&mut *packed);
        let stream = StreamingDecoder::new_with_decoder(whole, &mut decoder);
        let sent = match stream {
            Ok(mut stream) => blocks.take_all(&mut stream),
            Err(error) => return Err(explain(packed, start, &error)),
        };
        let count = match sent {
            Ok(Some(count)) => count,
            Ok(None) => return Ok(()),
            Err(error) if error.kind() == ErrorKind::OutOfMemory => return Err(error),
            Err(error) => return Err(explain(packed, start, &error)),
        };
        let stored = decoder.get_checksum_from_data();
        let found = decoder.get_calculated_checksum();
        if let (Some(stored), Some(found)) = (stored, found)
            && stored != found
        {
            let what =
                format!("is damaged: expected the checksum 0x{stored:08x}, found 0x{found:08x}");
            return Err(damaged(start, &what));
        }
        // A size of 0 is one that the frame does not say.
        let size = decoder.content_size();
        if size != 0 && size != count {
            let what = format!("is damaged: expected {size} bytes in it, found {count}");
            return Err(damaged(start, &what));
        }
    }
}

/// Passes over a frame that begins at the byte `start`, behind its magic number.
fn skip(packed: &mut Packed, start: u64) -> io::Result<()> {
    let mut size = Vec::new();
    packed.by_ref().take(4).read_to_end(&mut size)?;
    let size = size.first_chunk().map(|size| u32::from_le_bytes(*size));
    let is_whole = match size {
        Some(size) => packed.skip(u64::from(size))? == u64::from(size),
        None => false,
    };
    match is_whole {
        true => Ok(()),
        false => Err(damaged(start, "is cut: the file ends within it")),
    }
}

fn damaged(start: u64, what: &str) -> io::Error {
    let message = format!("the Zstandard frame at byte {start} {what}");
    io::Error::new(ErrorKind::InvalidData, message)
}

/// The error of the frame that begins at the byte `start`, in words.
fn explain(packed: &mut Packed, start: u64, error: &dyn Display) -> io::Error {
    let is_at_end = packed.fill_buf().is_ok_and(<[u8]>::is_empty);
    match is_at_end {
        true => damaged(start, "is cut or damaged: the file ends within it"),
        false => damaged(
            start,
            &format!("is damaged, or of an unsupported kind ({error})"),
        ),
    }
}
