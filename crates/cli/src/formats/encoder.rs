//! The encoder of a sequence: strips become pieces of files, and pieces become files.

use std::ops::Range;
use std::path::{Path, PathBuf};

use ::exr::block::chunk::Chunk;
use blake3::Hash;
use marbles_core::{GeometrySettings, Image, Precision, Rendering, Summary};

use super::center_channels::CenterValues;
use super::encoding::{AnimationFormat, Encoding};
use super::exr::blocks::{Blocks, ROWS_OF_A_BLOCK};
use super::exr::write::write_blocks;
use super::facts::Facts;
use super::form::Form;
use super::npy::files::Files;
use super::npy::memory::NamedArray;
use super::npy::stamp::Stamp;
use super::png::shape::Shape;
use super::png::write::{texts, write};
use super::{loops, tiff};
use crate::files::save::{Fault, Unwritten, finish, save};
use crate::files::temporary::TemporaryFile;

/// The encoder of the pictures of a sequence, which all have the same form.
#[derive(Debug)]
pub(crate) struct Encoder {
    pub(crate) form: Form,
    pub(super) layout: Layout,
}

/// The layout of the samples in a file.
#[derive(Debug)]
pub(super) enum Layout {
    Png {
        shape: Shape,
        /// See [`PngOptions`](super::encoding::PngOptions).
        gain: f64,
        /// The format of a file that has all pictures of a sequence.
        animation: Option<AnimationFormat>,
    },
    Exr(Box<Blocks>),
    Npy(Files),
    Tiff(tiff::Strips),
}

/// A part of a file, made from a strip.
#[derive(Debug)]
pub(crate) enum Piece {
    /// To be compressed after the previous pieces.
    Samples(Vec<u8>),
    /// Ready to be written, or an error.
    Block(Result<Chunk, String>),
}

impl Encoder {
    /// The encoder of pictures with these additional layers, which only an EXR can have.
    pub(crate) fn new(encoding: Encoding, form: Form, layers: &[String]) -> Self {
        let layout = match encoding {
            Encoding::Png(options) => Layout::Png {
                shape: Shape::of(&form, options),
                gain: options.gain,
                animation: None,
            },
            Encoding::Animation(format, options) => Layout::Png {
                shape: Shape::of(&form, options),
                gain: options.gain,
                animation: Some(format),
            },
            Encoding::Exr(options) => Layout::Exr(Box::new(Blocks::new(&form, options, layers))),
            Encoding::Npy(options) => Layout::Npy(Files::new(&form, options)),
            Encoding::Tiff(options) => Layout::Tiff(tiff::Strips::new(&form, options)),
        };
        Self { form, layout }
    }

    /// The number of layers; the picture is the first one.
    pub(crate) fn layers(&self) -> usize {
        match &self.layout {
            Layout::Exr(blocks) => blocks.layers(),
            Layout::Png { .. } | Layout::Npy(_) | Layout::Tiff(_) => 1,
        }
    }

    /// The number of rows in a strip.
    pub(crate) fn rows(&self) -> u32 {
        let step = Rendering::ROW_STEP;
        match self.layout {
            Layout::Exr(_) => ROWS_OF_A_BLOCK,
            _ if self.form.region.window.row.is_multiple_of(step) => step,
            // A strip that begins between two steps renders all rows of both, so that there should be few.
            _ => 4 * step,
        }
    }

    /// The number of pieces of a picture, one for each strip.
    pub(crate) fn pieces(&self) -> u32 {
        self.form.region.window.height.div_ceil(self.rows())
    }

    /// The largest number of bytes that a strip takes until it is written.
    pub(crate) fn strip_bytes(&self) -> u64 {
        /// The samples; during the compression of a block also three copies.
        const COPIES_OF_A_BLOCK: u64 = 4;
        let samples = self.sample_bytes(0) as u64;
        match self.layout {
            Layout::Png { .. } | Layout::Npy(_) => samples,
            Layout::Exr(_) | Layout::Tiff(_) => COPIES_OF_A_BLOCK * samples,
        }
    }

    /// The number of bytes of the samples of the strip with this index.
    pub(crate) fn sample_bytes(&self, index: u32) -> usize {
        let rows = (self.form.region.window.height - index * self.rows()).min(self.rows());
        let row_bytes = match &self.layout {
            Layout::Png { shape, .. } => shape.row_bytes(),
            Layout::Exr(blocks) => blocks.row_bytes(),
            Layout::Npy(files) => files.arrays.row_bytes(),
            Layout::Tiff(strips) => strips.shape.row_bytes(),
        };
        rows as usize * row_bytes
    }

    /// Copies rows of a layer's image to their positions in a strip with the same rows, starting at the column `col`.
    /// Returns how many pixels were clipped, if the largest code stands for white, or else how many finite numbers were
    /// too large for the file.
    pub(crate) fn encode(
        &self,
        layer: usize,
        samples: &mut [u8],
        col: u32,
        image: &Image,
        rows: Range<u32>,
    ) -> u64 {
        match &self.layout {
            Layout::Png { shape, gain, .. } => shape.encode(samples, col, image, rows, *gain),
            Layout::Exr(blocks) => blocks.encode(layer, samples, col, image, rows),
            Layout::Npy(files) => {
                files.arrays.encode(samples, col, image, rows);
                0
            }
            Layout::Tiff(strips) => strips.encode(samples, col, image, rows),
        }
    }

    /// The geometry that an image must contain for its file, in the number type of the format.
    pub(crate) fn geometry(&self) -> Option<GeometrySettings> {
        let centers = self.form.centers?;
        let precision = match self.layout {
            Layout::Png { .. } | Layout::Exr(_) | Layout::Tiff(_) => Precision::Single,
            Layout::Npy(_) => Precision::Double,
        };
        Some(centers.settings(precision))
    }

