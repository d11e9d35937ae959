//! Pictures as files, and what else is written.
//!
//! Files are written under a temporary name beside their place, and moved there when they are
//! complete. Strips become samples and, where blocks are compressed on their own, blocks by
//! a [`Coder`], in the threads that render them; another one writes what comes of it.

mod animation;
mod exr;
mod half;
mod header;
mod png;
pub(crate) mod srgb;
pub(crate) mod temporary;

use std::io::{self, Cursor, Write};
use std::ops::Range;
use std::path::{Path, PathBuf};

use ::exr::block::chunk::Chunk;
use blake3::Hash;
use marbles_core::{BAND_ROWS, Camera, Image, Method};

use self::animation::{Animation, delay};
use self::exr::Blocks;
pub(crate) use self::exr::ExrOptions;
pub(crate) use self::png::PngOptions;
use self::png::Shape;
use self::temporary::{LeftOver, TemporaryFile};
use crate::args::Size;
use crate::failure::{Failure, lower};
use crate::memory::Form;
use crate::region::Region;

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

/// How the pictures of a sequence, which are all of one form, become pieces of files.
#[derive(Debug)]
pub(crate) struct Coder {
    form: Form,
    format: Format,
}

#[derive(Debug)]
enum Format {
    Png(Shape),
    Exr(Box<Blocks>),
}

/// What a strip becomes.
#[derive(Debug)]
pub(crate) enum Piece {
    /// To be compressed after what comes before.
    Samples(Vec<u8>),
    /// Ready to be written, or why it is not.
    Block(Result<Chunk, String>),
}

impl Coder {
    pub(crate) fn new(encoding: Encoding, form: Form) -> Self {
        let format = match encoding {
            Encoding::Png(options) | Encoding::Apng(options) => Format::Png(options.shape(&form)),
            Encoding::Exr(options) => Format::Exr(Box::new(options.blocks(&form))),
        };
        Self { form, format }
    }

    /// Bands of a strip: what becomes one piece.
    pub(crate) fn bands(&self) -> u32 {
        match self.format {
            Format::Png(_) if self.origin().1.is_multiple_of(BAND_ROWS) => 1,
            // What begins within a band renders all of it, so that few should.
            Format::Png(_) => 4,
            Format::Exr(_) => exr::ROWS_OF_A_BLOCK / BAND_ROWS,
        }
    }

    /// Where the first pixel lies in the whole picture: its column and row.
    pub(crate) fn origin(&self) -> (u32, u32) {
        self.form.origin()
    }

    /// Rows of a strip.
    pub(crate) fn rows(&self) -> u32 {
        self.bands() * BAND_ROWS
    }

    /// Pieces of a picture.
    pub(crate) fn pieces(&self) -> u32 {
        self.form.height.div_ceil(self.rows())
    }

    /// Bytes that a strip takes on its way at most.
    pub(crate) fn strip_bytes(&self) -> u64 {
        /// The samples; while a block is compressed, three copies more.
        const COPIES_OF_A_BLOCK: u64 = 4;
        let samples = self.sample_bytes(0) as u64;
        match self.format {
            Format::Png(_) => samples,
            Format::Exr(_) => COPIES_OF_A_BLOCK * samples,
        }
    }

    /// Bytes of the samples of the strip with this index.
    pub(crate) fn sample_bytes(&self, index: u32) -> usize {
        let rows = (self.form.height - index * self.rows()).min(self.rows());
        let row_bytes = match &self.format {
            Format::Png(shape) => shape.row_bytes(),
            Format::Exr(blocks) => blocks.row_bytes(),
        };
        rows as usize * row_bytes
    }

    /// Puts some rows of an image where they belong in a strip of as many rows, from the column `col`
    /// on; how many finite numbers were too large for the format's.
    pub(crate) fn encode(
        &self,
        samples: &mut [u8],
        col: u32,
        image: &Image,
        rows: Range<u32>,
    ) -> u64 {
        match &self.format {
            Format::Png(shape) => {
                shape.encode(samples, col, image, rows);
                0
            }
            Format::Exr(blocks) => blocks.encode(samples, col, image, rows),
        }
    }

    /// What the strip with this index becomes.
    pub(crate) fn piece(&self, index: u32, samples: Vec<u8>) -> Piece {
        match &self.format {
            Format::Png(_) => Piece::Samples(samples),
            Format::Exr(blocks) => Piece::Block(blocks.compress(index, samples)),
        }
    }

    /// Writes the file of a picture to `path`, whole or not at all, by way of `file`.
    pub(crate) fn write(
        &self,
        facts: &Facts,
        path: &Path,
        file: TemporaryFile,
        pieces: &mut impl Pieces,
    ) -> Result<(), Unwritten> {
        match &self.format {
            Format::Png(shape) => write_png(
                path,
                Ok(file),
                *shape,
                &facts.texts(self.form.part),
                |stream| {
                    for _ in 0..self.pieces() {
                        // The others are never made.
                        if let Piece::Samples(samples) = pieces.next().ok_or(Fault::Stopped)? {
                            stream.write_all(&samples)?;
                            pieces.give_back(samples);
                        }
                    }
                    Ok(())
                },
            ),
            Format::Exr(blocks) => finish(path, Ok(file), |mut file| {
                blocks.write(file.file(), facts, || match pieces.next() {
                    Some(Piece::Block(block)) => block.map_err(Fault::Encoding),
                    _ => Err(Fault::Stopped),
                })?;
                Ok(file)
            }),
        }
    }
}

