//! The blocks of an EXR file: linear light, in half or single precision.

use std::iter;
use std::ops::Range;

use exr::block::chunk::Chunk;
use exr::block::{BlockIndex, UncompressedBlock};
use exr::meta::attribute::SampleType;
use exr::meta::header::Header;
use exr::prelude::{AttributeValue, IntegerBounds, Text, Vec2};
use marbles_core::{Channels, Image};

use super::channels::error_channel;
use super::header::header_of;
use crate::base::region::Region;
use crate::formats::center_channels::{
    CenterChannel, CenterChannels, CenterValues, Source, name_of,
};
use crate::formats::encoding::ExrOptions;
use crate::formats::form::Form;
use crate::formats::half;

/// The number of rows that are compressed together.
pub(crate) const ROWS_OF_A_BLOCK: u32 = 16;

/// The layout of blocks, which contain the light and the errors of a picture.
#[derive(Clone, Debug)]
pub(crate) struct Blocks {
    options: ExrOptions,
    channels: Vec<Channel>,
    /// The number of layers; the picture is the first one.
    layers: usize,
    /// The header without metadata about the picture, which does not affect the blocks.
    pub(super) header: Header,
}

/// A channel of a file.
#[derive(Clone, Debug)]
struct Channel {
    name: String,
    content: Content,
    /// The number of the layer whose image contains its numbers; 0 is the picture. Center values are added separately.
    layer: usize,
    /// Bytes per sample.
    bytes: usize,
}

/// The contents of a channel.
#[derive(Clone, Copy, Debug)]
enum Content {
    /// Red, green, blue or alpha.
    Light(usize),
    Error,
    /// Geometry at the centers of pixels.
    Center(Source),
}

impl Channel {
    fn sample_type(&self) -> SampleType {
        match self.content {
            Content::Center(source) if source.is_index() => SampleType::U32,
            _ if self.bytes == 2 => SampleType::F16,
            _ => SampleType::F32,
        }
    }
}

impl Blocks {
    /// The blocks of a picture of this form, with additional layers, which share its alpha.
    pub(crate) fn new(form: &Form, options: ExrOptions, layers: &[String]) -> Self {
        let mut channels = Vec::new();
        let names = layers.iter().map(String::as_str);
        for (layer, layer_name) in iter::once("").chain(names).enumerate() {
            let light = [(0, "R"), (1, "G"), (2, "B"), (3, "A")].into_iter();
            let light = light.take(if form.alpha && layer == 0 { 4 } else { 3 });
            channels.extend(light.map(|(number, name)| Channel {
                name: match layer_name {
                    "" => name.to_owned(),
                    layer => format!("{layer}.{name}"),
                },
                content: Content::Light(number),
                layer,
                bytes: if options.float { 4 } else { 2 },
            }));
            if options.error {
                channels.push(Channel {
                    name: error_channel(layer_name),
                    content: Content::Error,
                    layer,
                    // Errors are floats in any case: the least half above 0 is 6e-8, which many are below.
                    bytes: 4,
                });
            }
        }
        let centers = form.centers.iter().flat_map(CenterChannels::list);
        channels.extend(centers.map(|(name, source)| Channel {
            name: name.to_owned(),
            content: Content::Center(source),
            layer: 0,
            bytes: 4,
        }));
        channels.sort_unstable_by(|one, other| one.name.cmp(&other.name));
        let names = channels.iter();
        let names = names.map(|channel| (&*channel.name, channel.sample_type()));
        let Region { window, whole } = form.region;
        let mut header = header_of(form.region.size(), names.collect());
        let position = Vec2(window.col as i32, window.row as i32);
        header.own_attributes.layer_position = position;
        let display = (whole.width as usize, whole.height as usize);
        header.shared_attributes.display_window = IntegerBounds::from_dimensions(display);
        for (name, value) in form.centers.iter().flat_map(conventions) {
            let value = AttributeValue::Text(Text::from(&*value));
            let others = &mut header.own_attributes.other;
            others.insert(Text::from(name), value);
        }
        Self {
            options,
            channels,
            layers: 1 + layers.len(),
            header,
        }
    }

    /// The number of layers; the picture is the first one.
    pub(crate) fn layers(&self) -> usize {
        self.layers
    }

    /// Bytes of a row's samples.
    pub(crate) fn row_bytes(&self) -> usize {
        let pixel: usize = self.channels.iter().map(|channel| channel.bytes).sum();
        self.header.layer_size.x() * pixel
    }