    /// Copies the center values of the pixels of a strip to their positions, starting at the column `col`.
    pub(crate) fn encode_geometry(
        &self,
        samples: &mut [u8],
        col: u32,
        geometry: &impl CenterValues,
    ) {
        match &self.layout {
            // They have no such channels.
            Layout::Png { .. } | Layout::Tiff(_) => {}
            Layout::Exr(blocks) => blocks.encode_geometry(samples, col, geometry),
            Layout::Npy(files) => files.arrays.encode_geometry(samples, col, geometry),
        }
    }

    /// Converts the samples of the strip with this index to a piece.
    pub(crate) fn piece(&self, index: u32, samples: Vec<u8>) -> Piece {
        match &self.layout {
            Layout::Png { .. } | Layout::Npy(_) => Piece::Samples(samples),
            Layout::Exr(blocks) => Piece::Block(blocks.compress(index, samples)),
            Layout::Tiff(strips) => Piece::Samples(strips.shape.compress(samples)),
        }
    }

    /// The files of the picture at `path`, its main file first, and the digests that they contain if that of the main
    /// file is `digest`.
    pub(crate) fn files(&self, path: &Path, digest: &Hash) -> Vec<(PathBuf, Hash)> {
        match &self.layout {
            Layout::Png { .. } | Layout::Exr(_) | Layout::Tiff(_) => {
                vec![(path.to_owned(), *digest)]
            }
            Layout::Npy(files) => files.digests(path, digest),
        }
    }

    /// Writes the file of a picture to `path`, completely or not at all, through `file`.
    ///
    /// `next` returns the pieces from the top downward, and `None` for a piece that will not come. `summary` returns
    /// the results after the last piece. `complete` is called before the complete file gets its name.
    pub(crate) fn write(
        &self,
        facts: &Facts,
        path: &Path,
        mut file: TemporaryFile,
        mut next: impl FnMut() -> Option<Piece>,
        summary: impl FnOnce() -> Option<Summary>,
        complete: impl FnOnce() -> Result<(), Fault>,
    ) -> Result<(), Unwritten> {
        let written = match &self.layout {
            Layout::Png { shape, .. } => {
                let texts = texts(&facts.digest, &self.form.region);
                write(file, *shape, &texts, |stream| {
                    for _ in 0..self.pieces() {
                        stream.write_all(&samples(next())?)?;
                    }
                    Ok(())
                })
            }
            Layout::Exr(blocks) => {
                let next = || block(next());
                write_blocks(file.file(), blocks, facts, next, summary).map(|()| file)
            }
            Layout::Npy(files) => {
                let strips = self.pieces();
                files.write(path, file, &facts.digest, strips, || samples(next()))
            }
            Layout::Tiff(strips) => {
                let (shape, rows) = (strips.shape, self.rows());
                let stamp = Stamp {
                    digest: facts.digest,
                    region: self.form.region,
                };
                tiff::write::write(file.file(), shape, rows, &stamp, || samples(next()))
                    .map(|()| file)
            }
        };
        finish(path, written.and_then(|file| complete().map(|()| file)))
    }

    /// The arrays of an NPZ file, in memory. `next` returns the pieces, as for [`Self::write`].
    pub(crate) fn collect(
        &self,
        mut next: impl FnMut() -> Option<Piece>,
    ) -> Result<Vec<NamedArray>, Fault> {
        let Layout::Npy(files) = &self.layout else {
            // Other formats have no arrays.
            return Err(Fault::Stopped);
        };
        let mut arrays = files.arrays.begin().map_err(Fault::Encoding)?;
        for _ in 0..self.pieces() {
            files.arrays.extend(&mut arrays, &samples(next())?);
        }
        Ok(arrays)
    }

    /// Writes a file with a number of pictures to `path`, completely or not at all. `written` is called after each
    /// picture; if it returns `None`, nothing is written.
    ///
    /// The pictures repeat forever, with this number of frames per second, if known.
    pub(crate) fn write_animation(
        &self,
        path: &Path,
        frames: u32,
        frames_per_second: Option<f64>,
        mut next: impl FnMut() -> Option<Piece>,
        mut written: impl FnMut() -> Option<()>,
    ) -> Result<(), Unwritten> {
        let Layout::Png {
            shape,
            animation: Some(format),
            ..
        } = self.layout
        else {
            // Other formats have no animations.
            return Err(Unwritten::Stopped);
        };
        save(path, |mut file| {
            let mut animation = loops::begin(format, &mut file, shape, frames, frames_per_second)?;
            for _ in 0..frames {
                for _ in 0..self.pieces() {
                    animation.add_samples(&samples(next())?)?;
                }
                animation.end_frame()?;
                written().ok_or(Fault::Stopped)?;
            }
            animation.finish()?;
            Ok(file)
        })
    }
}

/// The bytes of a piece of a PNG, of NPY files or of a TIFF.
pub(super) fn samples(piece: Option<Piece>) -> Result<Vec<u8>, Fault> {
    match piece {
        Some(Piece::Samples(samples)) => Ok(samples),
        // Blocks are made for an EXR only.
        Some(Piece::Block(_)) | None => Err(Fault::Stopped),
    }
}

/// The block of a piece of an EXR.
pub(super) fn block(piece: Option<Piece>) -> Result<Chunk, Fault> {
    match piece {
        Some(Piece::Block(block)) => block.map_err(Fault::Encoding),
        // Samples are never left for an EXR.
        Some(Piece::Samples(_)) | None => Err(Fault::Stopped),
    }
}
