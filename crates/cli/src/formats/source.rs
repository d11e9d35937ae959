//! Files that can be read from any position, and several times.

use std::fs::File;
use std::io::{self, BufRead, BufReader, Cursor, Read, Seek};
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Bytes that are read at a time.
const BUFFER_BYTES: usize = 1 << 16;

/// The source of the bytes of a file.
#[derive(Debug)]
pub(crate) enum Source {
    File(PathBuf),
    /// The contents of a pipe, which can be read only once and forward.
    Memory(Arc<[u8]>),
}

/// The bytes of a file.
pub(crate) trait Input: BufRead + Seek {}

impl<T: BufRead + Seek> Input for T {}

impl Source {
    /// The file at `path`, and its first bytes: `start` of them, if it has that many.
    ///
    /// A pipe is read completely only if `is_wanted` accepts its first bytes: it may have no end.
    pub(crate) fn of(
        path: &Path,
        start: usize,
        is_wanted: impl FnOnce(&[u8]) -> bool,
    ) -> io::Result<(Self, Vec<u8>)> {
        let mut file = File::open(path)?;
        let mut bytes = Vec::new();
        Read::by_ref(&mut file)
            .take(start as u64)
            .read_to_end(&mut bytes)?;
        if file.metadata()?.is_file() {
            return Ok((Self::File(path.to_owned()), bytes));
        }
        if is_wanted(&bytes) {
            file.read_to_end(&mut bytes)?;
        }
        let first = bytes[..bytes.len().min(start)].to_vec();
        Ok((Self::Memory(bytes.into()), first))
    }

    /// A reader that starts at the first byte.
    pub(crate) fn open(&self) -> io::Result<Box<dyn Input>> {
        Ok(match self {
            Self::File(path) => Box::new(BufReader::with_capacity(BUFFER_BYTES, File::open(path)?)),
            Self::Memory(bytes) => Box::new(Cursor::new(Arc::clone(bytes))),
        })
    }
}
