//! Files that are read from any place, several times where that is needed.

use std::fs::File;
use std::io::{self, BufRead, BufReader, Cursor, Read, Seek};
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Bytes that are read at a time.
const BUFFER_BYTES: usize = 1 << 16;

/// The place where the bytes of a file are.
#[derive(Debug)]
pub(crate) enum Source {
    File(PathBuf),
    /// A pipe can be read once and forward alone; this is what came out of it.
    Memory(Arc<[u8]>),
}

/// The bytes of a file.
pub(crate) trait Input: BufRead + Seek {}

impl<T: BufRead + Seek> Input for T {}

impl Source {
    /// The file at `path`, and its first bytes, `start` of them where it has so many.
    ///
    /// A pipe may have no end: all of it is read only if `is_wanted` says so after it saw the start.
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

    /// The bytes from the first on.
    pub(crate) fn open(&self) -> io::Result<Box<dyn Input>> {
        Ok(match self {
            Self::File(path) => Box::new(BufReader::with_capacity(BUFFER_BYTES, File::open(path)?)),
            Self::Memory(bytes) => Box::new(Cursor::new(Arc::clone(bytes))),
        })
    }
}
