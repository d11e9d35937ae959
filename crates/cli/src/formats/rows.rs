//! Reads and writes files row by row, in the same kind of file.

use std::fs::File;
use std::ops::Range;
use std::path::Path;

use ::exr::meta::header::Header;
use blake3::Hash;
use marbles_core::Rendering;

use super::encoding::Format;
use super::exr::header::add_achieved;
use super::exr::write::{header_like, write_rows};
use super::npy::array::Array;
use super::npy::stamp::Stamp;
use super::npy::write::write_array;
use super::png::shape::Shape;
use super::png::write::{texts, write};
use super::{exr, npy, png, tiff};
use crate::base::failure::{Failure, lower};
use crate::base::region::Region;
use crate::base::size::Size;
use crate::files::save::{Fault, save};

/// The kind of a file: its format, and the kind of its samples.
#[derive(Clone)]
pub(crate) enum Kind {
    Png(Shape),
    Exr(Box<Header>),
    Npy(Array),
    Tiff(tiff::shape::Shape),
}

/// A file that is being read.
pub(crate) enum RowReader {
    Png(Box<png::rows::Rows>),
    Exr(Box<exr::rows::Rows>),
    Npy(Box<npy::rows::Rows>),
    Tiff(Box<tiff::rows::Rows>),
}

impl Kind {
    pub(crate) fn format(&self) -> Format {
        match self {
            Self::Png(_) => Format::Png,
            Self::Exr(_) => Format::Exr,
            Self::Npy(_) => Format::Npy,
            Self::Tiff(_) => Format::Tiff,
        }
    }

    /// Adds the metadata from the header of another part of the same picture.
    pub(crate) fn add(&mut self, other: &Self) {
        if let (Self::Exr(header), Self::Exr(other)) = (self, other) {
            add_achieved(&mut header.own_attributes, &other.own_attributes);
        }
    }

    /// Bytes per sample: of a whole pixel in a PNG, NPY or TIFF; of a channel in an EXR, whose rows store one channel after
    /// the other.
    pub(crate) fn sample_bytes(&self) -> Vec<usize> {
        match self {
            Self::Png(shape) => vec![shape.pixel_bytes()],
            Self::Npy(array) => vec![array.pixel_bytes()],
            Self::Tiff(shape) => vec![shape.pixel_bytes()],
            Self::Exr(header) => {
                let channels = header.channels.list.iter();
                channels
                    .map(|channel| channel.sample_type.bytes_per_sample())
                    .collect()
            }
        }
    }

    /// Writes a picture with this digest, completely or not at all; `samples` returns those of some rows.
    pub(crate) fn write(
        &self,
        path: &Path,
        size: Size,
        digest: &Hash,
        mut samples: impl FnMut(Range<u32>) -> Result<Vec<u8>, Failure>,
    ) -> Result<(), Failure> {
        /// The number of rows that are requested together.
        const ROWS: u32 = 16;
        let mut samples = |rows| samples(rows).map_err(Fault::Failed);
        let saved = match self {
            Self::Png(shape) => save(path, |file| {
                let texts = texts(digest, &Region::all(size));
                write(file, shape.resized(size), &texts, |stream| {
                    for first in (0..size.height).step_by(ROWS as usize) {
                        stream.write_all(&samples(first..size.height.min(first + ROWS))?)?;
                    }
                    Ok(())
                })
            }),
            Self::Exr(header) => save(path, |mut file| {
                let samples = |rows| samples(rows).map(Some);
                write_rows(file.file(), header_like(header, size), samples)?;
                Ok(file)
            }),
            Self::Npy(array) => {
                let stamp = Stamp {
                    digest: *digest,
                    region: Region::all(size),
                };
                write_array(path, &array.resized(size), Some(&stamp), samples)
            }
            Self::Tiff(shape) => save(path, |mut file| {
                let shape = shape.resized(size);
                let stamp = Stamp {
                    digest: *digest,
                    region: Region::all(size),
                };
                let mut strips = (0..size.height).step_by(Rendering::ROW_STEP as usize);
                let next = || {
                    let first = strips.next().unwrap_or_default();
                    let rows = first..size.height.min(first + Rendering::ROW_STEP);
                    Ok(shape.compress(samples(rows)?))
                };
                tiff::write::write(file.file(), shape, Rendering::ROW_STEP, &stamp, next)?;
                Ok(file)
            }),
        };
        Ok(saved?)
    }
}

impl RowReader {
    /// Begins to read the file at `path`.
    pub(crate) fn open(path: &Path) -> Result<Self, String> {
        let file = || File::open(path).map_err(|error| lower(&error.to_string()));
        let opened = match Format::of_file(path) {
            Some(Format::Png) => {
                let rows = png::rows::Rows::begin(file()?).map(Box::new);
                rows.map(Self::Png).map_err(|error| error.to_string())
            }
            Some(Format::Exr) => {
                let rows = exr::rows::Rows::begin(file()?).map(Box::new);
                rows.map(Self::Exr).map_err(|error| error.to_string())
            }
            Some(Format::Npy) => npy::rows::Rows::begin(file()?).map(Box::new).map(Self::Npy),
            Some(Format::Tiff) => tiff::rows::Rows::begin(file()?)
                .map(Box::new)
                .map(Self::Tiff),
            Some(Format::Animation(_) | Format::Npz) | None => {
                return Err("expected a file name that ends in .png, .exr, .npy or .tif".to_owned());
            }
        };
        opened.map_err(|error| lower(&error))
    }

    pub(crate) fn kind(&self) -> Kind {
        match self {
            Self::Png(rows) => Kind::Png(rows.shape()),
            Self::Exr(rows) => Kind::Exr(Box::new(rows.header().clone())),
            Self::Npy(rows) => Kind::Npy(rows.array()),
            Self::Tiff(rows) => Kind::Tiff(rows.shape()),
        }
    }

    /// The samples of the next row.
    pub(crate) fn next_row(&mut self) -> Result<&[u8], String> {
        let row = match self {
            Self::Png(rows) => rows.next().map_err(|error| error.to_string()),
            Self::Exr(rows) => rows.next().map_err(|error| error.to_string()),
            Self::Npy(rows) => rows.next().map_err(|error| error.to_string()),
            Self::Tiff(rows) => rows.next(),
        };
        Ok(row?.ok_or("it ends early")?)
    }
}
