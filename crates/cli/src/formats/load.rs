//! Pictures are loaded from files of any format, which is known by the first bytes and not by the
//! name.

use std::fs::File;
use std::io::{self, ErrorKind, Read, Seek};
use std::path::Path;

use blake3::Hash;

use super::picture::Picture;
use super::{exr, npy, png};
use crate::base::failure::{Failure, lower, reason};
use crate::base::region::Region;

/// The first bytes of every PNG.
const PNG_MAGIC: &[u8] = b"\x89PNG\r\n\x1a\n";
/// The first bytes of every EXR.
const EXR_MAGIC: &[u8] = b"\x76\x2f\x31\x01";

/// The first bytes of every NPY.
const NPY_MAGIC: &[u8] = b"\x93NUM";

/// Reads the picture at `path`.
///
/// All that can be wrong is like an invalid scene: the command cannot begin.
pub(crate) fn picture(path: &Path) -> Result<Picture, Failure> {
    let refused = |reason: &str| Failure::unusable(path, reason);
    if path.is_dir() {
        return Err(refused("expected a picture, found a folder"));
    }
    let bytes = bytes(path).map_err(|error| match error.kind() {
        ErrorKind::NotFound => refused("no such file"),
        ErrorKind::PermissionDenied => refused("no permission to read this file"),
        ErrorKind::OutOfMemory => refused("there is no memory to read this file"),
        _ => refused(&reason(&error)),
    })?;
    decode(&bytes).map_err(|reason| refused(&reason))
}

/// The bytes of a file; only the first where it is no picture, which may have no end.
fn bytes(path: &Path) -> io::Result<Vec<u8>> {
    let mut file = File::open(path)?;
    let mut bytes = Vec::new();
    let start = PNG_MAGIC.len() as u64;
    Read::by_ref(&mut file)
        .take(start)
        .read_to_end(&mut bytes)?;
    let is_picture = [PNG_MAGIC, EXR_MAGIC, NPY_MAGIC];
    if is_picture.iter().any(|magic| bytes.starts_with(magic)) {
        file.read_to_end(&mut bytes)?;
    }
    Ok(bytes)
}

/// The picture in the bytes of a file, or what is wrong with them.
pub(crate) fn decode(bytes: &[u8]) -> Result<Picture, String> {
    if bytes.starts_with(PNG_MAGIC) {
        png::read::decode(bytes).map_err(|reason| format!("not a usable PNG: {}", lower(&reason)))
    } else if bytes.starts_with(EXR_MAGIC) {
        exr::read::decode(bytes).map_err(|reason| format!("not a usable EXR: {}", lower(&reason)))
    } else if bytes.starts_with(NPY_MAGIC) {
        npy::read::decode(bytes).map_err(|reason| format!("not a usable NPY: {}", lower(&reason)))
    } else if bytes.is_empty() {
        Err("expected a PNG, EXR or NPY picture, found an empty file".to_owned())
    } else {
        let start = bytes[..bytes.len().min(EXR_MAGIC.len())].escape_ascii();
        Err(format!(
            "expected a PNG, EXR or NPY picture, found a file that begins with `{start}`"
        ))
    }
}

/// The digest that the file at `path` tells and the part of the picture that it holds, read without
/// its pixels; `None` where it tells none, or has been cut off.
///
/// A file has its name only when it is complete: it is moved there. What copying or a disk has cut
/// off is noticed by the end that is missing.
pub(crate) fn contents(path: &Path) -> Option<(Hash, Region)> {
    if !path.is_file() {
        return None;
    }
    contents_of(&mut File::open(path).ok()?)
}

fn contents_of(file: &mut (impl Read + Seek)) -> Option<(Hash, Region)> {
    let mut magic = [0; EXR_MAGIC.len()];
    file.read_exact(&mut magic).ok()?;
    if magic == EXR_MAGIC {
        exr::stored::contents(file)
    } else if magic == NPY_MAGIC {
        npy::stored::contents(file)
    } else {
        png::stored::contents(file)
    }
}

#[cfg(test)]
mod tests;
