//! Loads pictures in any format. The format is recognized by the first bytes, not by the name.

use std::io::{ErrorKind, Read};
use std::path::Path;

use blake3::Hash;

use super::encoding::Format;
use super::picture::{Picture, unusable};
use super::source::Source;
use super::{exr, npy, png};
use crate::base::failure::{Failure, reason};
use crate::base::region::Region;

/// The first bytes of every PNG.
const PNG_MAGIC: &[u8] = b"\x89PNG\r\n\x1a\n";
/// The first bytes of every EXR.
const EXR_MAGIC: &[u8] = b"\x76\x2f\x31\x01";

/// The first bytes of every NPY.
const NPY_MAGIC: &[u8] = b"\x93NUM";

/// Begins to read the picture at `path`.
///
/// All errors count like an invalid scene: the command cannot begin.
pub(crate) fn picture(path: &Path) -> Result<Picture, Failure> {
    let refused = |reason: &str| Failure::unusable(path, reason);
    if path.is_dir() {
        return Err(refused("expected a picture, found a folder"));
    }
    let is_picture = |start: &[u8]| format_of(start).is_some();
    let source = Source::of(path, PNG_MAGIC.len(), is_picture);
    let (source, start) = source.map_err(|error| match error.kind() {
        ErrorKind::NotFound => refused("no such file"),
        ErrorKind::PermissionDenied => refused("no permission to read this file"),
        ErrorKind::OutOfMemory => refused("there is not enough memory to read this file"),
        _ => refused(&reason(&error)),
    })?;
    begin(&source, &start).map_err(|reason| refused(&reason))
}

/// Begins to read the picture in a file with these first bytes, or returns an error.
fn begin(source: &Source, start: &[u8]) -> Result<Picture, String> {
    let Some(format) = format_of(start) else {
        const EXPECTED: &str = "expected a PNG, EXR or NPY picture, found";
        if start.is_empty() {
            return Err(format!("{EXPECTED} an empty file"));
        }
        let start = start[..start.len().min(EXR_MAGIC.len())].escape_ascii();
        return Err(format!("{EXPECTED} a file that begins with `{start}`"));
    };
    let picture = match format {
        Format::Png | Format::Apng => png::read::begin(source),
        Format::Exr => exr::read::begin(source),
        Format::Npy => npy::read::begin(source),
    };
    picture.map_err(|reason| unusable(format, &reason))
}

/// The format of a picture, according to the first bytes of its file.
fn format_of(start: &[u8]) -> Option<Format> {
    let formats = [
        (PNG_MAGIC, Format::Png),
        (EXR_MAGIC, Format::Exr),
        (NPY_MAGIC, Format::Npy),
    ];
    let mut formats = formats.into_iter();
    let format = formats.find(|(magic, _)| start.starts_with(magic));
    format.map(|(_, format)| format)
}

/// The digest stored in the file at `path`, and the part of the picture that it contains.
///
/// A file gets its name only when it is complete. Later damage, by copying or by a disk, is found by reading the whole
/// file, as far as the format has checksums; truncation is found because the end is missing. Otherwise the error names
/// the damage.
pub(crate) fn contents(path: &Path) -> Result<(Hash, Region), String> {
    if !path.is_file() {
        return Err("it is not a file".to_owned());
    }
    contents_of(&Source::File(path.to_owned()))
}

fn contents_of(source: &Source) -> Result<(Hash, Region), String> {
    let mut file = source.open().map_err(|error| reason(&error))?;
    let mut magic = [0; EXR_MAGIC.len()];
    let read = file.read_exact(&mut magic);
    read.map_err(|_| "it ends early".to_owned())?;
    if magic == EXR_MAGIC {
        exr::stored::contents(file)
    } else if magic == NPY_MAGIC {
        npy::stored::contents(&mut file)
            .ok_or_else(|| "it contains no digest, or ends early".to_owned())
    } else {
        png::stored::contents(&mut file)
    }
}

/// Begins to read the picture in these bytes.
#[cfg(test)]
pub(crate) fn decode(bytes: &[u8]) -> Result<Picture, String> {
    let start = &bytes[..bytes.len().min(PNG_MAGIC.len())];
    begin(&Source::Memory(bytes.into()), start)
}

#[cfg(test)]
mod tests;
