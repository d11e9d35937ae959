//! The bytes of a table, by lines, by blocks of lines, or as they are.

use std::io::{self, ErrorKind, Read};

use super::error::TableError;
use super::source::Source;
use crate::text::LocatedFault;

/// The part of a text that is held at a time, in bytes.
const BLOCK: usize = 4 << 20;
/// The part that is read to tell the format, in bytes.
const HEAD: usize = 1 << 16;
/// The longest line that is read, in bytes.
const LONGEST_LINE: usize = 1 << 20;

/// Reads a file line by line, by blocks of whole lines, or byte by byte.
pub(crate) struct Input<'watch> {
    source: Source<'watch>,
    buffer: Vec<u8>,
    /// The bytes of the buffer that were read and not yet handed out.
    start: usize,
    end: usize,
    is_at_end: bool,
    /// The number of lines that were handed out.
    pub(crate) number: u64,
    /// The number of bytes that were handed out.
    pub(crate) position: u64,
    /// The last line that was handed out is the file's, and nothing ends it.
    is_open_at_end: bool,
    /// Possible faults in the file that the format leaves in doubt, and what of it is left out.
    doubts: Vec<LocatedFault>,
    /// The bytes of all blocks, those that were taken back as often as they were handed out.
    #[cfg(test)]
    handed_out: u64,
}

impl<'watch> Input<'watch> {
    /// The bytes of a file; a byte order mark at its start is skipped.
    pub(crate) fn new(source: Source<'watch>) -> Result<Self, TableError> {
        // A byte more than the file has, so that its end is found.
        let whole = source.size().map_or(BLOCK, |size| {
            usize::try_from(size).map_or(BLOCK, |size| size.saturating_add(1).min(BLOCK))
        });
        let mut input = Self {
            source,
            buffer: vec![0; whole],
            start: 0,
            end: 0,
            is_at_end: false,
            number: 0,
            position: 0,
            is_open_at_end: false,
            doubts: Vec::new(),
            #[cfg(test)]
            handed_out: 0,
        };
        input.fill(HEAD)?;
        if input.head().starts_with("\u{feff}".as_bytes()) {
            input.start = 3;
            input.position = 3;
        }
        Ok(input)
    }

    /// The bytes that come next, some thousands unless the file ends before.
    pub(crate) fn head(&self) -> &[u8] {
        &self.buffer[self.start..self.end]
    }

