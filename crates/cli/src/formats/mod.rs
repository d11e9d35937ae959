//! Pictures as files, and what else is written.
//!
//! Files are written under a temporary name beside their place, and moved there when they are
//! complete. Strips become samples and, where blocks are compressed on their own, blocks by
//! a [`Coder`], in the threads that render them; another one writes what comes of it.

pub(crate) mod contents;
mod encoder;
mod exr;
pub(crate) mod frame_rate;
mod half;
pub(crate) mod picture;
mod png;
pub(crate) mod srgb;

use std::io::{self, Cursor, Write};
use std::ops::Range;
use std::path::Path;

use blake3::Hash;
use marbles_core::{Camera, Method};

pub(crate) use self::encoder::{Coder, Piece, Pieces};
pub(crate) use self::exr::write::ExrOptions;
pub(crate) use self::png::write::PngOptions;
use self::png::write::Shape;
use crate::base::failure::Failure;
use crate::base::region::Region;
use crate::commands::args::Size;
use crate::files::place::{destination, finish, save};
use crate::files::temporary::TemporaryFile;

/// What files say about who wrote them.
const SOFTWARE: &str = concat!("marbles ", env!("CARGO_PKG_VERSION"));
/// The keyword under which a PNG keeps the digest of its picture.
pub(crate) const DIGEST_KEYWORD: &str = "Digest";
/// The keyword under which one that holds a part of a picture keeps which.
pub(crate) const REGION_KEYWORD: &str = "Region";
/// The attribute in which an EXR keeps the digest.
pub(crate) const DIGEST_ATTRIBUTE: &str = "digest";

/// How pictures are turned into bytes.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub(crate) enum Encoding {
    Png(PngOptions),
    /// The pictures of a sequence in one file.
    Apng(PngOptions),
    Exr(ExrOptions),
}

/// Writes a PNG with the digest `digest` and of the kind that `like` is, whole or not at all; its
/// rows are `samples`'.
pub(crate) fn write_png_like(
    path: &Path,
    like: &::png::Info<'_>,
    size: Size,
    digest: &Hash,
    samples: impl FnOnce(&mut dyn FnMut(&[u8]) -> io::Result<()>) -> Option<io::Result<()>>,
) -> Result<(), Unwritten> {
    let file = TemporaryFile::beside(&destination(path).map_err(Unwritten::Failed)?);
    let texts = [(DIGEST_KEYWORD, digest.to_string())];
    write_png(path, file, Shape::like(like, size), &texts, |stream| {
        let written = samples(&mut |rows| stream.write_all(rows));
        Ok(written.ok_or(Fault::Stopped)??)
    })
}

/// Writes an EXR of the kind that `like` is, with its attributes, whole or not at all; `samples` are
/// those of some rows at a time.
pub(crate) fn write_exr_like(
    path: &Path,
    like: &::exr::meta::header::Header,
    size: Size,
    samples: impl FnMut(Range<u32>) -> Option<Vec<u8>>,
) -> Result<(), Unwritten> {
    save(path, |mut file| {
        exr::write::write_like(file.file(), like, size, samples)?;
        Ok(file)
    })
}

/// Why a file was not written.
#[derive(Debug)]
pub(crate) enum Unwritten {
    Failed(Failure),
    /// Pieces of the picture will not come.
    Stopped,
}

/// Why something could not be encoded or written.
#[derive(Debug)]
pub(crate) enum Fault {
    Io(io::Error),
    Encoding(String),
    /// See [`Unwritten`].
    Stopped,
}

impl From<io::Error> for Fault {
    fn from(error: io::Error) -> Self {
        Self::Io(error)
    }
}

/// What a file says about its picture beside the pixels, where the format has room for it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Facts {
    pub(crate) camera: Camera,
    pub(crate) frame: i32,
    pub(crate) frames_per_second: Option<f64>,
    pub(crate) method: Method,
    /// What the whole picture is made from.
    pub(crate) digest: Hash,
}

impl Facts {
    /// What a PNG says: keywords and texts.
    fn texts(&self, part: Option<Region>) -> Vec<(&'static str, String)> {
        let digest = (DIGEST_KEYWORD, self.digest.to_string());
        let part = part.map(|part| (REGION_KEYWORD, part.to_string()));
        [digest].into_iter().chain(part).collect()
    }
}

/// Writes a grey PNG of 8 bit codes, row by row, whole or not at all.
pub(crate) fn write_codes(
    width: u32,
    height: u32,
    codes: &[u8],
    path: &Path,
) -> Result<(), Failure> {
    let shape = Shape::of_codes(width, height, true);
    save_png(path, shape, codes)
}

/// Writes a PNG of 8 bit codes of red, green and blue, row by row, whole or not at all.
pub(crate) fn write_rgb_codes(
    width: u32,
    height: u32,
    codes: &[u8],
    path: &Path,
) -> Result<(), Failure> {
    let shape = Shape::of_codes(width, height, false);
    save_png(path, shape, codes)
}

/// A PNG of 8 bit codes of red, green and blue, row by row.
pub(crate) fn rgb_png(width: u32, height: u32, codes: &[u8]) -> Result<Vec<u8>, Failure> {
    let mut file = Cursor::new(Vec::new());
    let shape = Shape::of_codes(width, height, false);
    let written = png::write::write(&mut file, shape, &[], |stream| Ok(stream.write_all(codes)?));
    match written {
        Ok(_has_grown) => Ok(file.into_inner()),
        Err(_) => Err(Failure::Work("cannot encode the picture".to_owned())),
    }
}

/// Writes a file that is no picture, or already encoded, whole or not at all.
pub(crate) fn write_bytes(bytes: &[u8], path: &Path) -> Result<(), Failure> {
    let written = save(path, |mut file| {
        file.file().write_all(bytes)?;
        Ok(file)
    });
    written.map_err(Unwritten::into_failure)
}

/// Writes an EXR of channels in single precision, whole or not at all.
pub(crate) fn write_floats(
    width: u32,
    height: u32,
    channels: Vec<(&str, Vec<f32>)>,
    path: &Path,
) -> Result<(), Failure> {
    let written = save(path, |mut file| {
        exr::write::write_floats(file.file(), (width, height), channels)?;
        Ok(file)
    });
    written.map_err(Unwritten::into_failure)
}

impl Unwritten {
    /// Of a file whose pieces were all there.
    fn into_failure(self) -> Failure {
        match self {
            Self::Failed(failure) => failure,
            Self::Stopped => Failure::Work("the picture is not complete".to_owned()),
        }
    }
}

/// Writes a PNG of 8 bit codes.
fn save_png(path: &Path, shape: Shape, codes: &[u8]) -> Result<(), Failure> {
    let file = TemporaryFile::beside(&destination(path)?);
    let written = write_png(
        path,
        file,
        shape,
        &[],
        |stream| Ok(stream.write_all(codes)?),
    );
    written.map_err(Unwritten::into_failure)
}

/// Writes a PNG, whose samples `samples` writes.
fn write_png(
    path: &Path,
    file: io::Result<TemporaryFile>,
    shape: Shape,
    texts: &[(&str, String)],
    samples: impl FnOnce(&mut dyn Write) -> Result<(), Fault>,
) -> Result<(), Unwritten> {
    finish(path, file, |mut file| {
        let has_grown = png::write::write(file.file(), shape, texts, samples)?;
        if !has_grown {
            return Ok(file);
        }
        let mut stored = file.another()?;
        png::write::store(file.file(), stored.file(), shape, texts)?;
        Ok(stored)
    })
}

#[cfg(test)]
pub(crate) mod tests;
