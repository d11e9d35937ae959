//! PNG: sRGB in 8 or 16 bit, grey where the picture is.

use std::io::{BufReader, BufWriter, Read, Seek, SeekFrom, Write};
use std::ops::Range;

use marbles_core::{Channels, Image};
use png::{
    BitDepth, ColorType, Compression, Decoder, Encoder, EncodingError, Info, Limits,
    SrgbRenderingIntent,
};

use crate::base::memory::Form;
use crate::commands::args::Size;
use crate::formats::{Fault, SOFTWARE, srgb};

/// Bytes of the samples' parts in a file.
pub(in crate::formats) const CHUNK_BYTES: usize = 1 << 18;

/// How a PNG file is written.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub(crate) struct PngOptions {
    /// 16 bit instead of 8.
    pub(crate) deep: bool,
    /// Three channels for pictures without color as well.
    pub(crate) rgb: bool,
}

/// What the samples of a file are.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub(in crate::formats) struct Shape {
    pub(in crate::formats) width: u32,
    pub(in crate::formats) height: u32,
    color_type: ColorType,
    depth: BitDepth,
}

impl PngOptions {
    /// What the file of such a picture holds.
    pub(in crate::formats) fn shape(self, form: &Form) -> Shape {
        let grey = form.channels == Channels::Grey && !self.rgb;
        Shape {
            width: form.width,
            height: form.height,
            color_type: match (grey, form.alpha) {
                (true, false) => ColorType::Grayscale,
                (true, true) => ColorType::GrayscaleAlpha,
                (false, false) => ColorType::Rgb,
                (false, true) => ColorType::Rgba,
            },
            depth: if self.deep {
                BitDepth::Sixteen
            } else {
                BitDepth::Eight
            },
        }
    }
}

impl Shape {
    /// A picture in 8 bit, grey or with red, green and blue.
    pub(in crate::formats) fn of_codes(width: u32, height: u32, grey: bool) -> Self {
        Self {
            width,
            height,
            color_type: if grey {
                ColorType::Grayscale
            } else {
                ColorType::Rgb
            },
            depth: BitDepth::Eight,
        }
    }

    /// Of a picture of this size, of the kind of another.
    pub(in crate::formats) fn like(info: &Info<'_>, size: Size) -> Self {
        Self {
            width: size.width,
            height: size.height,
            color_type: info.color_type,
            depth: info.bit_depth,
        }
    }

    /// Bytes of a sample.
    fn depth(self) -> usize {
        if self.depth == BitDepth::Sixteen {
            2
        } else {
            1
        }
    }

    /// Bytes of a row's samples.
    pub(in crate::formats) fn row_bytes(self) -> usize {
        self.width as usize * self.color_type.samples() * self.depth()
    }

    /// Bytes that a file has at most.
    fn file_bytes(self) -> u64 {
        /// The parts before and behind the samples take less.
        const OTHER_PARTS: u64 = 1 << 12;
        // A byte before each row, and five before each block, which has thousands.
        let rows = (self.row_bytes() as u64 + 1) * u64::from(self.height);
        rows + rows / 1000 + OTHER_PARTS
    }

    /// Puts the codes of some rows of an image, big end first, where they belong in `samples`, which
    /// are as many rows, from the column `col` on.
    pub(in crate::formats) fn encode(
        self,
        samples: &mut [u8],
        col: u32,
        image: &Image,
        rows: Range<u32>,
    ) {
        let colors = match self.color_type {
            ColorType::Grayscale | ColorType::GrayscaleAlpha => 1,
            _ => 3,
        };
        let stored = match image.channels() {
            Channels::Grey => 1,
            Channels::Rgb => 3,
        };
        let is_plain = self.depth() == 1 && !image.has_alpha() && colors == stored;
        let pixel_bytes = self.color_type.samples() * self.depth();
        let first = col as usize * pixel_bytes;
        let length = image.width() as usize * pixel_bytes;
        for (samples, row) in samples.chunks_exact_mut(self.row_bytes()).zip(rows) {
            let samples = &mut samples[first..first + length];
            if is_plain {
                srgb::encode_all_8(image.row(row), samples);
                continue;
            }
            for (samples, col) in samples.chunks_exact_mut(pixel_bytes).zip(0..) {
                let rgba = image.rgba(col, row);
                let alpha = rgba[3];
                let mut samples = samples.chunks_exact_mut(self.depth());
                for (&value, sample) in rgba[..colors].iter().zip(&mut samples) {
                    let value = straight(value, alpha);
                    put(sample, srgb::encode_8, srgb::encode_16, value);
                }
                // The alpha channel, where there is one.
                if let Some(sample) = samples.next() {
                    put(sample, linear_8, linear_16, alpha);
                }
            }
        }
    }
}

