//! Files compressed by gzip or Zstandard, decompressed by a thread of their own.

use std::fmt;
use std::fs::File;
use std::io::{self, BufRead, BufReader, ErrorKind, Read, Seek, SeekFrom};
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::mpsc::{Receiver, SyncSender, sync_channel};
use std::thread;

use super::{gzip, zstandard};
use crate::text::LocatedFault;

/// The ways in which files are compressed.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub(crate) enum Compression {
    Gzip,
    Zstandard,
}

/// What compressed files may hold without more ado.
const FREE_BYTES: u64 = 1 << 26;
const FREE_COUNT: u64 = 1 << 17;
/// Bytes, and rows or steps, that they may hold for each byte that they have: many times what any table of different
/// spheres is compressed to. A megabyte of nothing else than zeros would take all memory, or hours.
const MOST_FOR_A_BYTE: u64 = 250;
const COUNT_FOR_A_BYTE: u64 = 4;

/// The most bytes that a compressed file of this size may hold.
pub(super) fn most_bytes(stored: u64) -> u64 {
    FREE_BYTES.max(stored.saturating_mul(MOST_FOR_A_BYTE))
}

/// Refuses more rows or steps, which `noun` calls, than a compressed file of this size may hold.
pub(super) fn check_count(stored: u64, count: u64, noun: &str) -> Result<(), LocatedFault> {
    let most = FREE_COUNT.max(stored.saturating_mul(COUNT_FOR_A_BYTE));
    if count <= most {
        return Ok(());
    }
    let message = format!(
        "expected at most {most} {noun} in a compressed file of {stored} bytes, found more: {REMEDY}"
    );
    Err(LocatedFault::of_file(message))
}

/// The way to read a file that holds more.
pub(super) const REMEDY: &str = "decompress it to read it all the same";

/// Bytes that the decoder hands over at a time.
const BLOCK: usize = 1 << 20;
/// Blocks that wait for the reader.
const WAITING: usize = 4;

impl fmt::Display for Compression {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str(match self {
            Self::Gzip => "gzip",
            Self::Zstandard => "Zstandard",
        })
    }
}

impl Compression {
    /// The way in which a file is compressed, by its first bytes; the file is at its start afterwards.
    pub(crate) fn of(file: &mut File) -> io::Result<Option<Self>> {
        let mut start = Vec::new();
        file.by_ref().take(4).read_to_end(&mut start)?;
        file.seek(SeekFrom::Start(0))?;
        Ok(Self::of_bytes(&start))
    }

    /// The way in which bytes that begin so are compressed.
    pub(crate) fn of_bytes(bytes: &[u8]) -> Option<Self> {
        match bytes {
            [0x1f, 0x8b, ..] => Some(Self::Gzip),
            _ if zstandard::is_start(bytes) => Some(Self::Zstandard),
            _ => None,
        }
    }

    /// The endings of names of files that are compressed so.
    pub(crate) const ENDINGS: [&str; 2] = ["gz", "zst"];
}

/// The bytes of a compressed file, in their order.
pub(crate) struct Decoded {
    blocks: Receiver<io::Result<Vec<u8>>>,
    block: Vec<u8>,
    /// The bytes of the block that were read.
    at: usize,
    /// The bytes of the compressed file that the decoder took.
    taken: Arc<AtomicU64>,
}

impl Decoded {
    /// Begins to decompress a file.
    pub(crate) fn new(file: File, compression: Compression) -> io::Result<Self> {
        let (sender, blocks) = sync_channel(WAITING);
        let taken = Arc::new(AtomicU64::new(0));
        let mut packed = Packed {
            file: BufReader::with_capacity(1 << 16, file),
            position: 0,
            taken: Arc::clone(&taken),
        };
        let mut blocks_out = Blocks {
            sender,
            block: Vec::new(),
        };
        let decode = move || {
            let end = match compression {
                Compression::Gzip => gzip::decode(&mut packed, &mut blocks_out),
                Compression::Zstandard => zstandard::decode(&mut packed, &mut blocks_out),
            };
            blocks_out.finish(end);
        };
        thread::Builder::new().spawn(decode)?;
        Ok(Self {
            blocks,
            block: Vec::new(),
            at: 0,
            taken,
        })
    }

    /// The bytes of the compressed file that were taken so far.
    pub(crate) fn taken(&self) -> u64 {
        self.taken.load(Ordering::Relaxed)
    }
}

impl Read for Decoded {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        while self.at == self.block.len() {
            match self.blocks.recv() {
                Ok(block) => (self.block, self.at) = (block?, 0),
                // The decoder has ended.
                Err(_) => return Ok(0),
            }
        }
        let rest = &self.block[self.at..];
        let count = rest.len().min(buffer.len());
        buffer[..count].copy_from_slice(&rest[..count]);
        self.at += count;
        Ok(count)
    }
}

/// The bytes of a compressed file, and how many of them were taken.
pub(super) struct Packed {
    file: BufReader<File>,
    /// The place of the next byte.
    pub(super) position: u64,
    taken: Arc<AtomicU64>,
}

impl Packed {
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
    fn finish(mut self, end: io::Result<()>) {
        if !self.block.is_empty() && !self.send() {
            return;
        }
        if let Err(error) = end {
            // Nobody waits for it where the reader has gone.
            let _ = self.sender.send(Err(error));
        }
    }
}
