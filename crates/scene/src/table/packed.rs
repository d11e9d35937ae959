//! The bytes of a compressed file, and the blocks of those that it holds.

use std::fs::File;
use std::io::{self, BufRead, BufReader, ErrorKind, Read};
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::mpsc::SyncSender;

/// Bytes that the decoder hands over at a time.
const BLOCK: usize = 1 << 20;
/// The bytes of a compressed file, and how many of them were taken.
pub(super) struct Packed {
    file: BufReader<File>,
    /// The place of the next byte.
    pub(super) position: u64,
    taken: Arc<AtomicU64>,
}

impl Packed {
    /// The bytes of a file; `taken` is how many of them were taken.
    pub(super) fn new(file: File, taken: Arc<AtomicU64>) -> Self {
        Self {
            file: BufReader::with_capacity(1 << 16, file),
            position: 0,
            taken,
        }
    }

    /// Passes over so many bytes; returns how many there were.
    pub(super) fn skip(&mut self, count: u64) -> io::Result<u64> {
        io::copy(&mut self.by_ref().take(count), &mut io::sink())
    }
}

impl Read for Packed {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        let count = self.file.read(buffer)?;
        self.count(count);
        Ok(count)
    }
}

impl BufRead for Packed {
    fn fill_buf(&mut self) -> io::Result<&[u8]> {
        self.file.fill_buf()
    }

    fn consume(&mut self, count: usize) {
        self.file.consume(count);
        self.count(count);
    }
}

impl Packed {
    fn count(&mut self, count: usize) {
        self.position += count as u64;
        self.taken.store(self.position, Ordering::Relaxed);
    }
}

/// Sends decompressed bytes in blocks, whatever parts of the file they come from.
pub(super) struct Blocks {
    sender: SyncSender<io::Result<Vec<u8>>>,
    block: Vec<u8>,
}

impl Blocks {
    /// Blocks for whoever receives them.
    pub(super) fn new(sender: SyncSender<io::Result<Vec<u8>>>) -> Self {
        Self {
            sender,
            block: Vec::new(),
        }
    }

    /// Sends all bytes of a decoder; returns how many there were, `None` where nobody wants them any more.
    pub(super) fn take_all(&mut self, decoder: &mut dyn Read) -> io::Result<Option<u64>> {
        let mut all = 0;
        loop {
            let room = self.block.try_reserve_exact(BLOCK - self.block.len());
            room.map_err(|_| io::Error::from(ErrorKind::OutOfMemory))?;
            let wanted = (BLOCK - self.block.len()) as u64;
            let count = decoder.take(wanted).read_to_end(&mut self.block)?;
            all += count as u64;
            if self.block.len() == BLOCK && !self.send() {
                return Ok(None);
            }
            if (count as u64) < wanted {
                return Ok(Some(all));
            }
        }
    }

    /// Sends the block that is begun; returns whether somebody wants more.
    fn send(&mut self) -> bool {
        let block = std::mem::take(&mut self.block);
        self.sender.send(Ok(block)).is_ok()
    }

    /// Sends the last block, and what went wrong.
    pub(super) fn finish(mut self, end: io::Result<()>) {
        if !self.block.is_empty() && !self.send() {
            return;
        }
        if let Err(error) = end {
            // Nobody waits for it where the reader has gone.
            let _ = self.sender.send(Err(error));
        }
    }
}
