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
use marbles_core::{BAND_ROWS, Camera, Image, Method};

use self::animation::{Animation, delay};
use self::exr::Blocks;
pub(crate) use self::exr::ExrOptions;
pub(crate) use self::png::PngOptions;
use self::png::Shape;
use self::temporary::TemporaryFile;
use crate::failure::{Failure, lower};
use crate::memory::Form;

/// What files say about who wrote them.
const SOFTWARE: &str = concat!("marbles ", env!("CARGO_PKG_VERSION"));

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
            Format::Png(_) => 1,
            Format::Exr(_) => exr::ROWS_OF_A_BLOCK / BAND_ROWS,
        }
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

    /// Writes the file of a picture to `path`, whole or not at all.
    pub(crate) fn write(
        &self,
        facts: &Facts,
        path: &Path,
        pieces: &mut impl Pieces,
    ) -> Result<(), Unwritten> {
        match &self.format {
            Format::Png(shape) => write_png(path, *shape, |stream| {
                for _ in 0..self.pieces() {
                    // The others are never made.
                    if let Piece::Samples(samples) = pieces.next().ok_or(Fault::Stopped)? {
                        stream.write_all(&samples)?;
                        pieces.give_back(samples);
                    }
                }
                Ok(())
            }),
            Format::Exr(blocks) => save(path, |mut file| {
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
}

/// Makes sure that a file can be created at `path`, folders included, and leaves none.
pub(crate) fn prepare(path: &Path) -> Result<(), Failure> {
    let destination = destination(path)?;
    let folder = folder(&destination);
    std::fs::create_dir_all(folder)
        .map_err(|error| Failure::io(folder, "cannot create the folder", &error))?;
    TemporaryFile::beside(&destination)
        .map(drop)
        .map_err(|error| Failure::io(path, "cannot create the file", &error))
}

/// Writes a grey PNG of 8 bit codes, row by row, whole or not at all.
pub(crate) fn write_codes(
    width: u32,
    height: u32,
    codes: &[u8],
    path: &Path,
) -> Result<(), Failure> {
    let shape = Shape::of_codes(width, height, true);
    write_png(path, shape, |stream| Ok(stream.write_all(codes)?)).map_err(Unwritten::into_failure)
}

/// Writes a PNG of 8 bit codes of red, green and blue, row by row, whole or not at all.
pub(crate) fn write_rgb_codes(
    width: u32,
    height: u32,
    codes: &[u8],
    path: &Path,
) -> Result<(), Failure> {
    let shape = Shape::of_codes(width, height, false);
    write_png(path, shape, |stream| Ok(stream.write_all(codes)?)).map_err(Unwritten::into_failure)
}

/// A PNG of 8 bit codes of red, green and blue, row by row.
pub(crate) fn rgb_png(width: u32, height: u32, codes: &[u8]) -> Result<Vec<u8>, Failure> {
    let mut file = Cursor::new(Vec::new());
    let shape = Shape::of_codes(width, height, false);
    let written = png::write(&mut file, shape, |stream| Ok(stream.write_all(codes)?));
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

/// Writes a PNG, whose samples `samples` writes.
fn write_png(
    path: &Path,
    shape: Shape,
    samples: impl FnOnce(&mut dyn Write) -> Result<(), Fault>,
) -> Result<(), Unwritten> {
    save(path, |mut file| {
        let has_grown = png::write(file.file(), shape, samples)?;
        if !has_grown {
            return Ok(file);
        }
        let mut stored = file.another()?;
        png::store(file.file(), stored.file(), shape)?;
        Ok(stored)
    })
}

/// Puts the file that `write` has written where it belongs.
fn save(
    path: &Path,
    write: impl FnOnce(TemporaryFile<'_>) -> Result<TemporaryFile<'_>, Fault>,
) -> Result<(), Unwritten> {
    let destination = destination(path).map_err(Unwritten::Failed)?;
    let file = TemporaryFile::beside(&destination).map_err(Fault::Io);
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