impl Coder {
    /// Writes a file of so many pictures to `path`, whole or not at all; `written` is called after each
    /// of them, and ends it all with `None`.
    ///
    /// An animated PNG, which repeats for ever, of so many frames per second, where that is known.
    pub(crate) fn write_loop(
        &self,
        path: &Path,
        frames: u32,
        frames_per_second: Option<f64>,
        pieces: &mut impl Pieces,
        mut written: impl FnMut() -> Option<()>,
    ) -> Result<(), Unwritten> {
        let Format::Png(shape) = &self.format else {
            // Other formats have no loops.
            return Err(Unwritten::Stopped);
        };
        save(path, |mut file| {
            let mut animation =
                Animation::begin(file.file(), *shape, frames, delay(frames_per_second))?;
            for _ in 0..frames {
                for _ in 0..self.pieces() {
                    // The others are never made.
                    if let Piece::Samples(samples) = pieces.next().ok_or(Fault::Stopped)? {
                        animation.add_samples(&samples);
                        pieces.give_back(samples);
                    }
                }
                animation.end_frame()?;
                written().ok_or(Fault::Stopped)?;
            }
            animation.finish()?;
            Ok(file)
        })
    }
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
        exr::write_like(file.file(), like, size, samples)?;
        Ok(file)
    })
}

/// The pieces of a picture, from the top downward.
pub(crate) trait Pieces {
    /// The next one; `None` where it will not come.
    fn next(&mut self) -> Option<Piece>;

    /// Takes memory that is to be used again.
    fn give_back(&mut self, samples: Vec<u8>);
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
enum Fault {
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

/// Makes sure that there is a folder for the file at `path`.
pub(crate) fn prepare(path: &Path) -> Result<(), Failure> {
    let destination = destination(path)?;
    let folder = folder(&destination);
    std::fs::create_dir_all(folder)
        .map_err(|error| Failure::io(folder, "cannot create the folder", &error))
}

/// Begins a file for `path`.
pub(crate) fn begin(path: &Path) -> Result<TemporaryFile, Failure> {
    TemporaryFile::beside(&destination(path)?).map_err(|error| uncreated(path, &error))
}

/// Begins a file for `path` unless another process that lives is writing it.
pub(crate) fn claim(path: &Path) -> Result<Option<TemporaryFile>, Failure> {
    TemporaryFile::claim(&destination(path)?).map_err(|error| uncreated(path, &error))
}

/// Removes what killed processes left of a file for `path`.
pub(crate) fn clean(path: &Path, left_over: &mut LeftOver) {
    if let Ok(destination) = destination(path) {
        left_over.remove(&destination);
    }
}

fn uncreated(path: &Path, error: &io::Error) -> Failure {
    Failure::io(path, "cannot create the file", error)
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
    let written = png::write(&mut file, shape, &[], |stream| Ok(stream.write_all(codes)?));
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
        exr::write_floats(file.file(), (width, height), channels)?;
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
        let has_grown = png::write(file.file(), shape, texts, samples)?;
        if !has_grown {
            return Ok(file);
        }
        let mut stored = file.another()?;
        png::store(file.file(), stored.file(), shape, texts)?;
        Ok(stored)
    })
}

/// Puts the file that `write` has written where it belongs.
fn save(
    path: &Path,
    write: impl FnOnce(TemporaryFile) -> Result<TemporaryFile, Fault>,
) -> Result<(), Unwritten> {
    let destination = destination(path).map_err(Unwritten::Failed)?;
    finish(path, TemporaryFile::beside(&destination), write)
}

/// As [`save`], by way of `file`.
fn finish(
    path: &Path,
    file: io::Result<TemporaryFile>,
    write: impl FnOnce(TemporaryFile) -> Result<TemporaryFile, Fault>,
) -> Result<(), Unwritten> {
    let file = file.map_err(Fault::Io);
    let written = file.and_then(write).and_then(|file| Ok(file.persist()?));
    written.map_err(|fault| match fault {
        Fault::Io(error) => Unwritten::Failed(Failure::io(path, "cannot write the file", &error)),
        Fault::Encoding(error) => {
            let message = format!("cannot encode the picture: {}", lower(&error));
            Unwritten::Failed(Failure::at(path, &message))
        }
        Fault::Stopped => Unwritten::Stopped,
    })
}

/// Where the file for `path` belongs: at the end of symbolic links, which stay as they are, and
/// only in place of another file.
fn destination(path: &Path) -> Result<PathBuf, Failure> {
    /// As many as Linux follows.
    const MOST_LINKS: usize = 40;
    let mut destination = path.to_owned();
    for _ in 0..=MOST_LINKS {
        let Ok(target) = std::fs::read_link(&destination) else {
            return match std::fs::metadata(&destination) {
                Ok(found) if found.is_dir() => Err("there is a folder"),
                Ok(found) if !found.is_file() => Err("there is something that is no file"),
                _ => Ok(destination),
            }
            .map_err(|what| Failure::at(path, &format!("cannot write the file: {what}")));
        };
        // A relative target starts at the folder of the link; an absolute one replaces it.
        destination = folder(&destination).join(target);
    }
    let what = "cannot create the file: too many symbolic links";
    Err(Failure::at(path, what))
}

/// The folder that a file lies in.
fn folder(path: &Path) -> &Path {
    match path.parent() {
        Some(folder) if !folder.as_os_str().is_empty() => folder,
        _ => Path::new("."),
    }
}

#[cfg(test)]
pub(crate) mod tests;
