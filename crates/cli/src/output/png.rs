//! PNG: sRGB in 8 or 16 bit, grey where the picture is.

use std::io::{self, Write};

use marbles_core::{Channels, Image};
use png::{BitDepth, ColorType, Compression, Encoder, EncodingError, SrgbRenderingIntent};

use super::{Encoded, SOFTWARE, srgb};
use crate::memory::{self, Form};

/// Bytes of the samples' parts in a file.
const CHUNK_BYTES: usize = 1 << 18;

/// How a PNG file is written.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub(crate) struct PngOptions {
    /// 16 bit instead of 8.
    pub(crate) deep: bool,
    /// Three channels for pictures without color as well.
    pub(crate) rgb: bool,
}

impl PngOptions {
    /// The bytes of the file.
    pub(super) fn encode(self, image: &Image) -> Result<Encoded, String> {
        let grey = image.channels() == Channels::Grey && !self.rgb;
        let color_type = match (grey, image.has_alpha()) {
            (true, false) => ColorType::Grayscale,
            (true, true) => ColorType::GrayscaleAlpha,
            (false, false) => ColorType::Rgb,
            (false, true) => ColorType::Rgba,
        };
        let depth = if self.deep {
            BitDepth::Sixteen
        } else {
            BitDepth::Eight
        };
        let samples = self.samples(image, color_type)?;
        let sides = (image.width(), image.height());
        let bytes = file(sides, color_type, depth, &samples)?;
        Ok(Encoded { bytes, clipped: 0 })
    }

    /// Bytes that [`PngOptions::encode`] takes at most: the samples, and the file.
    pub(super) fn memory(self, form: &Form) -> u64 {
        let grey = form.channels == Channels::Grey && !self.rgb;
        let samples = if grey { 1 } else { 3 } + u64::from(form.alpha);
        let depth = if self.deep { 2 } else { 1 };
        let samples = form.pixels() * samples * depth;
        samples + file_bytes(samples, form.height)
    }

    /// The codes of all pixels, row by row, big end first.
    fn samples(self, image: &Image, color_type: ColorType) -> Result<Vec<u8>, String> {
        let depth = if self.deep { 2 } else { 1 };
        let pixels = image.width() as usize * image.height() as usize;
        let mut samples = memory::reserve(pixels * color_type.samples() * depth)?;
        let colors = match color_type {
            ColorType::Grayscale | ColorType::GrayscaleAlpha => 1,
            _ => 3,
        };
        let stored = match image.channels() {
            Channels::Grey => 1,
            Channels::Rgb => 3,
        };
        let is_plain = !self.deep && !image.has_alpha() && colors == stored;
        for row in 0..image.height() {
            if is_plain {
                srgb::encode_all_8(image.row(row), &mut samples);
                continue;
            }
            for col in 0..image.width() {
                let rgba = image.rgba(col, row);
                let alpha = rgba[3];
                for &value in &rgba[..colors] {
                    let value = straight(value, alpha);
                    self.push(&mut samples, srgb::encode_8, srgb::encode_16, value);
                }
                if image.has_alpha() {
                    self.push(&mut samples, linear_8, linear_16, alpha);
                }
            }
        }
        Ok(samples)
    }

    fn push(
        self,
        samples: &mut Vec<u8>,
        code_8: fn(f64) -> u8,
        code_16: fn(f64) -> u16,
        value: f64,
    ) {
        if self.deep {
            samples.extend(code_16(value).to_be_bytes());
        } else {
            samples.push(code_8(value));
        }
    }
}

/// The bytes of a file with these samples, not many more than they are.
fn file(
    sides: (u32, u32),
    color_type: ColorType,
    depth: BitDepth,
    samples: &[u8],
) -> Result<Vec<u8>, String> {
    let most = file_bytes(samples.len() as u64, sides.1);
    let mut bytes = memory::reserve(most as usize)?;
    let mut write = |compression| {
        bytes.clear();
        let mut encoder = Encoder::new(Bounded(&mut bytes), sides.0, sides.1);
        encoder.set_color(color_type);
        encoder.set_depth(depth);
        encoder.set_compression(compression);
        encoder.set_source_srgb(SrgbRenderingIntent::Perceptual);
        encoder.add_text_chunk("Software".to_owned(), SOFTWARE.to_owned())?;
        let mut writer = encoder.write_header()?;
        let mut stream = writer.stream_writer_with_size(CHUNK_BYTES)?;
        stream.write_all(samples)?;
        stream.finish()?;
        writer.finish()
    };
    // Noise grows when it is compressed in a hurry, until it has no room.
    write(Compression::Fast)
        .or_else(|_| write(Compression::NoCompression))
        .map_err(|error: EncodingError| error.to_string())?;
    Ok(bytes)
}

/// Bytes that a file with this many bytes of samples has at most.
fn file_bytes(samples: u64, height: u32) -> u64 {
    /// The parts before and behind the samples take less.
    const OTHER_PARTS: u64 = 1 << 12;
    // A byte before each row, and five before each block, which has thousands.
    let rows = samples + u64::from(height);
    rows + rows / 1000 + OTHER_PARTS
}

/// Writes into the room that a vector has, and never makes it larger.
struct Bounded<'bytes>(&'bytes mut Vec<u8>);

impl Write for Bounded<'_> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        if bytes.len() > self.0.capacity() - self.0.len() {
            return Err(io::ErrorKind::StorageFull.into());
        }
        self.0.extend_from_slice(bytes);
        Ok(bytes.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

/// The bytes of a grey picture in 8 bit, with these codes row by row.
pub(super) fn grey(width: u32, height: u32, codes: &[u8]) -> Result<Encoded, String> {
    let bytes = file(
        (width, height),
        ColorType::Grayscale,
        BitDepth::Eight,
        codes,
    )?;
    Ok(Encoded { bytes, clipped: 0 })
}

/// The bytes of a picture in 8 bit, with the codes of red, green and blue row by row.
pub(super) fn rgb(width: u32, height: u32, codes: &[u8]) -> Result<Encoded, String> {
    let bytes = file((width, height), ColorType::Rgb, BitDepth::Eight, codes)?;
    Ok(Encoded { bytes, clipped: 0 })
}

/// The light of the covered part of a pixel alone.
fn straight(premultiplied: f64, alpha: f64) -> f64 {
    if alpha > 0.0 {
        premultiplied / alpha
    } else {
        0.0
    }
}

/// The nearest code of a number from 0 to 1; the cast saturates.
fn linear_8(value: f64) -> u8 {
    (value * f64::from(u8::MAX) + 0.5) as u8
}

/// As [`linear_8`], in 16 bit.
fn linear_16(value: f64) -> u16 {
    (value * f64::from(u16::MAX) + 0.5) as u16
}

#[cfg(test)]
mod tests;
