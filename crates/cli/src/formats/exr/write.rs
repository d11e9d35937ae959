//! Writes EXR files from blocks.

use std::io::{BufWriter, Read, Seek, SeekFrom, Write};
use std::ops::Range;
use std::path::Path;

use exr::block::chunk::{Chunk, CompressedBlock};
use exr::block::writer::ChunksWriter;
use exr::meta::attribute::SampleType;
use exr::meta::header::{Header, LayerAttributes};
use exr::prelude::{Error, Text, Vec2};
use marbles_core::Summary;

use super::attributes::{set_double, sort_attributes};
use super::blocks::{Blocks, ROWS_OF_A_BLOCK, compress};
use super::header::{achieved, attributes, header_of, pixel_aspect};
use crate::base::failure::Failure;
use crate::base::size::Size;
use crate::files::save::{Fault, save};
use crate::formats::facts::{Facts, SOFTWARE};

/// A generous upper bound of the bytes before the blocks, without the table of blocks and the names of channels.
const HEADER_BYTES: u64 = 1 << 16;
/// The largest number of these bytes per channel.
const CHANNEL_BYTES: u64 = 1 << 9;
/// The number of bytes that are written at a time.
const BUFFER_BYTES: usize = 1 << 18;

/// Writes an EXR with these channels in single precision, completely or not at all. `row` appends the numbers of the
/// next row, pixel by pixel, and returns the columns that they cover; in all other columns the numbers are 0.
pub(crate) fn write_floats(
    size: Size,
    names: &[&str],
    path: &Path,
    mut row: impl FnMut(&mut Vec<f64>) -> Result<Range<u32>, Fault>,
) -> Result<(), Failure> {
    const SAMPLE_BYTES: usize = size_of::<f32>();
    let mut channels: Vec<(usize, &str)> = names.iter().copied().enumerate().collect();
    channels.sort_unstable_by_key(|(_, name)| *name);
    let kinds = channels.iter().map(|(_, name)| (*name, SampleType::F32));
    let attributes = LayerAttributes {
        software_name: Some(Text::from(SOFTWARE)),
        ..LayerAttributes::default()
    };
    let header = header_of(size, kinds.collect()).with_attributes(attributes);
    let row_bytes = SAMPLE_BYTES * names.len() * size.width as usize;
    let mut numbers = Vec::new();
    Ok(save(path, |mut file| {
        write_rows(file.file(), header, |rows| {
            // Empty as long as there are zeros alone.
            let mut samples = Vec::new();
            for above in 0..rows.len() {
                numbers.clear();
                let columns = row(&mut numbers)?;
                if numbers.iter().all(|number| number.to_bits() == 0) {
                    continue;
                }
                samples.resize(above * row_bytes, 0);
                let [before, behind] = [columns.start, size.width - columns.end];
                let [before, behind] =
                    [before, behind].map(|columns| SAMPLE_BYTES * columns as usize);
                for &(channel, _) in &channels {
                    samples.resize(samples.len() + before, 0);
                    let numbers = numbers.iter().skip(channel).step_by(names.len());
                    samples.extend(numbers.flat_map(|&number| (number as f32).to_ne_bytes()));
                    samples.resize(samples.len() + behind, 0);
                }
            }
            if samples.is_empty() {
                return Ok(None);
            }
            samples.resize(rows.len() * row_bytes, 0);
            Ok(Some(samples))
        })?;
        Ok(file)
    })?)
}

/// The header of a picture of this size, with the channels and attributes of another picture, which may be a part of
/// it.
pub(crate) fn header_like(like: &Header, size: Size) -> Header {
    Header {
        channels: like.channels.clone(),
        own_attributes: LayerAttributes {
            layer_position: Vec2(0, 0),
            ..like.own_attributes.clone()
        },
        shared_attributes: like.shared_attributes.clone(),
        ..header_of(size, Vec::new())
    }
}

