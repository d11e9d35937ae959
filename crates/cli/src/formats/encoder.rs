//! Strips of pictures as pieces of files.

use std::ops::Range;
use std::path::Path;

use exr::block::chunk::Chunk;
use marbles_core::{BAND_ROWS, Image};

use super::exr::write::{Blocks, ROWS_OF_A_BLOCK};
use super::png::animation::{Animation, delay};
use super::png::write::Shape;
use super::{Encoding, Facts, Fault, Unwritten, write_png};
use crate::base::memory::Form;
use crate::files::place::{finish, save};
use crate::files::temporary::TemporaryFile;

/// How the pictures of a sequence, which are all of one form, become pieces of files.
#[derive(Debug)]
pub(crate) struct Coder {
    form: Form,
    pub(super) format: Format,
}

#[derive(Debug)]
pub(super) enum Format {
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
            Format::Exr(_) => ROWS_OF_A_BLOCK / BAND_ROWS,
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
