//! The texts in a PNG: the digest and the region, if nothing in the file is damaged, and others.

use std::fs::File;
use std::io::{BufRead, BufReader, Seek, SeekFrom};
use std::path::Path;

use blake3::Hash;
use png::{DecodingError, Info};

use super::decoder::{decoder, strict_decoder};
use super::shape::size_of;
use super::write::{DIGEST_KEYWORD, REGION_KEYWORD};
use crate::base::failure::lower;
use crate::base::region::Region;

/// The digest and the region of the picture in a file.
///
/// Reads the whole file: the checksum of every chunk and that of the pixels must be correct. Refuses files without a
/// digest, and damaged, truncated or extended files.
pub(crate) fn contents(file: &mut (impl BufRead + Seek)) -> Result<(Hash, Region), String> {
    let place = |place: std::io::Result<u64>| place.map_err(|error| error.to_string());
    let end = place(file.seek(SeekFrom::End(0)))?;
    place(file.seek(SeekFrom::Start(0)))?;
    let told = read(&mut *file).map_err(|error| lower(&error.to_string()))?;
    match place(file.stream_position())? == end {
        true => told.ok_or_else(|| "it contains no digest".to_owned()),
        false => Err("there is data after its last chunk".to_owned()),
    }
}

/// Reads a file up to its last chunk.
fn read(file: impl BufRead + Seek) -> Result<Option<(Hash, Region)>, DecodingError> {
    let mut reader = strict_decoder(Box::new(file)).read_info()?;
    let told = told(reader.info());
    while reader.next_row()?.is_some() {}
    reader.finish()?;
    Ok(told)
}

/// The digest and the region among the texts of a file.
fn told(info: &Info<'_>) -> Option<(Hash, Region)> {
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

/// The text with a keyword in the file at `path`, if it is a PNG with such a text.
pub(crate) fn text(path: &Path, keyword: &str) -> Option<String> {
    // A pipe could be waited for without end.
    let file = path.is_file().then(|| File::open(path).ok())??;
    let reader = decoder(Box::new(BufReader::new(file))).read_info().ok()?;
    let mut texts = reader.info().uncompressed_latin1_text.iter();
    let found = texts.find(|text| text.keyword == keyword);
    found.map(|found| found.text.clone())
}
