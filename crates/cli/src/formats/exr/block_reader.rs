//! The blocks of a part of a file, by their places.

use std::io::{self, Read, Seek, SeekFrom};

use exr::block::UncompressedBlock;
use exr::block::chunk::{
    Chunk, CompressedBlock, CompressedScanLineBlock, CompressedTileBlock, TileCoordinates,
};
use exr::meta::header::Header;
use exr::meta::{BlockDescription, MetaData};
use exr::prelude::Vec2;

use crate::formats::source::Input;

/// A file that is being read.
pub(super) struct BlockReader {
    file: Box<dyn Input>,
    /// The length of the file.
    end: u64,
    meta: MetaData,
    part: usize,
    /// The place of the table of the part's blocks.
    table: u64,
}

/// What a file tells before its blocks; it is read up to there.
pub(super) fn meta_of(file: &mut impl Input) -> Result<MetaData, String> {
    MetaData::read_from_buffered(file, false).map_err(|error| error.to_string())
}

impl BlockReader {
    /// The blocks of this part of the file that was read as far as `meta`.
    pub(super) fn of_part(
        mut file: Box<dyn Input>,
        meta: MetaData,
        part: usize,
    ) -> io::Result<Self> {
        let before = meta.headers[..part].iter();
        let before: u64 = before.map(|header| 8 * header.chunk_count as u64).sum();
        let table = file.stream_position()?.saturating_add(before);
        let end = file.seek(SeekFrom::End(0))?;
        Ok(Self {
            file,
            end,
            meta,
            part,
            table,
        })
    }

    /// The header of the part.
    pub(super) fn header(&self) -> &Header {
        &self.meta.headers[self.part]
    }

    /// The block at this place of the table, with the samples of its rows, in each channel by channel.
    pub(super) fn read(&mut self, index: usize) -> Result<UncompressedBlock, String> {
        let chunk = self.chunk(index).map_err(|error| error.to_string())?;
        let chunk = chunk.ok_or("a block is not where the file says it is")?;
        UncompressedBlock::decompress_chunk(chunk, &self.meta, false)
            .map_err(|error| error.to_string())
    }

    /// The block at this place of the table, compressed; `None` where there can be none.
    ///
    /// No more is allocated than the file has.
    fn chunk(&mut self, index: usize) -> io::Result<Option<Chunk>> {
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
        let most = self.header().max_block_byte_size();
        let is_tiled = matches!(self.header().blocks, BlockDescription::Tiles(_));
        let mut start = [0; 4];
        let numbers = if is_tiled { 4 } else { 1 };
        for number in &mut start[..numbers] {
            *number = self.number()?;
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
            let [Ok(x), Ok(y), Ok(level_x), Ok(level_y)] = start.map(usize::try_from) else {
                return Ok(None);
            };
            CompressedBlock::Tile(CompressedTileBlock {
                coordinates: TileCoordinates {
                    tile_index: Vec2(x, y),
                    level_index: Vec2(level_x, level_y),
                },
                compressed_pixels_le,
            })
        } else {
            CompressedBlock::ScanLine(CompressedScanLineBlock {
                y_coordinate: start[0],
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