/// Puts the code of a value where a sample of one byte or two is.
fn put(sample: &mut [u8], code_8: fn(f64) -> u8, code_16: fn(f64) -> u16, value: f64) {
    match sample {
        [byte] => *byte = code_8(value),
        pair => pair.copy_from_slice(&code_16(value).to_be_bytes()),
    }
}

/// Writes a file, the samples as `samples` writes them; whether it has become larger than they are,
/// and is to be stored by [`store`].
///
/// Noise grows when it is compressed in a hurry.
pub(in crate::formats) fn write(
    file: &mut (impl Write + Seek),
    shape: Shape,
    texts: &[(&str, String)],
    samples: impl FnOnce(&mut dyn Write) -> Result<(), Fault>,
) -> Result<bool, Fault> {
    let length = write_compressed(file, shape, texts, Compression::Fast, samples)?;
    Ok(length > shape.file_bytes())
}

/// Writes a file with the samples of another one as they are.
pub(in crate::formats) fn store(
    from: &mut (impl Read + Seek),
    to: &mut (impl Write + Seek),
    shape: Shape,
    texts: &[(&str, String)],
) -> Result<(), Fault> {
    // What was written here is no danger to the memory.
    let limits = Limits { bytes: usize::MAX };
    from.seek(SeekFrom::Start(0))?;
    let decoder = Decoder::new_with_limits(BufReader::with_capacity(CHUNK_BYTES, from), limits);
    let mut reader = decoder.read_info()?;
    write_compressed(to, shape, texts, Compression::NoCompression, |stream| {
        while let Some(row) = reader.next_row()? {
            stream.write_all(row.data())?;
        }
        Ok(())
    })?;
    Ok(())
}

/// Writes a file; how long it is.
fn write_compressed(
    file: &mut (impl Write + Seek),
    shape: Shape,
    texts: &[(&str, String)],
    compression: Compression,
    samples: impl FnOnce(&mut dyn Write) -> Result<(), Fault>,
) -> Result<u64, Fault> {
    let mut file = BufWriter::with_capacity(CHUNK_BYTES, file);
    let mut encoder = encoder(&mut file, shape, compression)?;
    for (keyword, text) in texts {
        encoder.add_text_chunk((*keyword).to_owned(), text.clone())?;
    }
    let mut writer = encoder.write_header()?;
    let mut stream = writer.stream_writer_with_size(CHUNK_BYTES)?;
    samples(&mut stream)?;
    stream.finish()?;
    writer.finish()?;
    file.flush()?;
    Ok(file.stream_position()?)
}

/// What all files begin with.
pub(in crate::formats) fn encoder<W: Write>(
    file: W,
    shape: Shape,
    compression: Compression,
) -> Result<Encoder<'static, W>, Fault> {
    let mut encoder = Encoder::new(file, shape.width, shape.height);
    encoder.set_color(shape.color_type);
    encoder.set_depth(shape.depth);
    encoder.set_compression(compression);
    encoder.set_source_srgb(SrgbRenderingIntent::Perceptual);
    encoder.add_text_chunk("Software".to_owned(), SOFTWARE.to_owned())?;
    Ok(encoder)
}

impl From<EncodingError> for Fault {
    fn from(error: EncodingError) -> Self {
        match error {
            EncodingError::IoError(error) => Self::Io(error),
            other => Self::Encoding(other.to_string()),
        }
    }
}

impl From<png::DecodingError> for Fault {
    fn from(error: png::DecodingError) -> Self {
        match error {
            png::DecodingError::IoError(error) => Self::Io(error),
            other => Self::Encoding(other.to_string()),
        }
    }
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
