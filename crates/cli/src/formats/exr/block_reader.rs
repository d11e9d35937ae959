//! Reads the blocks of a part of a file, in any order.

use std::io::{self, Read, Seek, SeekFrom};

use exr::block::UncompressedBlock;
use exr::block::chunk::{
    Chunk, CompressedBlock, CompressedScanLineBlock, CompressedTileBlock, TileCoordinates,
};
use exr::meta::header::Header;
use exr::meta::{BlockDescription, MetaData};
use exr::prelude::Vec2;

use crate::base::failure::reason;
use crate::formats::guard::guarded;
use crate::formats::source::Input;

/// A file that is being read.
pub(super) struct BlockReader {
    file: Box<dyn Input>,
    /// The length of the file.
    end: u64,
    meta: MetaData,
    part: usize,
    /// The offset of the table of the part's blocks.
    table: u64,
}

/// The largest memory for a row of blocks, in bytes, that any file may need: a hundred times the usual amount.
const MOST_BYTES: u64 = 1 << 28;
/// Beyond this, the largest memory per byte of the file. Deflate expands a byte to no more, so no file compressed with
/// it, like ours, needs more.
///
/// Source: zlib, "Maximum Compression Factor" in its technical details.
const MOST_FOR_A_BYTE: u64 = 1032;

/// Reads the header of a file, up to its blocks.
pub(super) fn meta_of(file: &mut Box<dyn Input>) -> Result<MetaData, String> {
    guarded(|| MetaData::read_from_buffered(file, false))
}

impl BlockReader {
    /// The blocks of a part of the file, which has been read up to the end of `meta`.
    pub(super) fn of_part(
        mut file: Box<dyn Input>,
        meta: MetaData,
        part: usize,
    ) -> Result<Self, String> {
        let header = &meta.headers[part];
        if header.deep {
            return Err("expected flat pixels, found deep ones".to_owned());
        }
        let before = meta.headers[..part].iter();
        let before: u64 = before.map(|header| 8 * header.chunk_count as u64).sum();
        let mut places = || -> io::Result<(u64, u64)> {
            Ok((file.stream_position()?, file.seek(SeekFrom::End(0))?))
        };
        let (start, end) = places().map_err(|error| reason(&error))?;
        let (size, block) = (header.layer_size, header.max_block_pixel_size());
        let pixels = size.width().checked_mul(block.height().min(size.height()));
        let bytes = pixels.and_then(|pixels| pixels.checked_mul(header.channels.bytes_per_pixel));
        let most = MOST_BYTES.max(MOST_FOR_A_BYTE.saturating_mul(end));
        if bytes.is_none_or(|bytes| bytes as u64 > most) {
            let megabytes = most / 1_000_000;
            return Err(format!(
                "its blocks need more than {megabytes} MB at a time"
            ));
        }
        Ok(Self {
            file,
            end,
            meta,
            part,
            table: start.saturating_add(before),
        })
    }

    /// The header of the part.
    pub(super) fn header(&self) -> &Header {
        &self.meta.headers[self.part]
    }

    /// The samples of the block in this column and row of blocks, in the largest resolution. They are ordered by rows,
    /// and within a row by channels.
    pub(super) fn read(&mut self, column: usize, row: usize) -> Result<Vec<u8>, String> {
        let chunk = self.chunk(column, row).map_err(|error| reason(&error))?;
        let chunk = chunk.ok_or("a block is not at the position that the file states")?;
        let meta = &self.meta;
        let block = guarded(|| UncompressedBlock::decompress_chunk(chunk, meta, false))?;
        let bytes = block.index.pixel_size.area() * self.header().channels.bytes_per_pixel;
        match block.data.len() == bytes {
            true => Ok(block.data),
            false => Err("a block has more or fewer samples than its pixels need".to_owned()),
        }
    }

    /// The compressed block; `None` if it is missing, or at the wrong position.
    ///
    /// Never allocates more than the size of the file.
    fn chunk(&mut self, column: usize, row: usize) -> io::Result<Option<Chunk>> {
        let header = self.header();
        let (size, block) = (header.layer_size, header.max_block_pixel_size());
        let top = header.own_attributes.layer_position.y();
        let is_tiled = matches!(header.blocks, BlockDescription::Tiles(_));
        let most = header.max_block_byte_size();
        // The largest resolution comes first.
        let index = row * size.width().div_ceil(block.width()) + column;
        let entry = self.table.saturating_add(8 * index as u64);
        self.file.seek(SeekFrom::Start(entry))?;
        let place = u64::from_le_bytes(self.numbers()?);
        if place >= self.end {
            return Ok(None);
        }
        self.file.seek(SeekFrom::Start(place))?;
        if self.meta.requirements.is_multilayer() && self.number()? != self.part as i32 {
            return Ok(None);
        }
        let y_coordinate = i64::from(top) + (row * block.height()) as i64;
        let expected: &[i64] = match is_tiled {
            true => &[column as i64, row as i64, 0, 0],
            false => &[y_coordinate],
        };
        for &number in expected {
            if i64::from(self.number()?) != number {
                return Ok(None);
            }
        }
        let Ok(length) = usize::try_from(self.number()?) else {
            return Ok(None);
        };
        if length > most || length as u64 > self.end - place {
            return Ok(None);
        }
        let mut compressed_pixels_le = vec![0; length];
        self.file.read_exact(&mut compressed_pixels_le)?;
        let compressed_block = if is_tiled {
            CompressedBlock::Tile(CompressedTileBlock {
                coordinates: TileCoordinates {
                    tile_index: Vec2(column, row),
                    level_index: Vec2(0, 0),
                },
                compressed_pixels_le,
            })
        } else {
            CompressedBlock::ScanLine(CompressedScanLineBlock {
                y_coordinate: y_coordinate as i32,
                compressed_pixels_le,
            })
        };
        Ok(Some(Chunk {
            layer_index: self.part,
            compressed_block,
        }))
    }

    fn number(&mut self) -> io::Result<i32> {
        self.numbers().map(i32::from_le_bytes)
    }

    fn numbers<const N: usize>(&mut self) -> io::Result<[u8; N]> {
        let mut bytes = [0; N];
        self.file.read_exact(&mut bytes)?;
        Ok(bytes)
    }
}
