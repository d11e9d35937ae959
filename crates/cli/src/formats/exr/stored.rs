//! The digest and the region stored in an EXR, if its blocks are not damaged.

use std::io::{Read, Seek, SeekFrom};

use blake3::Hash;
use exr::meta::header::Header;
use exr::meta::{BlockDescription, MetaData};
use exr::prelude::AttributeValue;
use marbles_core::Window;

use super::block_reader::{BlockReader, meta_of};
use super::header::DIGEST_ATTRIBUTE;
use crate::base::failure::reason;
use crate::base::region::Region;
use crate::base::size::Size;
use crate::formats::guard::guarded;
use crate::formats::source::Input;

/// The digest and the region of the picture in a file of one part.
///
/// Reads all blocks: each must be at the position in the table, and the checksum of compressed samples must be correct.
/// Refuses files without a digest, files with damaged blocks, and files that do not end with their last block.
pub(crate) fn contents(mut file: Box<dyn Input>) -> Result<(Hash, Region), String> {
    let (told, blocks) = told(&mut file).ok_or("it contains no digest, or ends early")?;
    file.rewind().map_err(|error| reason(&error))?;
    let meta = meta_of(&mut file)?;
    let mut reader = BlockReader::of_part(file, meta, 0)?;
    for row in 0..blocks {
        reader.read(0, row)?;
    }
    Ok(told)
}

/// The digest and the region of a picture, and the number of its blocks; `None` if the file does not contain them, or
/// does not end with its last block.
fn told(file: &mut Box<dyn Input>) -> Option<((Hash, Region), usize)> {
    let end = file.seek(SeekFrom::End(0)).ok()?;
    file.rewind().ok()?;
    // Pedantic: a number of blocks that does not fit the size tells of a file that was altered.
    let meta = guarded(|| MetaData::read_from_buffered(&mut *file, true)).ok()?;
    let [header] = &meta.headers[..] else {
        return None;
    };
    // Those of tiles are written by others.
    (header.blocks == BlockDescription::ScanLines).then_some(())?;
    let digest = header.own_attributes.other.get(DIGEST_ATTRIBUTE.as_bytes());
    let AttributeValue::Text(digest) = digest? else {
        return None;
    };
    let digest = Hash::from_hex(digest.as_slice()).ok()?;
    (end_of_last_block(file, header.chunk_count)? == end).then_some(())?;
    Some(((digest, region(header)?), header.chunk_count))
}

/// The end of the last block, from its offset in the table, which follows in the file.
fn end_of_last_block(file: &mut (impl Read + Seek), blocks: usize) -> Option<u64> {
    let last = i64::try_from(blocks.checked_sub(1)?.checked_mul(8)?).ok()?;
    file.seek(SeekFrom::Current(last)).ok()?;
    let mut place = [0; 8];
    file.read_exact(&mut place).ok()?;
    let place = u64::from_le_bytes(place);
    // A block begins with the number of its first row and that of its other bytes.
    let mut start = [0; 8];
    file.seek(SeekFrom::Start(place)).ok()?;
    file.read_exact(&mut start).ok()?;
    let [_, _, _, _, bytes @ ..] = start;
    place.checked_add(start.len() as u64 + u64::from(u32::from_le_bytes(bytes)))
}

/// The position of the data window in the display window.
fn region(header: &Header) -> Option<Region> {
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
