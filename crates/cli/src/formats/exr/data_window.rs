//! The samples of a part of a file, by position: scan lines in any order, and tiles.

use std::ops::Range;

use exr::meta::MetaData;
use exr::meta::attribute::SampleType;
use exr::meta::header::Header;
use exr::prelude::f16;

use super::block_reader::BlockReader;
use crate::formats::source::Input;

/// The samples of the largest resolution of a part, read row by row.
pub(super) struct DataWindow {
    reader: BlockReader,
    /// The top left corner, relative to that of the display window.
    origin: (i64, i64),
    size: (usize, usize),
    /// Columns and rows of a block; the last blocks may be smaller.
    block: (usize, usize),
    /// Bytes per pixel, in all channels.
    pixel_bytes: usize,
    /// The samples of the row of blocks that contains the current row, and the number of this row of blocks.
    blocks: Vec<Vec<u8>>,
    row_of_blocks: Option<usize>,
    /// The number of the current row in the display window; -1 before the first.
    row: i64,
}

/// A channel of a part.
#[derive(Clone, Copy, Debug)]
pub(super) struct Channel {
    pub(super) kind: SampleType,
    /// Bytes per pixel in the channels before it.
    before: usize,
}

/// The position of a pixel of the current row in its block.
#[derive(Clone, Copy, Debug)]
pub(super) struct Place {
    block: usize,
    /// Columns of the block.
    columns: usize,
    col: usize,
}

impl Channel {
    /// The channel with this name.
    pub(super) fn of(header: &Header, name: &str) -> Option<Self> {
        let mut before = 0;
        for channel in &header.channels.list {
            if channel.name == *name {
                let kind = channel.sample_type;
                return Some(Self { kind, before });
            }
            before += channel.sample_type.bytes_per_sample();
        }
        None
    }
}

impl DataWindow {
    /// The samples of a part of the file, which has been read up to the end of `meta`.
    pub(super) fn of_part(
        file: Box<dyn Input>,
        meta: MetaData,
        part: usize,
    ) -> Result<Self, String> {
        let reader = BlockReader::of_part(file, meta, part)?;
        let header = reader.header();
        let block = header.max_block_pixel_size();
        let (width, height) = (header.layer_size.width(), header.layer_size.height());
        let pixel_bytes = header.channels.bytes_per_pixel;
        let display = header.shared_attributes.display_window.position;
        let position = header.own_attributes.layer_position;
        let offset = |data: i32, display: i32| i64::from(data) - i64::from(display);
        Ok(Self {
            origin: (
                offset(position.x(), display.x()),
                offset(position.y(), display.y()),
            ),
            size: (width, height),
            block: (block.width(), block.height()),
            pixel_bytes,
            blocks: Vec::new(),
            row_of_blocks: None,
            row: -1,
            reader,
        })
    }

    /// The top left corner, relative to that of the display window.
    pub(super) fn origin(&self) -> (i64, i64) {
        self.origin
    }

    /// Columns and rows.
    pub(super) fn size(&self) -> (usize, usize) {
        self.size
    }

    /// Advances to the next row of the display window.
    pub(super) fn advance(&mut self) -> Result<(), String> {
        self.row += 1;
        let Some(row) = self.row_of_window() else {
            return Ok(());
        };
        let row_of_blocks = row / self.block.1;
        if self.row_of_blocks != Some(row_of_blocks) {
            self.blocks.clear();
            for column in 0..self.size.0.div_ceil(self.block.0) {
                let samples = self.reader.read(column, row_of_blocks)?;
                self.blocks.push(samples);
            }
            self.row_of_blocks = Some(row_of_blocks);
        }
        Ok(())
    }

    /// The number of the current row in the data window; `None` outside of it.
    fn row_of_window(&self) -> Option<usize> {
        let row = usize::try_from(self.row - self.origin.1).ok()?;
        (row < self.size.1).then_some(row)
    }

    /// The columns of the display window that are inside the data window in the current row; none if the row is
    /// outside.
    pub(super) fn columns(&self) -> Range<u32> {
        if self.row_of_window().is_none() {
            return 0..0;
        }
        let end = self.origin.0.saturating_add_unsigned(self.size.0 as u64);
        // What lies left of the display window is cut off, and so is what is farther right than any picture reaches.
        let column = |place: i64| place.clamp(0, i64::from(u32::MAX)) as u32;
        column(self.origin.0)..column(end)
    }

    /// The position of the pixel in this column of the display window; `None` outside the data window.
    pub(super) fn place(&self, col: u32) -> Option<Place> {
        self.row_of_window()?;
        let col = usize::try_from(i64::from(col) - self.origin.0).ok()?;
        let block = col / self.block.0;
        let first = block * self.block.0;
        (col < self.size.0).then(|| Place {
            block,
            columns: self.block.0.min(self.size.0 - first),
            col: col - first,
        })
    }

    /// The end of the columns of the display window, starting with this one, that are known to have equal samples of
    /// these channels.
    pub(super) fn end_of_run<'a>(
        &self,
        col: u32,
        channels: impl Iterator<Item = &'a Channel> + Clone,
    ) -> u32 {
        let Some(place) = self.place(col) else {
            let start = self.columns().start;
            return if col < start { start } else { u32::MAX };
        };
        // Whether the samples of some columns, counted from this one, are those of the next ones in all channels.
        let repeat = |from: usize, to: usize| {
            channels.clone().all(|channel| {
                let bytes = channel.kind.bytes_per_sample();
                let samples = self.samples(place, channel);
                let next = samples.get((from + 1) * bytes..(to + 1) * bytes);
                next.is_some_and(|next| next == &samples[from * bytes..to * bytes])
            })
        };
        // Never looks much farther than all channels repeat, so that all runs of a row are found in the time of one.
        let (mut repeats, mut step) = (0, 1);
        while step > 0 {
            if repeat(repeats, repeats + step) {
                repeats += step;
                step *= 2;
            } else {
                step /= 2;
            }
        }
        col + 1 + repeats as u32
    }

    /// The number of a channel at this position.
    pub(super) fn value(&self, place: Place, channel: &Channel) -> f64 {
        match (channel.kind, self.samples(place, channel)) {
            (SampleType::F16, &[a, b, ..]) => f16::from_ne_bytes([a, b]).to_f64(),
            (SampleType::F32, &[a, b, c, d, ..]) => f32::from_ne_bytes([a, b, c, d]).into(),
            (SampleType::U32, &[a, b, c, d, ..]) => u32::from_ne_bytes([a, b, c, d]).into(),
            _ => 0.0,
        }
    }

    /// The samples of a channel in the current row of a block, starting at this position.
    fn samples(&self, place: Place, channel: &Channel) -> &[u8] {
        let Place {
            block,
            columns,
            col,
        } = place;
        let row = self.row_of_window().unwrap_or(0) % self.block.1;
        let line = row * columns * self.pixel_bytes + channel.before * columns;
        let place = |col: usize| line + col * channel.kind.bytes_per_sample();
        &self.blocks[block][place(col)..place(columns)]
    }
}
