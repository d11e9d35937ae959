//! The digest and the region that a PNG tells, read without its pixels.

use std::io::{BufReader, Read, Seek, SeekFrom};

use blake3::Hash;

use super::decoder::decoder;
use super::shape::size_of;
use super::write::{DIGEST_KEYWORD, REGION_KEYWORD};
use crate::base::region::Region;

/// The last chunk of every PNG: no bytes, the name `IEND`, and the checksum of that.
const LAST_CHUNK: [u8; 12] = *b"\0\0\0\0IEND\xae\x42\x60\x82";

/// The digest and the region of the picture in a file; `None` where it does not tell them, or has been
/// cut off or continued.
pub(crate) fn contents(file: &mut (impl Read + Seek)) -> Option<(Hash, Region)> {
    let mut end = [0; LAST_CHUNK.len()];
    file.seek(SeekFrom::End(-(end.len() as i64))).ok()?;
    file.read_exact(&mut end).ok()?;
    if end != LAST_CHUNK {
        return None;
    }
    file.rewind().ok()?;
    let reader = decoder(BufReader::new(file)).read_info().ok()?;
    let info = reader.info();
    let mut digest = None;
    let mut region = Region::all(size_of(info));
    for chunk in &info.uncompressed_latin1_text {
        match &*chunk.keyword {
            DIGEST_KEYWORD => digest = Some(Hash::from_hex(&chunk.text).ok()?),
            REGION_KEYWORD => region = chunk.text.parse().ok()?,
            _ => {}
        }
    }
    Some((digest?, region))
}
