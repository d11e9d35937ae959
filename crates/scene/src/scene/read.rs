//! The bytes of scene files, and of the standard input.

use std::fs::File;
use std::io::{self, ErrorKind, Read};
use std::path::Path;

/// The path that stands for a scene from the standard input.
pub const STANDARD_INPUT: &str = "-";

/// The largest scene file that is read, in bytes: more than ten million spheres take, and a limit
/// for files that never end.
pub(super) const LARGEST_FILE: u64 = 1 << 30;

/// Bytes that are read at a time.
pub(super) const BLOCK: u64 = 1 << 20;

/// The bytes of the standard input, as [`read_at_most`] reads those of a file.
pub(super) fn read_standard_input() -> io::Result<Vec<u8>> {
    read_stream_at_most(io::stdin().lock(), 0, LARGEST_FILE)
}

/// The bytes of a file that has at most `most`, up to the first of 0; [`ErrorKind::FileTooLarge`] where it has more.
pub(super) fn read_at_most(path: &Path, most: u64) -> io::Result<Vec<u8>> {
    let file = File::open(path)?;
    let size = file.metadata()?.len();
    read_stream_at_most(file, size, most)
}

/// The same of an open file. What its `size` says is not always so: devices and pipes have none.
fn read_stream_at_most(file: impl Read, size: u64, most: u64) -> io::Result<Vec<u8>> {
    let mut bytes = Vec::new();
    if size <= most {
        let mut rest = file.take(most + 1);
        let mut seen = 0;
        // No text has a byte of 0: what has one may never end.
        while rest.by_ref().take(BLOCK).read_to_end(&mut bytes)? > 0 {
            if let Some(zero) = bytes[seen..].iter().position(|&byte| byte == 0) {
                bytes.truncate(seen + zero + 1);
                return Ok(bytes);
            }
            seen = bytes.len();
        }
    }
    if size.max(bytes.len() as u64) > most {
        return Err(ErrorKind::FileTooLarge.into());
    }
    Ok(bytes)
}
