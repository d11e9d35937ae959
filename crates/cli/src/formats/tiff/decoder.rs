//! The decoder of TIFF files, and the properties of their pictures.

use std::io::SeekFrom;

use image::metadata::Orientation;
use tiff::ColorType;
use tiff::decoder::{ChunkType, Decoder, Limits};
use tiff::tags::{
    CompressionMethod, ExtraSamples, PlanarConfiguration, Predictor, SampleFormat, Tag,
};

use super::directory;
use crate::base::failure::lower;
use crate::base::size::Size;
use crate::formats::guard::guarded;
use crate::formats::picture::{is_turned, size_of};
use crate::formats::source::Input;

/// The usual order of bits.
const HIGH_BITS_FIRST: u16 = 1;
/// The largest number of bytes of the samples that are decoded together: a strip, or a row of tiles.
const MOST_BYTES: u64 = 1 << 26;

/// A file after its directory is read.
pub(super) struct Opened {
    pub(super) decoder: Decoder<Box<dyn Input>>,
    pub(super) size: Size,
    /// The number of channels of color, 1 or 3.
    pub(super) colors: usize,
    pub(super) alpha: Alpha,
    /// The number of samples per pixel. Some may have an unknown meaning.
    pub(super) samples: usize,
    /// The number of those that the decoder returns.
    pub(super) decoded: usize,
    pub(super) bits: u8,
    pub(super) float: bool,
    /// Whether viewers turn or mirror the picture.
    pub(super) is_turned: bool,
    /// The number of chunks side by side, and the size of a complete chunk.
    pub(super) across: u32,
    pub(super) chunk: (u32, u32),
    /// The end of the directory in the file.
    pub(super) directory_end: u64,
}

/// The meaning of the channel after the colors.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub(super) enum Alpha {
    None,
    /// The colors are multiplied by it.
    Associated,
    /// The colors are not multiplied by it.
    Unassociated,
}

/// Reads the directory of the first picture in a file, and refuses unsupported kinds of pictures.
pub(super) fn open(mut file: Box<dyn Input>) -> Result<Opened, String> {
    let directory_end = directory::check(&mut file)?;
    let end = file.seek(SeekFrom::End(0));
    let end = end.and_then(|end| file.rewind().map(|()| end));
    let end = end.map_err(|error| error.to_string())?;
    guarded(|| {
        let decoder = Decoder::new(file).map_err(|error| lower(&error.to_string()))?;
        let mut limits = Limits::default();
        limits.decoding_buffer_size = MOST_BYTES as usize;
        limits.intermediate_buffer_size = 2 * MOST_BYTES as usize;
        examine(decoder.with_limits(limits), directory_end, end)
    })
}