    /// Copies the numbers of rows of a layer's image to their positions in `samples`, which cover the same rows,
    /// starting at the column `col`. Returns how many were too large.
    pub(crate) fn encode(
        &self,
        layer: usize,
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
            // Where the first color of a gray picture is, and how many numbers of it were too large.
            let mut grey = None;
            for channel in &self.channels {
                let start = end + col as usize * channel.bytes;
                let own = start..start + image.width() as usize * channel.bytes;
                end += columns * channel.bytes;
                if channel.layer != layer {
                    continue;
                }
                clipped += match channel.content {
                    Content::Center(_) => 0,
                    Content::Error => {
                        let (floats, _) = samples[own].as_chunks_mut();
                        for (float, col) in floats.iter_mut().zip(0..) {
                            *float = float_above(image.error(col, row)).to_ne_bytes();
                        }
                        0
                    }
                    Content::Light(light) => match &grey {
                        Some((first, clipped)) if light < 3 => {
                            samples.copy_within(Range::clone(first), start);
                            *clipped
                        }
                        _ => {
                            let values = (0..image.width()).map(|col| image.rgba(col, row)[light]);
                            let samples = &mut samples[own.clone()];
                            let clipped = encode_light(samples, self.options.float, values);
                            if is_grey && light < 3 {
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

    /// Copies the center values of rows of pixels to their positions, like [`Self::encode`] for light.
    pub(crate) fn encode_geometry(
        &self,
        samples: &mut [u8],
        col: u32,
        geometry: &impl CenterValues,
    ) {
        let (width, height) = geometry.size();
        let columns = self.header.layer_size.x();
        let rows = samples.chunks_exact_mut(self.row_bytes());
        for (samples, row) in rows.zip(0..height) {
            let mut end = 0;
            for channel in &self.channels {
                let start = end + col as usize * channel.bytes;
                end += columns * channel.bytes;
                if let Content::Center(source) = channel.content {
                    let own = start..start + width as usize * channel.bytes;
                    let (samples, _) = samples[own].as_chunks_mut();
                    encode_center(samples, source, geometry, row);
                }
            }
        }
    }

    /// The compressed block with this index, counted from the top.
    pub(crate) fn compress(&self, index: u32, samples: Vec<u8>) -> Result<Chunk, String> {
        compress(&self.header, index as usize, samples)
    }
}

/// Copies numbers to the samples of a channel of light, as floats or halves. Returns how many were too large.
fn encode_light(samples: &mut [u8], is_float: bool, light: impl Iterator<Item = f64>) -> u64 {
    let mut clipped = 0;
    if is_float {
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

/// Copies a center value of each pixel of a row to the samples of a channel.
fn encode_center(samples: &mut [[u8; 4]], source: Source, geometry: &impl CenterValues, row: u32) {
    let mut samples = samples.iter_mut();
    let mut put = |bytes| {
        if let Some(sample) = samples.next() {
            *sample = bytes;
        }
    };
    if source.is_index() {
        geometry.each_index(source, row, |id| put(id.to_ne_bytes()));
    } else {
        geometry.each_number(source, row, |value| put(float(value).to_ne_bytes()));
    }
}

/// The attributes that describe the meaning of center values.
fn conventions(centers: &CenterChannels) -> Vec<(&'static str, String)> {
    let mut conventions = Vec::new();
    if centers.has(CenterChannel::Depth) {
        conventions.push(("depth", name_of(&centers.depth)));
    }
    let turned = [
        CenterChannel::Normal,
        CenterChannel::Position,
        CenterChannel::MeanNormal,
    ];
    if turned.into_iter().any(|group| centers.has(group)) {
        conventions.push(("axes", name_of(&centers.axes)));
    }
    conventions
}

/// The block with this index. Its samples are ordered by rows, and within a row by channels.
pub(super) fn compress(header: &Header, index: usize, samples: Vec<u8>) -> Result<Chunk, String> {
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

/// The nearest float.
fn float(value: f64) -> f32 {
    value as f32
}

/// The smallest float that is not below the number, so that a bound remains a bound.
fn float_above(value: f64) -> f32 {
    let nearest = float(value);
    if f64::from(nearest) < value {
        nearest.next_up()
    } else {
        nearest
    }
}

/// Limits finite values to finite floats, and counts the limited ones.
fn clip(value: f64, largest: f64, clipped: &mut u64) -> f64 {
    if value.is_finite() && value.abs() > largest {
        *clipped += 1;
        largest.copysign(value)
    } else {
        value
    }
}

#[cfg(test)]
mod tests;
