//! The digest and the region in a TIFF, if its strips are not damaged.

use std::io::{Read, Seek, SeekFrom};

use blake3::Hash;
use flate2::read::ZlibDecoder;
use tiff::decoder::Decoder;
use tiff::tags::Tag;

use super::decoder::{Opened, open};
use super::shape::Shape;
use super::write::{DIGEST, REGION};
use crate::base::failure::{lower, reason};
use crate::base::region::Region;
use crate::formats::guard::guarded;
use crate::formats::source::Input;

/// The digest and the region of the picture in a file.
///
/// All strips are read: each must begin where the one before ends, and the checksums of the samples must be correct. Files
/// without a digest, with damaged strips, or with bytes after the directory are refused.
pub(crate) fn contents(file: Box<dyn Input>) -> Result<(Hash, Region), String> {
    let mut opened = open(file)?;
    let shape =
        Shape::of_file(&opened).ok_or("its samples differ from those that marbles writes")?;
    let told = told(&mut opened).ok_or("it contains no digest")?;
    let decoder = &mut opened.decoder;
    let places = numbers(decoder, Tag::StripOffsets)?;
    let lengths = numbers(decoder, Tag::StripByteCounts)?;
    let mut file = decoder.inner();
    let io = |error: std::io::Error| reason(&error);
    if file.seek(SeekFrom::End(0)).map_err(io)? != opened.directory_end {
        return Err("it continues after its directory".to_owned());
    }
    let (_, rows) = opened.chunk;
    let strips = shape.size.height.div_ceil(rows);
    if [places.len(), lengths.len()] != [strips as usize; 2] {
        return Err("it has more or fewer strips than its size needs".to_owned());
    }
    let mut place = places[0];
    for (index, (&start, &length)) in (0..).zip(places.iter().zip(&lengths)) {
        if start != place {
            return Err(format!("strip {index} is not where the one before ends"));
        }
        place += length;
        file.seek(SeekFrom::Start(start)).map_err(io)?;
        let rows = rows.min(shape.size.height - index * rows);
        let bytes = rows as u64 * shape.row_bytes() as u64;
        let mut samples = ZlibDecoder::new(file.take(length));
        // The decoder compares the checksum only if one more byte is read.
        let read = std::io::copy(
            &mut Read::by_ref(&mut samples).take(bytes + 1),
            &mut std::io::sink(),
        );
        let whole = read.is_ok_and(|read| read == bytes) && samples.total_in() == length;
        if !whole {
            return Err(format!("strip {index} is damaged"));
        }
        file = samples.into_inner().into_inner();
    }
    Ok(told)
}

/// The numbers of a tag.
fn numbers(decoder: &mut Decoder<Box<dyn Input>>, tag: Tag) -> Result<Vec<u64>, String> {
    let found = guarded(|| decoder.find_tag_unsigned_vec(tag));
    found
        .map_err(|error| lower(&error))?
        .ok_or_else(|| "it has no strips".to_owned())
}

/// The digest and the region in the description of a file.
fn told(file: &mut Opened) -> Option<(Hash, Region)> {
    let text = guarded(|| file.decoder.get_tag_ascii_string(Tag::ImageDescription)).ok()?;
    let mut lines = text.lines();
    let digest = Hash::from_hex(lines.next()?.strip_prefix(DIGEST)?).ok()?;
    let region = match lines.next() {
        Some(line) => line.strip_prefix(REGION)?.parse().ok()?,
        None => Region::all(file.size),
    };
    (region.size() == file.size).then_some((digest, region))
}
