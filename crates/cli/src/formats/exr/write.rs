//! OpenEXR: linear light, and what is known of the camera that saw it.

use std::io::{BufWriter, Read, Seek, SeekFrom, Write};
use std::ops::Range;

use exr::block::chunk::Chunk;
use exr::block::writer::ChunksWriter;
use exr::block::{BlockIndex, UncompressedBlock};
use exr::meta::BlockDescription;
use exr::meta::attribute::{ChannelDescription, Chromaticities, LineOrder, SampleType};
use exr::meta::header::{Header, ImageAttributes, LayerAttributes};
use exr::prelude::{AttributeValue, Compression, Error, IntegerBounds, SmallVec, Text, Vec2};
use glam::DVec3;
use marbles_core::{Camera, Channels, Image, Method};

use super::header;
use crate::base::memory::Form;
use crate::base::region::Region;
use crate::commands::args::Size;
use crate::formats::frame_rate;
use crate::formats::{DIGEST_ATTRIBUTE, Facts, Fault, SOFTWARE, half};

/// CIE xy of the primaries and the white of Rec. 709.
const REC_709: Chromaticities = Chromaticities {
    red: Vec2(0.64, 0.33),
    green: Vec2(0.3, 0.6),
    blue: Vec2(0.15, 0.06),
    white: Vec2(0.3127, 0.329),
};

/// How an EXR file is written.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub(crate) struct ExrOptions {
    /// Single precision instead of half.
    pub(crate) float: bool,
    /// A channel with the error of each pixel.
    pub(crate) error: bool,
}

/// The channel with the error of each pixel: how far any of its other channels may be from the
/// exact average, before they are rounded to the format. Infinite where nothing is known.
const ERROR_CHANNEL: &str = "error";

/// Rows that are compressed together.
pub(in crate::formats) const ROWS_OF_A_BLOCK: u32 = 16;
/// What a file has at most before its blocks and their places, generously.
const HEADER_BYTES: u64 = 1 << 16;
/// Bytes that are written at a time.
const BUFFER_BYTES: usize = 1 << 18;

/// How the light and the errors of pictures become blocks of a file.
#[derive(Clone, Debug)]
pub(in crate::formats) struct Blocks {
    options: ExrOptions,
    channels: Vec<Channel>,
    /// Without what a file says of its picture, which does not matter to the blocks.
    header: Header,
}

/// A channel of a file.
#[derive(Clone, Copy, Debug)]
struct Channel {
    name: &'static str,
    source: Source,
    /// Bytes of a sample.
    bytes: usize,
}

/// Where the numbers of a channel come from.
#[derive(Clone, Copy, Debug)]
enum Source {
    /// From red, green, blue and alpha, by number.
    Light(usize),
    Error,
}

impl ExrOptions {
    /// The blocks of such a picture.
    pub(in crate::formats) fn blocks(self, form: &Form) -> Blocks {
        let light = |(source, name)| Channel {
            name,
            source: Source::Light(source),
            bytes: if self.float { 4 } else { 2 },
        };
        // In the order of their names.
        let names = [(3, "A"), (2, "B"), (1, "G"), (0, "R")].into_iter();
        let names = names.skip(usize::from(!form.alpha));
        let mut channels: Vec<Channel> = names.map(light).collect();
        if self.error {
            channels.push(Channel {
                name: ERROR_CHANNEL,
                source: Source::Error,
                // Errors are floats in any case: the least half above 0 is 6e-8, which many are below.
                bytes: 4,
            });
        }
        let kind = |channel: &Channel| match channel.bytes {
            2 => SampleType::F16,
            _ => SampleType::F32,
        };
        let names = channels.iter().map(|channel| (channel.name, kind(channel)));
        let size = (form.width, form.height);
        let mut header = header_of(size, names.collect());
        if let Some(Region { window, whole }) = form.part {
            let position = Vec2(window.col as i32, window.row as i32);
            header.own_attributes.layer_position = position;
            let size = (whole.width as usize, whole.height as usize);
            header.shared_attributes.display_window = IntegerBounds::from_dimensions(size);
        }
        Blocks {
            options: self,
            channels,
            header,
        }
    }

    /// Puts numbers into the samples of a channel of light; how many were too large.
    fn light(self, samples: &mut [u8], light: impl Iterator<Item = f64>) -> u64 {
        let mut clipped = 0;
        if self.float {
            let (floats, _) = samples.as_chunks_mut();
            for (sample, value) in floats.iter_mut().zip(light) {
                let value = clip(value, f32::MAX.into(), &mut clipped);
                *sample = float(value).to_ne_bytes();
            }
        } else {
            let (halves, _) = samples.as_chunks_mut();
            for (sample, value) in halves.iter_mut().zip(light) {
                let value = clip(value, half::LARGEST, &mut clipped);
                *sample = half::nearest(value).to_ne_bytes();
            }
        }
        clipped
    }
}