fn examine(
    mut decoder: Decoder<Box<dyn Input>>,
    directory_end: u64,
    end: u64,
) -> Result<Opened, String> {
    let words = |error: tiff::TiffError| lower(&error.to_string());
    let (width, height) = decoder.dimensions().map_err(words)?;
    let size = size_of(width as usize, height as usize)?;
    let number = |decoder: &mut Decoder<Box<dyn Input>>, tag, usual| {
        let found = decoder.find_tag_unsigned::<u16>(tag).map_err(words);
        found.map(|found| found.unwrap_or(usual))
    };
    let compression = number(
        &mut decoder,
        Tag::Compression,
        CompressionMethod::None.to_u16(),
    )?;
    let compression = CompressionMethod::from_u16_exhaustive(compression);
    if !matches!(
        compression,
        CompressionMethod::None
            | CompressionMethod::LZW
            | CompressionMethod::Deflate
            | CompressionMethod::OldDeflate
            | CompressionMethod::PackBits
    ) {
        return Err(format!(
            "its compression is {compression:?}, expected none, LZW, Deflate or PackBits"
        ));
    }
    let predictor = number(&mut decoder, Tag::Predictor, Predictor::None.to_u16())?;
    let is_predicted = predictor != Predictor::None.to_u16();
    // Some programs ignore the predictor of such files, and others do not.
    if is_predicted
        && matches!(
            compression,
            CompressionMethod::None | CompressionMethod::PackBits
        )
    {
        return Err(format!(
            "it has the predictor {predictor} with the compression {compression:?}, expected LZW or Deflate"
        ));
    }
    let bit_order = number(&mut decoder, Tag::FillOrder, HIGH_BITS_FIRST)?;
    if bit_order != HIGH_BITS_FIRST {
        return Err(format!(
            "its bits are stored in the order {bit_order} (FillOrder), expected {HIGH_BITS_FIRST}"
        ));
    }
    let planes = number(&mut decoder, Tag::PlanarConfiguration, 1)?;
    let samples = usize::from(number(&mut decoder, Tag::SamplesPerPixel, 1)?);
    if planes != PlanarConfiguration::Chunky.to_u16() && samples > 1 {
        return Err(
            "its channels are stored in separate planes, expected pixel by pixel".to_owned(),
        );
    }
    let orientation = number(&mut decoder, Tag::Orientation, 1).ok();
    let orientation =
        orientation.and_then(|number| Orientation::from_exif(number.try_into().ok()?));
    let extra: Option<Vec<u16>> = decoder
        .find_tag_unsigned_vec(Tag::ExtraSamples)
        .map_err(words)?;
    let extra = extra.unwrap_or_default();
    let color_type = decoder.colortype().map_err(words)?;
    let bits = color_type.bit_depth();
    let colors = match color_type {
        ColorType::Gray(_) => 1,
        ColorType::Multiband { .. } if samples == 1 + extra.len() => 1,
        ColorType::RGB(_) | ColorType::RGBA(_) => 3,
        other => return Err(format!("its colors are {other:?}, expected gray or RGB")),
    };
    // Of colors, the decoder returns only those samples of a pixel whose meaning it knows.
    let decoded = usize::from(color_type.num_samples());
    if decoded != samples && is_predicted {
        return Err(format!(
            "it has the predictor {predictor} and {samples} channels, but marbles knows the meaning of only {decoded}"
        ));
    }
    let is_alpha = |kind: &u16| {
        use ExtraSamples::{AssociatedAlpha, UnassociatedAlpha};
        let kind = ExtraSamples::from_u16(*kind);
        matches!(kind, Some(AssociatedAlpha | UnassociatedAlpha))
    };
    if extra
        .iter()
        .position(is_alpha)
        .is_some_and(|place| place > 0)
    {
        return Err(
            "its alpha follows another channel, expected alpha right after the colors".to_owned(),
        );
    }
    let alpha = match extra.first().copied().and_then(ExtraSamples::from_u16) {
        Some(ExtraSamples::AssociatedAlpha) => Alpha::Associated,
        Some(ExtraSamples::UnassociatedAlpha) => Alpha::Unassociated,
        // The file declares all four channels as colors.
        None if matches!(color_type, ColorType::RGBA(_)) => Alpha::Unassociated,
        _ => Alpha::None,
    };
    let formats: Option<Vec<u16>> = decoder
        .find_tag_unsigned_vec(Tag::SampleFormat)
        .map_err(words)?;
    let format = formats.and_then(|formats| formats.first().copied());
    let format = SampleFormat::from_u16_exhaustive(format.unwrap_or(1));
    let float = format == SampleFormat::IEEEFP;
    let kinds: &[u8] = match format {
        SampleFormat::IEEEFP => &[16, 32, 64],
        SampleFormat::Uint => &[8, 16, 32],
        other => return Err(format!("its numbers are {other:?}, expected Uint or float")),
    };
    if !kinds.contains(&bits) {
        return Err(format!(
            "its numbers have {bits} bits, expected one of {kinds:?}"
        ));
    }
    let (tag, across) = match decoder.get_chunk_type() {
        ChunkType::Strip => (Tag::StripByteCounts, 1),
        ChunkType::Tile => (
            Tag::TileByteCounts,
            width.div_ceil(decoder.chunk_dimensions().0),
        ),
    };
    let chunk = decoder.chunk_dimensions();
    if chunk.0 == 0 || chunk.1 == 0 {
        return Err("its strips or tiles have no pixels".to_owned());
    }
    let lengths: Option<Vec<u64>> = decoder.find_tag_unsigned_vec(tag).map_err(words)?;
    let lengths = lengths.unwrap_or_default();
    let down = height.div_ceil(chunk.1);
    if (lengths.len() as u64) < u64::from(across) * u64::from(down) {
        return Err("it has too few strips or tiles for its size".to_owned());
    }
    // If parts could share their bytes, a short file could contain a picture of any size.
    let length = lengths
        .iter()
        .fold(0_u64, |sum, &next| sum.saturating_add(next));
    if length > end {
        return Err("its strips or tiles are longer than the file".to_owned());
    }
    let rows = u64::from(chunk.1.min(height));
    let columns = u64::from(across) * u64::from(chunk.0);
    let bytes = columns * rows * samples as u64 * u64::from(bits / 8);
    if bytes > MOST_BYTES {
        return Err(format!(
            "a strip or row of tiles takes {bytes} bytes, expected at most {MOST_BYTES}"
        ));
    }
    Ok(Opened {
        decoder,
        size,
        colors,
        alpha,
        samples,
        decoded,
        bits,
        float,
        is_turned: orientation.is_some_and(is_turned),
        across,
        chunk,
        directory_end,
    })
}
