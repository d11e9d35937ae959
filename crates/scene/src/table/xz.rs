//! The streams of xz files, one after another.

use std::io::{self, ErrorKind};

use lzma_rust2::XzReader;

use super::packed::{Blocks, Packed};

/// The most memory that a decoder may take, in KiB: twice what the highest level of `xz` needs.
const MOST_MEMORY: u32 = 128 << 10;

/// Sends what the streams of a file hold, each block compared with its checksum if it has one.
///
/// # Errors
/// Fails at streams that are damaged or cut or need much memory, and at other bytes than zeros between or after them.
pub(super) fn decode(packed: &mut Packed, blocks: &mut Blocks) -> io::Result<()> {
    let mut decoder = XzReader::new_mem_limit(&mut *packed, true, MOST_MEMORY);
    let sent = blocks.take_all(&mut decoder);
    drop(decoder);
    sent.map(|_| ())
        .map_err(|error| explain(packed.position, error))
}

/// The error that was found before the byte `end`, in words.
fn explain(end: u64, error: io::Error) -> io::Error {
    let what = match error.kind() {
        ErrorKind::UnexpectedEof => String::from("is cut: the file ends within it"),
        ErrorKind::OutOfMemory => {
            let most = MOST_MEMORY >> 10;
            format!("needs more than {most} MiB of memory before byte {end}: decompress it")
        }
        ErrorKind::InvalidInput | ErrorKind::InvalidData => {
            format!("is damaged before byte {end}: {error}")
        }
        ErrorKind::Unsupported => format!("is of an unsupported kind before byte {end}: {error}"),
        _ => return error,
    };
    io::Error::new(ErrorKind::InvalidData, format!("the xz stream {what}"))
}
