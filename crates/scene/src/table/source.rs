//! The file of a table, which tells how much of it was read.

use std::fs::{File, Metadata};
use std::io::{self, Read, Seek, SeekFrom};

/// A file whose reader somebody watches.
pub(crate) struct Source<'watch> {
    file: File,
    read: u64,
    /// Called with the number of bytes read so far.
    watch: &'watch dyn Fn(u64),
}

impl<'watch> Source<'watch> {
    /// `watch` is called after every reading, of which there is one for megabytes.
    pub(crate) fn new(file: File, watch: &'watch dyn Fn(u64)) -> Self {
        let read = 0;
        Self { file, read, watch }
    }

    pub(crate) fn metadata(&self) -> io::Result<Metadata> {
        self.file.metadata()
    }
}

impl Read for Source<'_> {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        let count = self.file.read(buffer)?;
        self.read += count as u64;
        (self.watch)(self.read);
        Ok(count)
    }
}

impl Seek for Source<'_> {
    fn seek(&mut self, to: SeekFrom) -> io::Result<u64> {
        self.file.seek(to)
    }
}
