//! The streams of bzip2 files, one after another.

use std::io::{self, BufRead, ErrorKind};

use ::bzip2::bufread::BzDecoder;

use super::compression::REMEDY;
use super::packed::{Blocks, Packed};

/// The most streams that hold nothing: each costs as much time as thousands of bytes.
const MOST_EMPTY: u64 = 4096;

/// Sends what the streams of a file hold, each block and each stream compared with its checksum.
///
/// # Errors
/// Fails at streams that are damaged or cut, and at other bytes between or after them.
pub(super) fn decode(packed: &mut Packed, blocks: &mut Blocks) -> io::Result<()> {
    let mut empty = 0;
    loop {
        let start = packed.position;
        let mut decoder = BzDecoder::new(&mut *packed);
        let sent = blocks.take_all(&mut decoder);
        match sent.map_err(|error| explain(start, error))? {
            None => return Ok(()),
            Some(0) => empty += 1,
            Some(_) => {}
        }
        if empty > MOST_EMPTY {
            let message =
                format!("more than {MOST_EMPTY} of its bzip2 streams are empty; {REMEDY}");
            return Err(io::Error::other(message));
        }
        match packed.fill_buf()?.first().copied() {
            None => return Ok(()),
            Some(b'B') => {}
            Some(byte) => {
                let at = packed.position;
                let message = format!(
                    "expected another bzip2 stream or the end at byte {at}, found the byte 0x{byte:02x}"
                );
                return Err(io::Error::new(ErrorKind::InvalidData, message));
            }
        }
    }
}

/// The error of the stream that begins at the byte `start`, in words.
fn explain(start: u64, error: io::Error) -> io::Error {
    let what = match error.kind() {
        ErrorKind::UnexpectedEof => "is cut: the file ends within it",
        ErrorKind::InvalidInput | ErrorKind::InvalidData => {
            "is damaged: its data or a checksum are wrong"
        }
        _ => return error,
    };
    let message = format!("the bzip2 stream at byte {start} {what}");
    io::Error::new(ErrorKind::InvalidData, message)
}
