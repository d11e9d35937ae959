//! Whether a file is a whole picture, and what it was made from, without decoding its pixels.
//!
//! A PNG is read to its end, and every checksum in it must be right. An EXR has none: the blocks
//! must follow each other as its table says, and the last one end with the file.

use std::fs::File;
use std::io::{self, BufReader, ErrorKind, Read, Seek, SeekFrom};
use std::path::Path;

use blake3::Hash;
use crc32fast::Hasher;
use exr::meta::MetaData;
use exr::meta::header::Header;
use exr::prelude::AttributeValue;
use marbles_core::Window;

use crate::base::region::Region;
use crate::commands::args::Size;
use crate::formats::picture::{EXR_MAGIC, PNG_MAGIC};
use crate::formats::{DIGEST_ATTRIBUTE, DIGEST_KEYWORD, REGION_KEYWORD};

/// Longer texts are no digests.
const LONGEST_TEXT: u32 = 256;

/// What a file holds: the digest of a picture, and the part of it where that is not all.
pub(crate) type Content = (Hash, Option<Region>);

/// What the file at `path` says it holds; `None` where it is not complete, or says nothing.
pub(crate) fn content(path: &Path) -> Option<Content> {
    if !path.is_file() {
        return None;
    }
    let mut file = BufReader::new(File::open(path).ok()?);
    let mut magic = [0; 4];
    file.read_exact(&mut magic).ok()?;
    file.rewind().ok()?;
    if magic == EXR_MAGIC {
        of_exr(&mut file)
    } else {
        of_png(&mut file)
    }
}

/// Of a PNG.
fn of_png(file: &mut impl Read) -> Option<Content> {
    let mut magic = [0; PNG_MAGIC.len()];
    file.read_exact(&mut magic).ok()?;
    if magic != PNG_MAGIC {
        return None;
    }
    let (mut digest, mut region) = (None, None);
    loop {
        let chunk = Chunk::read(file).ok()?;
        match &chunk.kind {
            b"tEXt" => {
                if let Some(text) = text_behind(DIGEST_KEYWORD, &chunk.text) {
                    digest = Some(Hash::from_hex(text).ok()?);
                }
                if let Some(text) = text_behind(REGION_KEYWORD, &chunk.text) {
                    region = Some(text.parse().ok()?);
                }
            }
            b"IEND" => break,
            _ => {}
        }
    }
    // Nothing may follow.
    match file.read(&mut [0]) {
        Ok(0) => Some((digest?, region)),
        _ => None,
    }
}

/// A part of a PNG whose checksum is right.
struct Chunk {
    kind: [u8; 4],
    /// What is in it, where that is short.
    text: Vec<u8>,
}

impl Chunk {
    fn read(file: &mut impl Read) -> io::Result<Self> {
        let mut length = [0; 4];
        let mut kind = [0; 4];
        file.read_exact(&mut length)?;
        file.read_exact(&mut kind)?;
        let length = u32::from_be_bytes(length);
        let mut sum = Hasher::new();
        sum.update(&kind);
        let mut text = Vec::new();
        let mut content = file.by_ref().take(length.into());
        if length <= LONGEST_TEXT {
            content.read_to_end(&mut text)?;
            sum.update(&text);
        } else {
            let mut buffer = [0; 1 << 14];
            loop {
                match content.read(&mut buffer) {
                    Ok(0) => break,
                    Ok(count) => sum.update(&buffer[..count]),
                    Err(error) if error.kind() == ErrorKind::Interrupted => {}
                    Err(error) => return Err(error),
                }
            }
        }
        let is_whole = content.limit() == 0;
        let mut expected = [0; 4];
        file.read_exact(&mut expected)?;
        if is_whole && sum.finalize() == u32::from_be_bytes(expected) {
            Ok(Self { kind, text })
        } else {
            Err(ErrorKind::InvalidData.into())
        }
    }
}

/// What stands behind this keyword, from which a zero byte divides it.
fn text_behind<'chunk>(keyword: &str, chunk: &'chunk [u8]) -> Option<&'chunk str> {
    let text = chunk.strip_prefix(keyword.as_bytes())?;
    str::from_utf8(text.strip_prefix(b"\0")?).ok()
}

/// Of an EXR of one part whose blocks are rows, as they are written here.
fn of_exr(file: &mut (impl Read + Seek)) -> Option<Content> {
    let end = file.seek(SeekFrom::End(0)).ok()?;
    file.rewind().ok()?;
    let meta = MetaData::read_from_buffered(&mut *file, false).ok()?;
    let [header] = &meta.headers[..] else {
        return None;
    };
    let digest = match header
        .own_attributes
        .other
        .get(DIGEST_ATTRIBUTE.as_bytes())?
    {
        AttributeValue::Text(digest) => Hash::from_hex(digest.as_slice()).ok()?,
        _ => return None,
    };
    let mut table = vec![0; header.chunk_count.checked_mul(8)?];
    file.read_exact(&mut table).ok()?;
    let mut place = file.stream_position().ok()?;
    let rows = header.compression.scan_lines_per_block();
    let (offsets, _) = table.as_chunks();
    for (row, offset) in (header.own_attributes.layer_position.y()..)
        .step_by(rows)
        .zip(offsets)
    {
        if u64::from_le_bytes(*offset) != place {
            return None;
        }
        file.seek(SeekFrom::Start(place)).ok()?;
        let mut start = [0; 8];
        file.read_exact(&mut start).ok()?;
        let (numbers, _) = start.as_chunks();
        let [found, bytes] = [numbers[0], numbers[1]].map(i32::from_le_bytes);
        if found != row {
            return None;
        }
        place += start.len() as u64 + u64::try_from(bytes).ok()?;
    }
    let region = region_of(header)?;
    (place == end).then_some((digest, (!region.is_all()).then_some(region)))
}

/// Where the data window lies in the display window.
fn region_of(header: &Header) -> Option<Region> {
    let display = header.shared_attributes.display_window;
    let position = header.own_attributes.layer_position;
    let number = |number: usize| u32::try_from(number).ok();
    let offset = |data: i32, display: i32| u32::try_from(data.checked_sub(display)?).ok();
    let window = Window {
        col: offset(position.x(), display.position.x())?,
        row: offset(position.y(), display.position.y())?,
        width: number(header.layer_size.width())?,
        height: number(header.layer_size.height())?,
    };
    let whole = Size {
        width: number(display.size.width())?,
        height: number(display.size.height())?,
    };
    Region::new(window, whole)
}

#[cfg(test)]
mod tests;