/// Writes a file with this header. `samples` returns those of some rows, ordered by rows and within a row by channels,
/// or nothing if all of them are 0.
pub(crate) fn write_rows(
    file: &mut (impl Read + Write + Seek),
    header: Header,
    mut samples: impl FnMut(Range<u32>) -> Result<Option<Vec<u8>>, Fault>,
) -> Result<(), Fault> {
    let height = header.layer_size.height() as u32;
    let mut blocks = (0..height).step_by(ROWS_OF_A_BLOCK as usize).enumerate();
    let of_blocks = header.clone();
    // The last block of zeros, and how many bytes they were: those of large pictures of nothing are alike.
    let mut zeros: Option<(usize, Chunk)> = None;
    let next = || {
        let (index, first) = blocks.next().ok_or(Fault::Stopped)?;
        let rows = first..height.min(first + ROWS_OF_A_BLOCK);
        let bytes = rows.len() * of_blocks.layer_size.width() * of_blocks.channels.bytes_per_pixel;
        let samples = samples(rows)?;
        let is_zero = samples.is_none();
        if let Some((same, chunk)) = &mut zeros
            && is_zero
            && *same == bytes
            && let CompressedBlock::ScanLine(block) = &mut chunk.compressed_block
        {
            block.y_coordinate = first as i32;
            return Ok(chunk.clone());
        }
        let samples = samples.unwrap_or_else(|| vec![0; bytes]);
        let chunk = compress(&of_blocks, index, samples).map_err(Fault::Encoding)?;
        if is_zero {
            zeros = Some((bytes, chunk.clone()));
        }
        Ok(chunk)
    };
    write(file, header, next, || Ok(None))
}

/// Writes a file. `next` returns its blocks, and then `summary` returns the results. The same picture and metadata give
/// the same file.
pub(crate) fn write_blocks(
    file: &mut (impl Read + Write + Seek),
    blocks: &Blocks,
    facts: &Facts,
    next: impl FnMut() -> Result<Chunk, Fault>,
    summary: impl FnOnce() -> Option<Summary>,
) -> Result<(), Fault> {
    let mut header = blocks.header.clone();
    header.shared_attributes.pixel_aspect = pixel_aspect(&facts.view);
    let mut attributes = LayerAttributes {
        layer_position: header.own_attributes.layer_position,
        ..attributes(facts)
    };
    attributes.other.extend(header.own_attributes.other.clone());
    write(file, header.with_attributes(attributes), next, || {
        summary().map(Some).ok_or(Fault::Stopped)
    })
}

/// Writes a file with this header. `next` returns its blocks from the top downward; then `summary` may return
/// attributes with the results.
fn write(
    file: &mut (impl Read + Write + Seek),
    header: Header,
    mut next: impl FnMut() -> Result<Chunk, Fault>,
    summary: impl FnOnce() -> Result<Option<Summary>, Fault>,
) -> Result<(), Fault> {
    let header_bytes = HEADER_BYTES + CHANNEL_BYTES * header.channels.list.len() as u64;
    let mut fault = None;
    let buffered = BufWriter::with_capacity(BUFFER_BYTES, &mut *file);
    let written = exr::block::write(
        buffered,
        [header].into_iter().collect(),
        true,
        |_, chunks| {
            for index in 0..chunks.total_chunks_count() {
                match next() {
                    Ok(chunk) => chunks.write_chunk(index, chunk)?,
                    Err(other) => {
                        fault = Some(other);
                        return Err(Error::Aborted);
                    }
                }
            }
            Ok(())
        },
    );
    if let Some(fault) = fault {
        return Err(fault);
    }
    written.map_err(|error| match error {
        Error::Io(error) => Fault::Io(error),
        other => Fault::Encoding(other.to_string()),
    })?;
    let mut start = Vec::new();
    file.seek(SeekFrom::Start(0))?;
    Read::by_ref(file)
        .take(header_bytes)
        .read_to_end(&mut start)?;
    let unknown = || Fault::Encoding("the header has an unknown form".to_owned());
    if let Some(summary) = summary()? {
        for (name, number) in achieved(&summary) {
            set_double(&mut start, name, number).ok_or_else(unknown)?;
        }
    }
    sort_attributes(&mut start).ok_or_else(unknown)?;
    file.seek(SeekFrom::Start(0))?;
    file.write_all(&start)?;
    Ok(())
}