impl Blocks {
    /// Bytes of a row's samples.
    pub(in crate::formats) fn row_bytes(&self) -> usize {
        let pixel: usize = self.channels.iter().map(|channel| channel.bytes).sum();
        self.header.layer_size.x() * pixel
    }

    /// Puts the numbers of some rows of an image where they belong in `samples`, which are as many
    /// rows, from the column `col` on; how many were too large.
    pub(in crate::formats) fn encode(
        &self,
        samples: &mut [u8],
        col: u32,
        image: &Image,
        rows: Range<u32>,
    ) -> u64 {
        let mut clipped = 0;
        let columns = self.header.layer_size.x();
        let is_grey = image.channels() == Channels::Grey;
        for (samples, row) in samples.chunks_exact_mut(self.row_bytes()).zip(rows) {
            let mut end = 0;
            // Where the first color of a grey picture is, and how many numbers of it were too large.
            let mut grey = None;
            for channel in &self.channels {
                let start = end + col as usize * channel.bytes;
                let own = start..start + image.width() as usize * channel.bytes;
                end += columns * channel.bytes;
                clipped += match channel.source {
                    Source::Error => {
                        let (floats, _) = samples[own].as_chunks_mut();
                        for (float, col) in floats.iter_mut().zip(0..) {
                            *float = float_above(image.error(col, row)).to_ne_bytes();
                        }
                        0
                    }
                    Source::Light(source) => match &grey {
                        Some((first, clipped)) if source < 3 => {
                            samples.copy_within(Range::clone(first), start);
                            *clipped
                        }
                        _ => {
                            let light = (0..image.width()).map(|col| image.rgba(col, row)[source]);
                            let clipped = self.options.light(&mut samples[own.clone()], light);
                            if is_grey && source < 3 {
                                grey = Some((own, clipped));
                            }
                            clipped
                        }
                    },
                };
            }
        }
        clipped
    }

    /// The block with this index, counted from the top, compressed.
    pub(in crate::formats) fn compress(
        &self,
        index: u32,
        samples: Vec<u8>,
    ) -> Result<Chunk, String> {
        compress(&self.header, index as usize, samples)
    }

    /// Writes a file whose blocks `next` gives, the same for the same picture and facts.
    pub(in crate::formats) fn write(
        &self,
        file: &mut (impl Read + Write + Seek),
        facts: &Facts,
        next: impl FnMut() -> Result<Chunk, Fault>,
    ) -> Result<(), Fault> {
        let attributes = LayerAttributes {
            layer_position: self.header.own_attributes.layer_position,
            ..attributes(facts)
        };
        let header = self.header.clone().with_attributes(attributes);
        write(file, header, next)
    }
}

/// Writes a picture in single precision, of channels with these names.
pub(in crate::formats) fn write_floats(
    file: &mut (impl Read + Write + Seek),
    (width, height): (u32, u32),
    mut channels: Vec<(&str, Vec<f32>)>,
) -> Result<(), Fault> {
    channels.sort_unstable_by_key(|(name, _)| *name);
    let names = channels.iter().map(|(name, _)| (*name, SampleType::F32));
    let header = header_of((width, height), names.collect());
    let attributes = LayerAttributes {
        software_name: Some(Text::from(SOFTWARE)),
        ..LayerAttributes::default()
    };
    let header = header.with_attributes(attributes);
    let mut rows = (0..height as usize).step_by(ROWS_OF_A_BLOCK as usize);
    let (of_blocks, width) = (header.clone(), width as usize);
    write(file, header, || {
        let first = rows.next().ok_or(Fault::Stopped)?;
        let last = (height as usize).min(first + ROWS_OF_A_BLOCK as usize);
        let lines = (first..last)
            .flat_map(|row| channels.iter().map(move |(_, values)| (row, values)))
            .flat_map(|(row, values)| &values[row * width..(row + 1) * width]);
        let samples = lines.flat_map(|value| value.to_ne_bytes()).collect();
        let index = first / ROWS_OF_A_BLOCK as usize;
        compress(&of_blocks, index, samples).map_err(Fault::Encoding)
    })
}

/// Writes a picture of this size with the channels and attributes of another; `samples` are those
/// of some rows at a time.
pub(in crate::formats) fn write_like(
    file: &mut (impl Read + Write + Seek),
    like: &Header,
    size: Size,
    mut samples: impl FnMut(Range<u32>) -> Option<Vec<u8>>,
) -> Result<(), Fault> {
    let Size { width, height } = size;
    let header = header_of((width, height), Vec::new());
    let header = Header {
        channels: like.channels.clone(),
        own_attributes: LayerAttributes {
            layer_position: Vec2(0, 0),
            ..like.own_attributes.clone()
        },
        shared_attributes: like.shared_attributes.clone(),
        ..header
    };
    let of_blocks = header.clone();
    let mut rows = (0..height).step_by(ROWS_OF_A_BLOCK as usize);
    write(file, header, || {
        let first = rows.next().ok_or(Fault::Stopped)?;
        let rows = first..height.min(first + ROWS_OF_A_BLOCK);
        let samples = samples(rows).ok_or(Fault::Stopped)?;
        let index = (first / ROWS_OF_A_BLOCK) as usize;
        compress(&of_blocks, index, samples).map_err(Fault::Encoding)
    })
}

