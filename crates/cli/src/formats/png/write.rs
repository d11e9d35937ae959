//! PNG files, from samples.

use std::io::{BufReader, BufWriter, Cursor, Read, Seek, SeekFrom, Write};
use std::path::Path;

use blake3::Hash;
use exr::meta::attribute::Chromaticities;
use exr::prelude::Vec2;
use png::{
    BitDepth, ColorType, Compression, DecodingError, Encoder, EncodingError, ScaledFloat,
    SourceChromaticities, SrgbRenderingIntent,
};

use super::decoder::decoder;
use super::shape::Shape;
use crate::base::failure::Failure;
use crate::base::region::Region;
use crate::base::size::Size;
use crate::files::save::{Fault, save};
use crate::files::temporary::TemporaryFile;
use crate::formats::exr::header::REC_709;
use crate::formats::facts::SOFTWARE;

/// The keyword of the digest of the picture.
pub(super) const DIGEST_KEYWORD: &str = "Digest";
/// The keyword of the region, in a file with a part of a picture.
pub(super) const REGION_KEYWORD: &str = "Region";

/// The size of the parts into which the samples in a file are divided, in bytes.
pub(super) const CHUNK_BYTES: usize = 1 << 18;

/// A keyword, and its text.
pub(crate) type Text = (&'static str, String);

/// The texts of a file with a part of a picture with this digest, or with the whole picture.
pub(crate) fn texts(digest: &Hash, region: &Region) -> Vec<Text> {
    let mut texts = vec![(DIGEST_KEYWORD, digest.to_string())];
    if !region.is_all() {
        texts.push((REGION_KEYWORD, region.to_string()));
    }
    texts
}

/// Writes a gray PNG with 8-bit codes and some texts, completely or not at all; `row` appends those of the next row.
pub(crate) fn write_grey(
    size: Size,
    path: &Path,
    texts: &[Text],
    mut row: impl FnMut(&mut Vec<u8>) -> Result<(), Fault>,
) -> Result<(), Failure> {
    let shape = Shape::of_codes(size, ColorType::Grayscale, BitDepth::Eight);
    let codes = |stream: &mut dyn Write| {
        let mut codes = Vec::new();
        for _ in 0..size.height {
            codes.clear();
            row(&mut codes)?;
            stream.write_all(&codes)?;
        }
        Ok(())
    };
    Ok(save(path, |file| write(file, shape, texts, codes))?)
}

/// Writes a PNG with 16-bit codes of red, green and blue, row by row, completely or not at all; `codes` returns those
/// of a row.
pub(crate) fn write_rgb_16(
    size: Size,
    codes: impl Fn(u32) -> Vec<u16>,
    path: &Path,
) -> Result<(), Failure> {
    let shape = Shape::of_codes(size, ColorType::Rgb, BitDepth::Sixteen);
    let codes = |stream: &mut dyn Write| {
        for row in 0..size.height {
            let row = codes(row).into_iter().flat_map(u16::to_be_bytes);
            stream.write_all(&row.collect::<Vec<u8>>())?;
        }
        Ok(())
    };
    Ok(save(path, |file| write(file, shape, &[], codes))?)
}

/// The bytes of a PNG with 8-bit codes of red, green and blue, row by row.
pub(crate) fn rgb_bytes(size: Size, codes: &[u8]) -> Result<Vec<u8>, Failure> {
    let mut file = Cursor::new(Vec::new());
    let shape = Shape::of_codes(size, ColorType::Rgb, BitDepth::Eight);
    match compress(&mut file, shape, &[], |stream| Ok(stream.write_all(codes)?)) {
        Ok(_has_grown) => Ok(file.into_inner()),
        Err(_) => Err(Failure::Work("cannot encode the picture".to_owned())),
    }
}

/// Writes a file; `samples` writes its samples.
pub(crate) fn write(
    mut file: TemporaryFile,
    shape: Shape,
    texts: &[Text],
    samples: impl FnOnce(&mut dyn Write) -> Result<(), Fault>,
) -> Result<TemporaryFile, Fault> {
    let has_grown = compress(file.file(), shape, texts, samples)?;
    if !has_grown {
        return Ok(file);
    }
    let mut stored = file.another()?;
    store(file.file(), stored.file(), shape, texts)?;
    Ok(stored)
}

/// Writes a file; `samples` writes its samples. Returns whether the file has become larger than the samples, so that it
/// is better to store them.
///
/// Fast compression makes noise larger.
pub(crate) fn compress(
    file: &mut (impl Write + Seek),
    shape: Shape,
    texts: &[Text],
    samples: impl FnOnce(&mut dyn Write) -> Result<(), Fault>,
) -> Result<bool, Fault> {
    let length = write_with(file, shape, texts, Compression::Fast, samples)?;
    Ok(length > shape.file_bytes())
}

/// Writes a file with the stored samples of another file.
fn store(
    from: &mut (impl Read + Seek),
    to: &mut (impl Write + Seek),
    shape: Shape,
    texts: &[Text],
) -> Result<(), Fault> {
    from.seek(SeekFrom::Start(0))?;
    let mut reader = decoder(Box::new(BufReader::with_capacity(CHUNK_BYTES, from))).read_info()?;
    write_with(to, shape, texts, Compression::NoCompression, |stream| {
        while let Some(row) = reader.next_row()? {
            stream.write_all(row.data())?;
        }
        Ok(())
    })?;
    Ok(())
}

/// Writes a file and returns how long it is.
fn write_with(
    file: &mut (impl Write + Seek),
    shape: Shape,
    texts: &[Text],
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

/// The start that all files have in common.
pub(super) fn encoder<W: Write>(
    file: W,
    shape: Shape,
    compression: Compression,
) -> Result<Encoder<'static, W>, Fault> {
    let mut encoder = Encoder::new(file, shape.size.width, shape.size.height);
    encoder.set_color(shape.color_type);
    encoder.set_depth(shape.depth);
    encoder.set_compression(compression);
    if shape.is_linear {
        encoder.set_source_gamma(ScaledFloat::new(1.0));
        let Chromaticities {
            red,
            green,
            blue,
            white,
        } = REC_709;
        let [white, red, green, blue] = [white, red, green, blue].map(|Vec2(x, y)| (x, y));
        encoder.set_source_chromaticities(SourceChromaticities::new(white, red, green, blue));
    } else {
        encoder.set_source_srgb(SrgbRenderingIntent::Perceptual);
    }
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

impl From<DecodingError> for Fault {
    fn from(error: DecodingError) -> Self {
        match error {
            DecodingError::IoError(error) => Self::Io(error),
            other => Self::Encoding(other.to_string()),
        }
    }
}

#[cfg(test)]
mod tests;
