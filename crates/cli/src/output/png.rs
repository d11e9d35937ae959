//! PNG: sRGB in 8 or 16 bit, grey where the picture is.

use marbles_core::{Channels, Image};
use png::{BitDepth, ColorType, Compression, Encoder, SrgbRenderingIntent};

use super::{Encoded, SOFTWARE, srgb};

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
        let samples = self.samples(image, color_type);
        file(
            image.width(),
            image.height(),
            color_type,
            self.deep,
            &samples,
        )
    }

    /// The codes of all pixels, row by row, big end first.
    fn samples(self, image: &Image, color_type: ColorType) -> Vec<u8> {
        let depth = if self.deep { 2 } else { 1 };
        let pixels = image.width() as usize * image.height() as usize;
        let mut samples = Vec::with_capacity(pixels * color_type.samples() * depth);
        let mut push = |code_8: fn(f64) -> u8, code_16: fn(f64) -> u16, value: f64| {
            if self.deep {
                samples.extend(code_16(value).to_be_bytes());
            } else {
                samples.push(code_8(value));
            }
        };
        let colors = match color_type {
            ColorType::Grayscale | ColorType::GrayscaleAlpha => 1,
            _ => 3,
        };
        for row in 0..image.height() {
            for col in 0..image.width() {
                let rgba = image.rgba(col, row);
                let alpha = rgba[3];
                for &value in &rgba[..colors] {
                    push(srgb::encode_8, srgb::encode_16, straight(value, alpha));
                }
                if image.has_alpha() {
                    push(linear_8, linear_16, alpha);
                }
            }
        }
        samples
    }
}

/// The bytes of a grey picture in 8 bit, with these codes row by row.
pub(super) fn grey(width: u32, height: u32, codes: &[u8]) -> Result<Encoded, String> {
    file(width, height, ColorType::Grayscale, false, codes)
}

/// The bytes of a file with these samples, of 16 bit where it is `deep`.
fn file(
    width: u32,
    height: u32,
    color_type: ColorType,
    deep: bool,
    samples: &[u8],
) -> Result<Encoded, String> {
    let mut bytes = Vec::new();
    let mut encoder = Encoder::new(&mut bytes, width, height);
    encoder.set_color(color_type);
    encoder.set_depth(if deep {
        BitDepth::Sixteen
    } else {
        BitDepth::Eight
    });
    encoder.set_compression(Compression::Fast);
    encoder.set_source_srgb(SrgbRenderingIntent::Perceptual);
    encoder
        .add_text_chunk("Software".to_owned(), SOFTWARE.to_owned())
        .and_then(|()| encoder.write_header())
        .and_then(|mut writer| {
            writer.write_image_data(samples)?;
            writer.finish()
        })
        .map_err(|error| error.to_string())?;
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
