//! Files compressed by gzip or Zstandard, decompressed by a thread of their own.

use std::fs::File;
use std::io::{self, BufReader, ErrorKind, Read, Seek, SeekFrom};
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::mpsc::{Receiver, SyncSender, sync_channel};
use std::thread;

use flate2::bufread::MultiGzDecoder;
use ruzstd::decoding::StreamingDecoder;

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

impl Compression {
    /// The way in which a file is compressed, by its first bytes; the file is at its start afterwards.
    pub(crate) fn of(file: &mut File) -> io::Result<Option<Self>> {
        let mut start = Vec::new();
        file.by_ref().take(4).read_to_end(&mut start)?;
        file.seek(SeekFrom::Start(0))?;
        Ok(match start[..] {
            [0x1f, 0x8b, ..] => Some(Self::Gzip),
            [0x28, 0xb5, 0x2f, 0xfd] => Some(Self::Zstandard),
            _ => None,
        })
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
        let counted = Counted {
            file,
            taken: Arc::clone(&taken),
        };
        let decode = move || {
            let mut reader = BufReader::with_capacity(1 << 16, counted);
            let end = match compression {
                Compression::Gzip => hand_over(&mut MultiGzDecoder::new(reader), &sender),
                Compression::Zstandard => frames(&mut reader, &sender),
            };
            if let Err(error) = end {
                // Nobody waits for it where the reader has gone.
                let _ = sender.send(Err(error));
            }
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

/// A file that counts what was read of it.
struct Counted {
    file: File,
    taken: Arc<AtomicU64>,
}

impl Read for Counted {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        let count = self.file.read(buffer)?;
        self.taken.fetch_add(count as u64, Ordering::Relaxed);
        Ok(count)
    }
}

/// Decompresses the frames of a Zstandard file, one after another.
fn frames(
    reader: &mut BufReader<Counted>,
    sender: &SyncSender<io::Result<Vec<u8>>>,
) -> io::Result<()> {
    use std::io::BufRead;
    while !reader.fill_buf()?.is_empty() {
        let decoder = StreamingDecoder::new(&mut *reader).map_err(io::Error::other)?;
        hand_over(&mut { decoder }, sender)?;
    }
    Ok(())
}

/// Sends all bytes of a decoder, until it ends or nobody wants them.
fn hand_over(decoder: &mut dyn Read, sender: &SyncSender<io::Result<Vec<u8>>>) -> io::Result<()> {
    loop {
        let mut block = Vec::new();
        let room = block.try_reserve_exact(BLOCK);
        room.map_err(|_| io::Error::from(ErrorKind::OutOfMemory))?;
        let count = decoder.take(BLOCK as u64).read_to_end(&mut block)?;
        if count == 0 || sender.send(Ok(block)).is_err() {
            return Ok(());
        }
    }
}
