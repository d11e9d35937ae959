//! The samples of an EXR, row by row.

use std::fs::File;
use std::io::BufReader;

use exr::meta::BlockDescription;
use exr::meta::header::Header;

use super::block_reader::{BlockReader, meta_of};
use crate::formats::source::Input;

/// A file that is being read, whose first part has blocks of whole rows.
pub(crate) struct Rows {
    blocks: BlockReader,
    /// The samples of the rows of a block.
    block: Vec<u8>,
    /// The number of the next row.
    next: usize,
}

impl Rows {
    pub(crate) fn begin(file: File) -> Result<Self, String> {
        let mut file: Box<dyn Input> = Box::new(BufReader::new(file));
        let meta = meta_of(&mut file)?;
        let blocks = BlockReader::of_part(file, meta, 0)?;
        if blocks.header().blocks != BlockDescription::ScanLines {
            return Err("expected blocks of whole rows, found tiles".to_owned());
        }
        Ok(Self {
            blocks,
            block: Vec::new(),
            next: 0,
        })
    }

    pub(crate) fn header(&self) -> &Header {
        self.blocks.header()
    }

    /// The samples of the next row; `None` after the last one.
    pub(crate) fn next(&mut self) -> Result<Option<&[u8]>, String> {
        let header = self.header();
        let size = header.layer_size;
        let bytes = size.width() * header.channels.bytes_per_pixel;
        let rows = header.max_block_pixel_size().height();
        let row = self.next;
        if row == size.height() {
            return Ok(None);
        }
        self.next += 1;
        if row.is_multiple_of(rows) {
            self.block = self.blocks.read(0, row / rows)?;
        }
        let start = row % rows * bytes;
        Ok(self.block.get(start..start + bytes))
    }
}
