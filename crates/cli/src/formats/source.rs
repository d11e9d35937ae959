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
    Memory(Contents),
}

/// The bytes of a pipe. All readers share them.
#[derive(Clone, Debug)]
pub(crate) struct Contents(Arc<Vec<u8>>);

impl AsRef<[u8]> for Contents {
    fn as_ref(&self) -> &[u8] {
        &self.0
    }
}

#[cfg(test)]
impl From<&[u8]> for Contents {
    fn from(bytes: &[u8]) -> Self {
        Self(Arc::new(bytes.to_vec()))
    }
}

/// The bytes of a file.
pub(crate) trait Input: BufRead + Seek {}

impl<T: BufRead + Seek> Input for T {}

impl Source {
    /// The file at `path`, and its first bytes: `start` of them, if it has that many.
    ///
    /// A pipe is read completely only if `most` returns a number for its first bytes. It may have no end, and is refused if
    /// it has more bytes than this.
    pub(crate) fn of(
        path: &Path,
        start: usize,
        most: impl FnOnce(&[u8]) -> Option<u64>,
    ) -> io::Result<(Self, Vec<u8>)> {
        let mut file = File::open(path)?;
        let mut bytes = Vec::new();
        Read::by_ref(&mut file)
            .take(start as u64)
            .read_to_end(&mut bytes)?;
        if file.metadata()?.is_file() {
            return Ok((Self::File(path.to_owned()), bytes));
        }
        let first = bytes.clone();
        if let Some(most) = most(&bytes) {
            read_rest(file, &mut bytes, most)?;
        }
        Ok((Self::Memory(Contents(Arc::new(bytes))), first))
    }

    /// A reader that starts at the first byte.
    pub(crate) fn open(&self) -> io::Result<Box<dyn Input>> {
        Ok(match self {
            Self::File(path) => Box::new(BufReader::with_capacity(BUFFER_BYTES, File::open(path)?)),
            Self::Memory(bytes) => Box::new(Cursor::new(bytes.clone())),
        })
    }
}

/// Adds the rest of a pipe to its first bytes. Together they may be `most`.
fn read_rest(pipe: impl Read, bytes: &mut Vec<u8>, most: u64) -> io::Result<()> {
    let before = bytes.len() as u64;
    let allowed = most.saturating_add(1).saturating_sub(before);
    // Returns an error if there is not enough memory.
    pipe.take(allowed).read_to_end(bytes)?;
    if bytes.len() as u64 > most {
        return Err(io::Error::other(format!(
            "it has more than {most} bytes, the most that marbles reads from a pipe; save the picture in a file"
        )));
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pipes_are_read_up_to_a_limit() {
        let read = |rest: &[u8], most| {
            let mut bytes = b"start".to_vec();
            read_rest(rest, &mut bytes, most).map(|()| bytes)
        };
        assert_eq!(read(b" and end", 13).unwrap(), b"start and end");
        assert!(read(b" and end", 12).is_err());
        assert!(read(b"", 4).is_err());
        let endless = read_rest(io::repeat(0), &mut b"start".to_vec(), 1 << 20);
        assert_eq!(
            endless.unwrap_err().to_string(),
            "it has more than 1048576 bytes, the most that marbles reads from a pipe; save the picture in a file"
        );
    }

    #[test]
    fn readers_share_the_contents_of_a_pipe() {
        let contents = Contents::from(&b"abc"[..]);
        let place = contents.as_ref().as_ptr();
        let source = Source::Memory(contents);
        for _ in 0..2 {
            let mut input = source.open().unwrap();
            assert_eq!(input.fill_buf().unwrap().as_ptr(), place);
            let mut text = String::new();
            input.read_to_string(&mut text).unwrap();
            assert_eq!(text, "abc");
        }
    }
}
