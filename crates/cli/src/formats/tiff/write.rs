//! Writes TIFF files from compressed strips.
//!
//! Source: "TIFF, Revision 6.0", Adobe, 1992. A file that may exceed 4 GiB is a BigTIFF.

use std::io::{self, BufWriter, Seek, Write};

use tiff::encoder::{TiffEncoder, TiffKind, TiffKindBig, TiffKindStandard};
use tiff::tags::{
    CompressionMethod, ExtraSamples, PhotometricInterpretation, Predictor, SampleFormat, Tag, Type,
};
use tiff::{Directory, TiffError};

use super::shape::Shape;
use crate::files::save::Fault;
use crate::formats::facts::SOFTWARE;
use crate::formats::npy::stamp::Stamp;
use crate::formats::profile::linear;

/// The beginnings of the lines with the digest of a picture and the region that the file contains.
pub(super) const DIGEST: &str = "Digest: ";
pub(super) const REGION: &str = "Region: ";

/// The number of bytes that are written together.
const BUFFER_BYTES: usize = 1 << 18;

/// Writes a file in strips with this number of rows. `next` returns the bytes of each strip, from the top downward.
pub(crate) fn write(
    file: &mut (impl Write + Seek),
    shape: Shape,
    rows: u32,
    stamp: &Stamp,
    next: impl FnMut() -> Result<Vec<u8>, Fault>,
) -> Result<(), Fault> {
    if u32::try_from(shape.file_bytes()).is_ok() {
        write_kind::<TiffKindStandard>(file, shape, rows, stamp, next)
    } else {
        write_kind::<TiffKindBig>(file, shape, rows, stamp, next)
    }
}

fn write_kind<K: TiffKind>(
    file: &mut (impl Write + Seek),
    shape: Shape,
    rows: u32,
    stamp: &Stamp,
    mut next: impl FnMut() -> Result<Vec<u8>, Fault>,
) -> Result<(), Fault> {
    let mut file = BufWriter::with_capacity(BUFFER_BYTES, file);
    let mut encoder = TiffEncoder::<_, K>::new_generic(&mut file)?;
    let mut directory = encoder.image_directory()?;
    let (mut places, mut lengths) = (Vec::new(), Vec::new());
    for _ in 0..shape.size.height.div_ceil(rows) {
        let strip = next()?;
        let place = directory.write_data(&strip[..])?;
        places.push(K::convert_offset(place)?);
        lengths.push(K::convert_offset(strip.len() as u64)?);
    }
    let channels = shape.channels();
    let bits = [8 * shape.sample_bytes() as u16; 4];
    let (kind, predictor) = match shape.float {
        true => (SampleFormat::IEEEFP, Predictor::None),
        false => (SampleFormat::Uint, Predictor::Horizontal),
    };
    let colors = match shape.colors {
        1 => PhotometricInterpretation::BlackIsZero,
        _ => PhotometricInterpretation::RGB,
    };
    let mut description = format!("{DIGEST}{}", stamp.digest);
    if !stamp.region.is_all() {
        description += &format!("\n{REGION}{}", stamp.region);
    }
    directory.write_tag(Tag::ImageWidth, shape.size.width)?;
    directory.write_tag(Tag::ImageLength, shape.size.height)?;
    directory.write_tag(Tag::BitsPerSample, &bits[..channels])?;
    directory.write_tag(Tag::Compression, CompressionMethod::Deflate)?;
    directory.write_tag(Tag::PhotometricInterpretation, colors)?;
    directory.write_tag(Tag::ImageDescription, &*description)?;
    directory.write_tag(Tag::StripOffsets, K::convert_slice(&places))?;
    directory.write_tag(Tag::SamplesPerPixel, channels as u16)?;
    directory.write_tag(Tag::RowsPerStrip, rows)?;
    directory.write_tag(Tag::StripByteCounts, K::convert_slice(&lengths))?;
    directory.write_tag(Tag::Software, SOFTWARE)?;
    directory.write_tag(Tag::Predictor, predictor)?;
    if shape.alpha {
        let alpha = [ExtraSamples::AssociatedAlpha];
        directory.write_tag(Tag::ExtraSamples, &alpha[..])?;
    }
    directory.write_tag(Tag::SampleFormat, &[kind; 4][..channels])?;
    let profile = directory.write_entry_bytes(Type::UNDEFINED, &linear(shape.colors == 1))?;
    directory.extend_from(&Directory::from_iter([(Tag::IccProfile, profile)]));
    directory.finish()?;
    file.flush()?;
    Ok(())
}

impl From<TiffError> for Fault {
    fn from(error: TiffError) -> Self {
        match error {
            TiffError::IoError(error) => Self::Io(error),
            other => Self::Io(io::Error::other(other.to_string())),
        }
    }
}
