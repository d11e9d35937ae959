//! The file of a table, decompressed where it is compressed, which tells how much of it was read.

use std::fs::File;
use std::io::{self, Read, Seek, SeekFrom};
use std::path::{Path, PathBuf};

use super::compression::{Compression, REMEDY, check_bytes, check_count, most_bytes};
use super::decoded::Decoded;
use super::file_state::FileState;
use super::memory::{Memory, TableBytes};
use crate::text::LocatedFault;

/// The bytes of a table, whose reading somebody watches.
pub(crate) struct Source<'watch> {
    stream: Stream,
    path: PathBuf,
    /// The way in which the file is compressed, where it is.
    pub(crate) compression: Option<Compression>,
    /// The state of the file when it was opened.
    pub(crate) state: FileState,
    /// The bytes of the file that were read.
    read: u64,
    /// The bytes that were decompressed.
    decompressed: u64,
    /// Called with the number of bytes read so far, and those that there are.
    watch: &'watch (dyn Fn(u64, u64) + Sync),
}

/// The way from the file to its bytes.
enum Stream {
    Memory(Memory),
    Plain(File),
    Decoded(Decoded),
}

impl<'watch> Source<'watch> {
    /// Opens the file at `path`. `watch` is called after every reading, of which there is one for megabytes.
    pub(crate) fn open(path: &Path, watch: &'watch (dyn Fn(u64, u64) + Sync)) -> io::Result<Self> {
        // Before it is opened: a pipe to which nobody writes is opened after all time.
        let state = FileState::of(path)?;
        let mut file = File::open(path)?;
        let compression = Compression::of(&mut file)?;
        let stream = match compression {
            None => Stream::Plain(file),
            Some(compression) => Stream::Decoded(Decoded::new(file, compression)?),
        };
        Ok(Self {
            stream,
            path: path.to_owned(),
            compression,
            state,
            read: 0,
            decompressed: 0,
            watch,
        })
    }

    /// The table in memory that `path` names. `watch` is called after every reading.
    pub(crate) fn in_memory(
        path: &Path,
        bytes: TableBytes,
        watch: &'watch (dyn Fn(u64, u64) + Sync),
    ) -> Self {
        let memory = Memory::new(bytes);
        Self {
            state: FileState::in_memory(memory.size()),
            stream: Stream::Memory(memory),
            path: path.to_owned(),
            compression: None,
            read: 0,
            decompressed: 0,
            watch,
        }
    }

    /// The file that is read.
    pub(crate) fn path(&self) -> &Path {
        &self.path
    }

    /// The number of bytes, where it is known before they are read.
    pub(crate) fn size(&self) -> Option<u64> {
        self.can_seek().then_some(self.state.size)
    }

    /// True where any byte can be read next.
    pub(crate) fn can_seek(&self) -> bool {
        matches!(self.stream, Stream::Plain(_) | Stream::Memory(_))
    }

    /// Says whether the file is still the one that was opened.
    pub(crate) fn is_unchanged(&self) -> io::Result<bool> {
        match self.stream {
            Stream::Memory(_) => Ok(true),
            Stream::Plain(_) | Stream::Decoded(_) => Ok(FileState::of(&self.path)? == self.state),
        }
    }

    /// Refuses more rows or steps, which `noun` calls, than a compressed file may hold.
    pub(crate) fn check_count(&self, count: u64, noun: &str) -> Result<(), LocatedFault> {
        match self.stream {
            Stream::Decoded(_) => check_count(self.state.size, count, noun),
            Stream::Plain(_) | Stream::Memory(_) => Ok(()),
        }
    }

    /// Refuses more bytes in memory, of what `noun` calls, than a compressed file may hold.
    pub(crate) fn check_bytes(&self, bytes: u64, noun: &str) -> Result<(), LocatedFault> {
        match self.stream {
            Stream::Decoded(_) => check_bytes(self.state.size, bytes, noun),
            Stream::Plain(_) | Stream::Memory(_) => Ok(()),
        }
    }

    /// Continues at this byte.
    ///
    /// # Errors
    /// Fails where the bytes come in their order only.
    pub(crate) fn seek(&mut self, to: u64) -> io::Result<()> {
        match &mut self.stream {
            Stream::Plain(file) => file.seek(SeekFrom::Start(to)).map(|_| ()),
            Stream::Memory(memory) => {
                memory.seek(to);
                Ok(())
            }
            Stream::Decoded(_) => Err(io::ErrorKind::NotSeekable.into()),
        }
    }
}

impl Read for Source<'_> {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        let count = match &mut self.stream {
            Stream::Plain(file) => {
                let count = file.read(buffer)?;
                self.read += count as u64;
                count
            }
            Stream::Memory(memory) => {
                let count = memory.read(buffer)?;
                self.read += count as u64;
                count
            }
            Stream::Decoded(decoded) => {
                let count = decoded.read(buffer)?;
                self.read = decoded.taken();
                self.decompressed += count as u64;
                let stored = self.state.size;
                let most = most_bytes(stored);
                if self.decompressed > most {
                    return Err(io::Error::other(format!(
                        "its {stored} bytes decompress to more than {most}; {REMEDY}"
                    )));
                }
                count
            }
        };
        (self.watch)(self.read, self.state.size);
        Ok(count)
    }
}
