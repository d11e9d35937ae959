//! The samples of an EXR, row by row.

use std::fs::File;
use std::io::BufReader;

use exr::block::UncompressedBlock;
use exr::block::reader::{AllChunksReader, ChunksReader};
use exr::error::Error;
use exr::meta::header::Header;

/// A file of one part that is being read.
pub(crate) struct Rows {
    chunks: AllChunksReader<BufReader<File>>,
    /// Samples of rows.
    block: Vec<u8>,
    /// Bytes of them that were handed out.
    used: usize,
}

impl Rows {
    pub(crate) fn begin(file: File) -> Result<Self, Error> {
        let reader = exr::block::read(BufReader::new(file), false)?;
        Ok(Self {
            chunks: reader.all_chunks(false)?,
            block: Vec::new(),
            used: 0,
        })
    }

    pub(crate) fn header(&self) -> &Header {
        &self.chunks.meta_data().headers[0]
    }

    /// The samples of the next row; `None` where the file ends early.
    pub(crate) fn next(&mut self) -> Result<Option<&[u8]>, Error> {
        if self.used == self.block.len() {
            let Some(chunk) = self.chunks.next() else {
                return Ok(None);
            };
            let meta = self.chunks.meta_data();
            self.block = UncompressedBlock::decompress_chunk(chunk?, meta, false)?.data;
            self.used = 0;
        }
        let header = self.header();
        let length = header.layer_size.width() * header.channels.bytes_per_pixel;
        let row = self.used..self.used + length;
        self.used = row.end;
        Ok(self.block.get(row))
    }
}
