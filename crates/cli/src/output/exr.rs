//! OpenEXR: linear light, and what is known of the camera that saw it.

use std::io::Cursor;

use exr::meta::attribute::Chromaticities;
use exr::prelude::{
    AnyChannel, AnyChannels, AttributeValue, Blocks, Compression, Encoding, FlatSamples,
    Image as ExrImage, Layer, LayerAttributes, LineOrder, SmallVec, Text, Vec2, WritableImage, f16,
};
use glam::DVec3;
use marbles_core::{Camera, Image, Method};

use super::{Encoded, Facts, SOFTWARE, half, header};
use crate::memory::{self, Form};
use crate::rational;

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
const ROWS_OF_A_BLOCK: u64 = 16;
/// What a file has besides its blocks, generously.
const HEADER_BYTES: u64 = 1 << 16;

impl ExrOptions {
    /// Bytes that [`ExrOptions::encode`] takes at most: the samples, as many for the file, and
    /// some copies of a block while it is compressed.
    pub(super) fn memory(self, form: &Form) -> u64 {
        const COPIES_OF_A_BLOCK: u64 = 8;
        let samples = form.pixels() * self.bytes_per_pixel(form.alpha);
        let row = u64::from(form.width) * self.bytes_per_pixel(form.alpha);
        let file = self.file_bytes(form.width, form.height, form.alpha);
        samples + file + COPIES_OF_A_BLOCK * ROWS_OF_A_BLOCK * row
    }

    /// Bytes that a file has at most: blocks that compression would make larger are stored as
    /// they are.
    fn file_bytes(self, width: u32, height: u32, alpha: bool) -> u64 {
        // Its place in the file, its first row and its size.
        const BYTES_OF_A_BLOCK: u64 = 8 + 4 + 4;
        let blocks = u64::from(height).div_ceil(ROWS_OF_A_BLOCK);
        let samples = u64::from(width) * u64::from(height) * self.bytes_per_pixel(alpha);
        samples + blocks * BYTES_OF_A_BLOCK + HEADER_BYTES
    }

    fn bytes_per_pixel(self, alpha: bool) -> u64 {
        let light = (3 + u64::from(alpha)) * if self.float { 4 } else { 2 };
        // Errors are floats in any case: the least half above 0 is 6e-8, which many are below.
        light + if self.error { 4 } else { 0 }
    }

    /// The bytes of the file, the same for the same picture and facts.
    pub(super) fn encode(self, image: &Image, facts: &Facts) -> Result<Encoded, String> {
        let (width, height) = (image.width() as usize, image.height() as usize);
        let mut clipped = 0;
        let mut channels = SmallVec::new();
        for (index, name) in ["R", "G", "B", "A"].into_iter().enumerate() {
            if name == "A" && !image.has_alpha() {
                continue;
            }
            let values = pixels(image).map(|(col, row)| image.rgba(col, row)[index]);
            let samples = if self.float {
                let mut samples: Vec<f32> = memory::reserve(width * height)?;
                let largest = f32::MAX.into();
                samples.extend(values.map(|value| float(clip(value, largest, &mut clipped))));
                FlatSamples::F32(samples)
            } else {
                let mut samples: Vec<f16> = memory::reserve(width * height)?;
                let largest = half::LARGEST;
                samples
                    .extend(values.map(|value| half::nearest(clip(value, largest, &mut clipped))));
                FlatSamples::F16(samples)
            };
            channels.push(AnyChannel::new(name, samples));
        }
        if self.error {
            let mut samples: Vec<f32> = memory::reserve(width * height)?;
            samples.extend(pixels(image).map(|(col, row)| float_above(image.error(col, row))));
            channels.push(AnyChannel::new(ERROR_CHANNEL, FlatSamples::F32(samples)));
        }
        let most = self.file_bytes(image.width(), image.height(), image.has_alpha());
        let bytes = file((width, height), channels, attributes(facts), most)?;
        Ok(Encoded { bytes, clipped })
    }
}

/// The bytes of a picture in single precision, of channels with these names.
pub(super) fn floats(
    size: (usize, usize),
    channels: Vec<(&str, Vec<f32>)>,
) -> Result<Encoded, String> {
    let channel = |(name, values)| AnyChannel::new(name, FlatSamples::F32(values));
    let channels = channels.into_iter().map(channel).collect();
    let attributes = LayerAttributes {
        software_name: Some(Text::from(SOFTWARE)),
        ..LayerAttributes::default()
    };
    // Room to start with: the vector grows where the channels are more.
    let most = (size.0 * size.1) as u64 * 16;
    let bytes = file(size, channels, attributes, most)?;
    Ok(Encoded { bytes, clipped: 0 })
}

/// The bytes of a file with these channels, in any order.
fn file(
    size: (usize, usize),
    channels: SmallVec<[AnyChannel<FlatSamples>; 4]>,
    attributes: LayerAttributes,
    most_bytes: u64,
) -> Result<Vec<u8>, String> {
    let encoding = Encoding {
        compression: Compression::ZIP16,
        blocks: Blocks::ScanLines,
        line_order: LineOrder::Increasing,
    };
    let channels = AnyChannels::sort(channels);
    let layer = Layer::new(size, attributes, encoding, channels);
    let mut file = ExrImage::from_layer(layer);
    file.attributes.chromaticities = Some(REC_709);

    let mut bytes = Cursor::new(memory::reserve(most_bytes as usize)?);
    file.write()
        .non_parallel()
        .to_buffered(&mut bytes)
        .map_err(|error| error.to_string())?;
    let mut bytes = bytes.into_inner();
    header::sort_attributes(&mut bytes).ok_or("the header has an unknown form")?;
    Ok(bytes)
}

fn pixels(image: &Image) -> impl Iterator<Item = (u32, u32)> {
    let width = image.width();
    (0..image.height()).flat_map(move |row| (0..width).map(move |col| (col, row)))
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
        frames_per_second: facts.frames_per_second.and_then(rational::nearest),
        world_to_camera: Some(world_to_camera(&facts.camera)),
        software_name: Some(Text::from(SOFTWARE)),
        ..LayerAttributes::default()
    };
    let mut custom = |name: &str, value| attributes.other.insert(Text::from(name), value);
    custom("frame", AttributeValue::I32(facts.frame));
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
