//! Loads pictures in any format. The format is recognized by the first bytes; only TGA is recognized by the name.

use std::fs::File;
use std::io::{BufReader, ErrorKind, Read};
use std::path::Path;

use blake3::Hash;

use super::others::{MOST_FILE_BYTES, Other};
use super::picture::{Picture, unusable};
use super::source::Source;
use super::{exr, npy, png, tiff};
use crate::base::failure::{Failure, reason};
use crate::base::region::Region;

/// A format of pictures that are read.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
enum Readable {
    Png,
    Exr,
    Npy,
    Npz,
    Tiff,
    Other(Other),
}

/// The first bytes of files. A WebP is not among them, because it has a number between its constant bytes.
const STARTS: [(&[u8], Readable); 20] = [
    (b"\x89PNG\r\n\x1a\n", Readable::Png),
    (EXR_MAGIC, Readable::Exr),
    (NPY_MAGIC, Readable::Npy),
    (b"PK\x03\x04", Readable::Npz),
    (b"II*\0", Readable::Tiff),
    (b"MM\0*", Readable::Tiff),
    (b"II+\0", Readable::Tiff),
    (b"MM\0+", Readable::Tiff),
    (b"\xff\xd8\xff", Readable::Other(Other::Jpeg)),
    (b"GIF8", Readable::Other(Other::Gif)),
    (b"#?R", Readable::Other(Other::Radiance)),
    (b"qoif", Readable::Other(Other::Qoi)),
    (b"BM", Readable::Other(Other::Bmp)),
    (b"P1", Readable::Other(Other::Pnm)),
    (b"P2", Readable::Other(Other::Pnm)),
    (b"P3", Readable::Other(Other::Pnm)),
    (b"P4", Readable::Other(Other::Pnm)),
    (b"P5", Readable::Other(Other::Pnm)),
    (b"P6", Readable::Other(Other::Pnm)),
    (b"P7", Readable::Other(Other::Pnm)),
];
/// The first bytes of every EXR.
const EXR_MAGIC: &[u8] = b"\x76\x2f\x31\x01";
/// The first bytes of every NPY.
const NPY_MAGIC: &[u8] = b"\x93NUM";
/// The largest number of bytes of a picture from a pipe, in a format that is read row by row from a file. They are in
/// memory before anything is known about them.
const MOST_PIPED_BYTES: u64 = 1 << 27;
/// The number of bytes from which the format is recognized.
const START_BYTES: usize = 12;

/// Returns whether the file at `path` begins like a picture, or has the name of a TGA. Arrays that are tables of particles
/// are no pictures.
pub(crate) fn is_picture(path: &Path) -> bool {
    let start = || {
        // The start of a pipe could be read only once.
        path.is_file().then_some(())?;
        let mut start = Vec::new();
        let file = File::open(path).ok()?.take(START_BYTES as u64);
        BufReader::new(file).read_to_end(&mut start).ok()?;
        format_of(&start, path)
    };
    match start() {
        Some(Readable::Npy) => !npy::read::is_table(path),
        Some(Readable::Npz) => npy::archive::has_light(path),
        other => other.is_some(),
    }
}

/// Begins to read the picture at `path`.
///
/// All errors count like an invalid scene: the command cannot begin.
pub(crate) fn picture(path: &Path) -> Result<Picture, Failure> {
    let refused = |reason: &str| Failure::unusable(path, reason);
    if path.is_dir() {
        return Err(refused("expected a picture, found a folder"));
    }
    let most = |start: &[u8]| format_of(start, path).map(Readable::most_piped_bytes);
    let source = Source::of(path, START_BYTES, most);
    let (source, start) = source.map_err(|error| match error.kind() {
        ErrorKind::NotFound => refused("no such file"),
        ErrorKind::PermissionDenied => refused("no permission to read this file"),
        ErrorKind::OutOfMemory => refused("there is not enough memory to read this file"),
        _ => refused(&reason(&error)),
    })?;
    begin(&source, &start, path).map_err(|reason| refused(&reason))
}

/// Begins to read the picture in a file with these first bytes and this name, or returns an error.
fn begin(source: &Source, start: &[u8], name: &Path) -> Result<Picture, String> {
    let Some(format) = format_of(start, name) else {
        const EXPECTED: &str = "expected a picture (PNG, EXR, NPY, NPZ, TIFF, JPEG, WebP, GIF, HDR, PNM, TGA, BMP or QOI), found";
        if start.is_empty() {
            return Err(format!("{EXPECTED} an empty file"));
        }
        let start = start[..start.len().min(EXR_MAGIC.len())].escape_ascii();
        return Err(format!("{EXPECTED} a file that begins with `{start}`"));
    };
    let picture = match format {
        Readable::Png => png::read::begin(source),
        Readable::Exr => exr::read::begin(source),
        Readable::Npy => npy::read::begin(source),
        Readable::Npz => npy::archive::begin(source),
        Readable::Tiff => tiff::read::begin(source),
        Readable::Other(other) => other.begin(source),
    };
    picture.map_err(|reason| unusable(format.name(), &reason))
}

impl Readable {
    fn name(self) -> &'static str {
        match self {
            Self::Png => png::read::NAME,
            Self::Exr => exr::read::NAME,
            Self::Npy => npy::read::NAME,
            Self::Npz => npy::archive::NAME,
            Self::Tiff => tiff::read::NAME,
            Self::Other(other) => other.name(),
        }
    }

    /// The largest number of bytes that are read from a pipe, all of which have to be in memory.
    fn most_piped_bytes(self) -> u64 {
        match self {
            Self::Other(_) => MOST_FILE_BYTES,
            _ => MOST_PIPED_BYTES,
        }
    }
}

/// The format of a picture, according to the first bytes of its file. A TGA may begin with any bytes, so it is
/// recognized by its name.
fn format_of(start: &[u8], name: &Path) -> Option<Readable> {
    let mut known = STARTS.iter();
    if let Some((_, format)) = known.find(|(known, _)| start.starts_with(known)) {
        return Some(*format);
    }
    if start.starts_with(b"RIFF") && start.ends_with(b"WEBP") {
        return Some(Readable::Other(Other::Webp));
    }
    let is_tga = name
        .extension()
        .is_some_and(|ending| ending.eq_ignore_ascii_case("tga"));
    (is_tga && !start.is_empty()).then_some(Readable::Other(Other::Tga))
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
    let mut start = [0; EXR_MAGIC.len()];
    let read = file.read_exact(&mut start);
    read.map_err(|_| "it ends early".to_owned())?;
    match format_of(&start, Path::new("")) {
        Some(Readable::Exr) => exr::stored::contents(file),
        Some(Readable::Npy) => npy::stored::contents(&mut file)
            .ok_or_else(|| "it contains no digest, or ends early".to_owned()),
        Some(Readable::Npz) => npy::archive::contents(source),
        Some(Readable::Tiff) => tiff::stored::contents(file),
        _ => png::stored::contents(&mut file),
    }
}

/// Begins to read the picture in these bytes.
#[cfg(test)]
pub(crate) fn decode(bytes: &[u8]) -> Result<Picture, String> {
    decode_named(bytes, "")
}

/// Begins to read the picture in a file of this name.
#[cfg(test)]
pub(crate) fn decode_named(bytes: &[u8], name: &str) -> Result<Picture, String> {
    let start = &bytes[..bytes.len().min(START_BYTES)];
    begin(&Source::Memory(bytes.into()), start, Path::new(name))
}

#[cfg(test)]
mod tests;
