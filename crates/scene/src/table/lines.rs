//! The lines of a file, a block at a time.

use std::io::{ErrorKind, Read};

use super::error::TableError;
use super::source::Source;
use crate::text::LocatedFault;

/// The part of a file that is held at a time, in bytes.
const BLOCK: usize = 4 << 20;
/// The longest line that is read, in bytes.
const LONGEST_LINE: usize = 1 << 20;

/// Reads a file line by line, and then by blocks of whole lines.
pub(crate) struct Lines<'watch> {
    file: Source<'watch>,
    buffer: Vec<u8>,
    /// The bytes of the buffer that were read and not yet handed out.
    start: usize,
    end: usize,
    is_at_end: bool,
    /// The number of lines that were handed out.
    pub(crate) number: u64,
    /// The number of bytes that were handed out.
    pub(crate) position: u64,
}

impl<'watch> Lines<'watch> {
    /// The lines of a file; a byte order mark at its start is skipped.
    pub(crate) fn new(file: Source<'watch>) -> Result<Self, TableError> {
        // A byte more than the file has, so that its end is found.
        let whole = file.metadata()?.len().saturating_add(1);
        let size = match usize::try_from(whole) {
            // What is no ordinary file says that it is empty.
            Ok(size) if size > 1 => size.min(BLOCK),
            _ => BLOCK,
        };
        let mut lines = Self {
            file,
            buffer: vec![0; size],
            start: 0,
            end: 0,
            is_at_end: false,
            number: 0,
            position: 0,
        };
        lines.refill()?;
        if lines.buffer[..lines.end].starts_with("\u{feff}".as_bytes()) {
            lines.start = 3;
            lines.position = 3;
        }
        Ok(lines)
    }

    /// The file, of which more may have been read than was handed out.
    pub(crate) fn into_file(self) -> Source<'watch> {
        self.file
    }

    /// The size of the file, in bytes.
    pub(crate) fn size(&self) -> Result<u64, TableError> {
        Ok(self.file.metadata()?.len())
    }

    /// The next line without its end, `None` at the end of the file.
    pub(crate) fn next(&mut self) -> Result<Option<&[u8]>, TableError> {
        let is_break = |&byte: &u8| byte == b'\n';
        let mut length = self.buffer[self.start..self.end].iter().position(is_break);
        if length.is_none() {
            self.refill()?;
            length = self.buffer[self.start..self.end].iter().position(is_break);
        }
        let rest = self.end - self.start;
        let (length, step) = match length {
            Some(length) => (length, length + 1),
            None if rest == 0 => return Ok(None),
            None => (rest, rest),
        };
        if length > LONGEST_LINE {
            return Err(self.too_long());
        }
        let line = self.start..self.start + length;
        self.start += step;
        self.position += step as u64;
        self.number += 1;
        Ok(Some(without_return(&self.buffer[line])))
    }

    /// Some whole lines, `None` at the end of the file. The caller counts them by `count`.
    pub(crate) fn next_block(&mut self) -> Result<Option<&[u8]>, TableError> {
        self.refill()?;
        let rest = &self.buffer[self.start..self.end];
        if rest.is_empty() {
            return Ok(None);
        }
        let last = rest.iter().rposition(|&byte| byte == b'\n');
        let length = match last {
            Some(last) if !self.is_at_end => last + 1,
            None if !self.is_at_end => return Err(self.too_long()),
            _ => rest.len(),
        };
        let block = self.start..self.start + length;
        self.start += length;
        self.position += length as u64;
        Ok(Some(&self.buffer[block]))
    }

    /// Fills the buffer.
    fn refill(&mut self) -> Result<(), TableError> {
        self.buffer.copy_within(self.start..self.end, 0);
        self.end -= self.start;
        self.start = 0;
        while self.end < self.buffer.len() && !self.is_at_end {
            match self.file.read(&mut self.buffer[self.end..]) {
                Ok(0) => self.is_at_end = true,
                Ok(count) => self.end += count,
                Err(error) if error.kind() == ErrorKind::Interrupted => {}
                Err(error) => return Err(error.into()),
            }
        }
        Ok(())
    }

    fn too_long(&self) -> TableError {
        const SHOWN: usize = 100;
        let start = &self.buffer[self.start..self.end];
        let shown = &start[..start.len().min(SHOWN)];
        let message = String::from("expected a line of at most 1 MiB, found a longer one");
        LocatedFault::in_line(self.number + 1, shown, 0..shown.len(), message).into()
    }
}

/// A line without the carriage return at its end.
#[inline(always)]
pub(crate) fn without_return(line: &[u8]) -> &[u8] {
    line.strip_suffix(b"\r").unwrap_or(line)
}