    /// The file that is read.
    pub(crate) fn source(&self) -> &Source<'watch> {
        &self.source
    }

    /// Passes over all that is left of a compressed file, whose checksums tell whether what was read is right.
    pub(crate) fn finish(&mut self) -> io::Result<()> {
        if !self.can_seek() {
            (self.start, self.end) = (0, 0);
            io::copy(&mut self.source, &mut io::sink())?;
        }
        Ok(())
    }

    /// Notes what may be wrong in the file, where the format cannot tell.
    ///
    /// A compressed file that was read to its end is known to be whole.
    pub(crate) fn doubt(&mut self, doubt: LocatedFault) {
        if self.can_seek() {
            self.doubts.push(doubt);
        }
    }

    /// Notes what is left out of the file.
    pub(crate) fn leave_out(&mut self, left_out: LocatedFault) {
        self.doubts.push(left_out);
    }

    /// Notes what may be wrong at the line that was handed out last.
    pub(crate) fn doubt_line(&mut self, doubt: &str) {
        self.doubt(LocatedFault::in_line(
            self.number,
            b"",
            0..0,
            doubt.to_owned(),
        ));
    }

    /// Takes possible faults in the file and what is left out of it, as far as it was read.
    pub(crate) fn take_doubts(&mut self) -> Vec<LocatedFault> {
        std::mem::take(&mut self.doubts)
    }

    /// Says whether bytes follow that were not handed out.
    pub(crate) fn has_rest(&mut self) -> Result<bool, TableError> {
        self.refill()?;
        Ok(self.start < self.end)
    }

    /// Some bytes that come next; none at the end of the file.
    pub(crate) fn ahead(&mut self) -> Result<&[u8], TableError> {
        if self.start == self.end {
            self.refill()?;
        }
        Ok(self.head())
    }

    /// Passes over bytes that come next.
    pub(crate) fn pass(&mut self, bytes: usize) {
        self.start += bytes;
        self.position += bytes as u64;
    }

    /// Says whether nothing ends the last line that was handed out.
    pub(crate) fn is_open_at_end(&self) -> bool {
        self.is_open_at_end
    }

    /// The size of the file, in bytes, where it is known.
    pub(crate) fn size(&self) -> Option<u64> {
        self.source.size()
    }

    /// The bytes of all blocks that were handed out, those that were taken back as often as they were.
    #[cfg(test)]
    pub(crate) fn handed_out(&self) -> u64 {
        self.handed_out
    }

    /// Refuses more rows or steps, which `noun` calls, than a compressed file may hold.
    pub(crate) fn check_count(&self, count: u64, noun: &str) -> Result<(), LocatedFault> {
        self.source.check_count(count, noun)
    }

    /// Refuses more bytes in memory, of what `noun` calls, than a compressed file may hold.
    pub(crate) fn check_bytes(&self, bytes: u64, noun: &str) -> Result<(), LocatedFault> {
        self.source.check_bytes(bytes, noun)
    }

    /// True where any byte can be read next.
    pub(crate) fn can_seek(&self) -> bool {
        self.source.can_seek()
    }

    /// Continues at this byte, which begins the line after so many. Where the bytes come in their order, it must not
    /// lie before the next one.
    pub(crate) fn skip_to(&mut self, position: u64, lines: u64) -> io::Result<()> {
        let ahead = position.checked_sub(self.position);
        match ahead.and_then(|ahead| usize::try_from(ahead).ok()) {
            Some(ahead) if ahead <= self.end - self.start => self.start += ahead,
            _ if self.can_seek() => {
                self.source.seek(position)?;
                (self.start, self.end, self.is_at_end) = (0, 0, false);
            }
            Some(ahead) => {
                let rest = (ahead - (self.end - self.start)) as u64;
                (self.start, self.end) = (0, 0);
                let passed = io::copy(&mut self.source.by_ref().take(rest), &mut io::sink())?;
                if passed < rest {
                    return Err(ErrorKind::UnexpectedEof.into());
                }
            }
            None => return Err(ErrorKind::NotSeekable.into()),
        }
        (self.position, self.number) = (position, lines);
        Ok(())
    }

    /// The next line without its end, `None` at the end of the file.
    pub(crate) fn next(&mut self) -> Result<Option<&[u8]>, TableError> {
        let Some(length) = self.find_line()? else {
            return Ok(None);
        };
        let step = length + usize::from(self.start + length < self.end);
        let line = self.start..self.start + length;
        self.is_open_at_end = step == length;
        self.start += step;
        self.position += step as u64;
        self.number += 1;
        Ok(Some(without_return(&self.buffer[line])))
    }

    /// The line that [`Self::next`] will hand out.
    pub(crate) fn peek(&mut self) -> Result<Option<&[u8]>, TableError> {
        let length = self.find_line()?;
        Ok(length.map(|length| without_return(&self.buffer[self.start..self.start + length])))
    }

    /// The length of the next line without its end.
    fn find_line(&mut self) -> Result<Option<usize>, TableError> {
        let mut length = memchr::memchr(b'\n', self.head());
        if length.is_none() {
            self.refill()?;
            length = memchr::memchr(b'\n', self.head());
        }
        let rest = self.end - self.start;
        let length = match length {
            Some(length) => length,
            None if rest == 0 => return Ok(None),
            None => rest,
        };
        match length > LONGEST_LINE {
            true => Err(self.too_long()),
            false => Ok(Some(length)),
        }
    }

    /// Some whole lines, at most so many and about so many bytes, `None` at the end of the file. The caller counts
    /// them by `number`.
    pub(crate) fn next_block(
        &mut self,
        most: u64,
        bytes: usize,
    ) -> Result<Option<&[u8]>, TableError> {
        // What is left is moved to be filled up, which for many small blocks should not be all of it each time.
        let has_enough = self.head().len() >= bytes.min(self.buffer.len() / 2);
        if !self.is_at_end && (!has_enough || memchr::memchr(b'\n', self.head()).is_none()) {
            self.refill()?;
        }
        let rest = self.head();
        if rest.is_empty() {
            return Ok(None);
        }
        let ahead = rest.get(bytes..).unwrap_or_default();
        let mut length = match memchr::memchr(b'\n', ahead) {
            Some(end) => bytes + end + 1,
            None if self.is_at_end => rest.len(),
            None => match memchr::memrchr(b'\n', rest) {
                Some(last) => last + 1,
                None => return Err(self.too_long()),
            },
        };
        // A line has a byte at least. Lines are counted in less time than their ends are found.
        if most < length as u64 {
            let ends = memchr::memchr_iter(b'\n', &rest[..length]);
            if most <= ends.clone().count() as u64
                && let Some(last) = most.checked_sub(1)
                && let Some(end) = ends.clone().nth(last as usize)
            {
                length = end + 1;
            }
        }
        self.is_open_at_end = !rest[..length].ends_with(b"\n");
        let block = self.start..self.start + length;
        self.start += length;
        self.position += length as u64;
        #[cfg(test)]
        {
            self.handed_out += length as u64;
        }
        Ok(Some(&self.buffer[block]))
    }

    /// Takes back the last bytes of the last block.
    pub(crate) fn take_back(&mut self, bytes: usize) {
        self.start -= bytes;
        self.position -= bytes as u64;
    }

    /// Passes over so many lines; returns how many there were.
    pub(crate) fn skip_lines(&mut self, count: u64) -> Result<u64, TableError> {
        let mut skipped = 0;
        while skipped < count {
            let Some(block) = self.next_block(count - skipped, BLOCK)? else {
                break;
            };
            let ends = memchr::memchr_iter(b'\n', block).count() as u64;
            skipped += ends + u64::from(!block.ends_with(b"\n"));
        }
        self.number += skipped;
        Ok(skipped)
    }

    /// Fills the buffer.
    fn refill(&mut self) -> Result<(), TableError> {
        self.buffer.copy_within(self.start..self.end, 0);
        self.end -= self.start;
        self.start = 0;
        self.fill(self.buffer.len())
    }

    /// Reads until the buffer holds so many bytes.
    fn fill(&mut self, size: usize) -> Result<(), TableError> {
        let size = size.min(self.buffer.len());
        while self.end < size && !self.is_at_end {
            match self.source.read(&mut self.buffer[self.end..size]) {
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
        let start = self.head();
        let shown = &start[..start.len().min(SHOWN)];
        let message = String::from("expected a line of at most 1 MiB, found a longer one");
        LocatedFault::in_line(self.number + 1, shown, 0..shown.len(), message).into()
    }
}

impl Read for Input<'_> {
    fn read(&mut self, bytes: &mut [u8]) -> io::Result<usize> {
        let head = &self.buffer[self.start..self.end];
        let count = match head.len().min(bytes.len()) {
            // What is not buffered goes where it is wanted at once.
            0 => self.source.read(bytes)?,
            count => {
                bytes[..count].copy_from_slice(&head[..count]);
                self.start += count;
                count
            }
        };
        self.position += count as u64;
        Ok(count)
    }
}

/// A line without the carriage return at its end.
#[inline(always)]
pub(crate) fn without_return(line: &[u8]) -> &[u8] {
    line.strip_suffix(b"\r").unwrap_or(line)
}
