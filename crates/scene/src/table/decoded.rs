//! Files that a thread of their own decompresses while what they hold is read.

use std::fs::File;
use std::io::{self, Read};
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::mpsc::{Receiver, sync_channel};
use std::thread;

use super::compression::Compression;
use super::packed::{Blocks, Packed};
use super::{bzip2, gzip, xz, zstandard};

/// Blocks that wait for the reader.
const WAITING: usize = 4;

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
        let mut packed = Packed::new(file, Arc::clone(&taken));
        let mut sent = Blocks::new(sender);
        let decode = move || {
            let end = match compression {
                Compression::Bzip2 => bzip2::decode(&mut packed, &mut sent),
                Compression::Gzip => gzip::decode(&mut packed, &mut sent),
                Compression::Xz => xz::decode(&mut packed, &mut sent),
                Compression::Zstandard => zstandard::decode(&mut packed, &mut sent),
            };
            sent.finish(end);
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