/// The header of a file with these channels, in the order of their names.
fn header_of((width, height): (u32, u32), channels: Vec<(&str, SampleType)>) -> Header {
    let channel = |(name, kind)| ChannelDescription::named(name, kind);
    let size = Vec2(width as usize, height as usize);
    let shared = ImageAttributes {
        chromaticities: Some(REC_709),
        ..ImageAttributes::with_size(size)
    };
    let channels: SmallVec<[ChannelDescription; 5]> = channels.into_iter().map(channel).collect();
    Header::new(Text::default(), size, channels)
        .with_encoding(
            Compression::ZIP16,
            BlockDescription::ScanLines,
            LineOrder::Increasing,
        )
        .with_shared_attributes(shared)
        .with_attributes(LayerAttributes::default())
}

/// The block with this index, whose samples are row by row, in each channel by channel.
fn compress(header: &Header, index: usize, samples: Vec<u8>) -> Result<Chunk, String> {
    let size = header.layer_size;
    let row = index * ROWS_OF_A_BLOCK as usize;
    let rows = (size.y() - row).min(ROWS_OF_A_BLOCK as usize);
    let block = UncompressedBlock {
        index: BlockIndex {
            layer: 0,
            pixel_position: Vec2(0, row),
            pixel_size: Vec2(size.x(), rows),
            level: Vec2(0, 0),
        },
        data: samples,
    };
    block
        .compress_to_chunk(std::slice::from_ref(header))
        .map_err(|error| error.to_string())
}

/// Writes a file with this header, whose blocks `next` gives from the top downward.
fn write(
    file: &mut (impl Read + Write + Seek),
    header: Header,
    mut next: impl FnMut() -> Result<Chunk, Fault>,
) -> Result<(), Fault> {
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
        .take(HEADER_BYTES)
        .read_to_end(&mut start)?;
    let unknown = || Fault::Encoding("the header has an unknown form".to_owned());
    header::sort_attributes(&mut start).ok_or_else(unknown)?;
    file.seek(SeekFrom::Start(0))?;
    file.write_all(&start)?;
    Ok(())
}

/// The nearest float.
fn float(value: f64) -> f32 {
    value as f32
}

/// The least float that is no smaller: a bound stays one.
fn float_above(value: f64) -> f32 {
    let nearest = float(value);
    if f64::from(nearest) < value {
        nearest.next_up()
    } else {
        nearest
    }
}

/// Keeps finite values below infinity, and counts where that was needed.
fn clip(value: f64, largest: f64, clipped: &mut u64) -> f64 {
    if value.is_finite() && value.abs() > largest {
        *clipped += 1;
        largest.copysign(value)
    } else {
        value
    }
}

fn attributes(facts: &Facts) -> LayerAttributes {
    let mut attributes = LayerAttributes {
        frames_per_second: facts.frames_per_second.and_then(frame_rate::nearest),
        world_to_camera: Some(world_to_camera(&facts.camera)),
        software_name: Some(Text::from(SOFTWARE)),
        ..LayerAttributes::default()
    };
    let mut custom = |name: &str, value| attributes.other.insert(Text::from(name), value);
    custom("frame", AttributeValue::I32(facts.frame));
    let digest = Text::from(&*facts.digest.to_hex());
    custom(DIGEST_ATTRIBUTE, AttributeValue::Text(digest));
    match facts.method {
        // The command line keeps the number far below this limit.
        Method::Tolerance(tolerance) => custom("tolerance", AttributeValue::F32(tolerance as f32)),
        Method::Samples(samples) => custom(
            "samples",
            AttributeValue::I32(i32::try_from(samples.get()).unwrap_or(i32::MAX)),
        ),
    };
    attributes
}

/// The matrix M of p_camera = p_world · M, row by row: points are rows, as everywhere in OpenEXR.
///
/// Its camera looks along +z with x to the right and y up, as ours does.
fn world_to_camera(camera: &Camera) -> [f32; 16] {
    let world_from_camera = camera.world_from_camera;
    // The rows of M are the images of the world's axes: those of a rotation's transpose, which
    // are the rows of the rotation.
    let [x, y, z] = [0, 1, 2].map(|row| world_from_camera.row(row));
    let translation = -(world_from_camera.transpose() * camera.position);
    let row = |v: DVec3, w: f32| [v.x as f32, v.y as f32, v.z as f32, w];
    let rows = [row(x, 0.0), row(y, 0.0), row(z, 0.0), row(translation, 1.0)];
    let mut matrix = [0.0; 16];
    matrix.copy_from_slice(rows.as_flattened());
    // A negative zero says nothing, and two ways to write 0 would be one too many.
    matrix.map(|number| number + 0.0)
}

#[cfg(test)]
mod tests;
