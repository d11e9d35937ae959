//! The files of a picture: an array of its light, and additional arrays.
//!
//! `a.npy` contains the light. `a_error.npy`, `a_channels.npy`, `a_id.npy` and `a_coverage_id.npy` are optional
//! additional files. The rows of all arrays arrive together, strip by strip. The file of the light gets its final name
//! last.

use std::ffi::OsString;
use std::io::Write;
use std::ops::Range;
use std::path::{Path, PathBuf};

use blake3::{Hash, Hasher};
use marbles_core::{Geometry, Image};

use super::array::{Array, Number};
use super::header;
use super::stamp::Stamp;
use crate::base::failure::Failure;
use crate::base::region::Region;
use crate::files::save::{self, Fault};
use crate::files::temporary::TemporaryFile;
use crate::formats::center_channels::{CenterChannels, Source};
use crate::formats::encoding::NpyOptions;
use crate::formats::form::Form;

/// The context of the digest of an additional file.
const PURPOSE: &str = "marbles 2026-11-23 (3) digest of an array beside a picture";

/// The suffix of the name of a file of errors.
const ERROR: &str = "_error";

/// The suffix of the file of center values, except for the indices of spheres, which have a file of their own.
const CHANNELS: &str = "_channels";
const ID: &str = "_id";
const COVERAGE_ID: &str = "_coverage_id";

/// The arrays of a picture, each of which becomes a file.
#[derive(Clone, Debug)]
pub(crate) struct Files {
    region: Region,
    /// The light, then the additional arrays.
    arrays: Vec<Part>,
    /// The number of numbers per pixel in the channels.
    centers: Vec<Source>,
}

/// An array, and the suffix of its file name.
#[derive(Clone, Copy, Debug)]
struct Part {
    suffix: &'static str,
    array: Array,
}

impl Files {
    /// The arrays of a picture of this form: red, green and blue, alpha if the picture has it, and on request the
    /// errors and the center values. Gray pictures have three colors as well, so that the shape does not depend on the
    /// scene.
    pub(crate) fn new(form: &Form, options: NpyOptions) -> Self {
        let part = |suffix, channels| Part {
            suffix,
            array: Array {
                size: form.region.size(),
                channels,
                number: Number::F64,
            },
        };
        let mut arrays = vec![part("", Some(3 + u32::from(form.alpha)))];
        if options.error {
            arrays.push(part(ERROR, None));
        }
        let sources = form.centers.iter().flat_map(CenterChannels::list);
        let sources: Vec<Source> = sources.map(|(_, source)| source).collect();
        let is_number = |source: &Source| !source.is_index();
        let centers: Vec<Source> = sources.iter().copied().filter(is_number).collect();
        if !centers.is_empty() {
            arrays.push(part(CHANNELS, Some(centers.len() as u32)));
        }
        for (source, suffix) in [(Source::Id, ID), (Source::CoverageId, COVERAGE_ID)] {
            if sources.contains(&source) {
                let mut ids = part(suffix, None);
                ids.array.number = Number::U32;
                arrays.push(ids);
            }
        }
        Self {
            region: form.region,
            arrays,
            centers,
        }
    }

    /// Bytes of a row in all arrays together.
    pub(crate) fn row_bytes(&self) -> usize {
        self.arrays.iter().map(|part| part.array.row_bytes()).sum()
    }

    /// Copies the numbers of rows of an image to their positions in `samples`, starting at the column `col`. The
    /// samples cover the same rows, array by array.
    pub(crate) fn encode(&self, samples: &mut [u8], col: u32, image: &Image, rows: Range<u32>) {
        let mut rest = samples;
        for part in &self.arrays {
            let array = part.array;
            let (own, others) = rest.split_at_mut(array.row_bytes() * rows.len());
            rest = others;
            if [CHANNELS, ID, COVERAGE_ID].contains(&part.suffix) {
                continue;
            }
            let first = col as usize * array.pixel_bytes();
            let length = image.width() as usize * array.pixel_bytes();
            for (row, numbers) in rows.clone().zip(own.chunks_exact_mut(array.row_bytes())) {
                let numbers = &mut numbers[first..first + length];
                let pixels = numbers.chunks_exact_mut(array.pixel_bytes());
                for (col, pixel) in (0..).zip(pixels) {
                    let (numbers, _) = pixel.as_chunks_mut();
                    if part.suffix == ERROR {
                        numbers[0] = image.error(col, row).to_le_bytes();
                        continue;
                    }
                    for (number, value) in numbers.iter_mut().zip(image.rgba(col, row)) {
                        *number = value.to_le_bytes();
                    }
                }
            }
        }
    }

    /// Copies the center values of rows of pixels to their positions, like [`Self::encode`] for light.
    pub(crate) fn encode_geometry(&self, samples: &mut [u8], col: u32, geometry: &Geometry) {
        let mut rest = samples;
        for part in &self.arrays {
            let array = part.array;
            let length = array.row_bytes() * geometry.height() as usize;
            let (own, others) = rest.split_at_mut(length);
            rest = others;
            let first = col as usize * array.pixel_bytes();
            let length = geometry.width() as usize * array.pixel_bytes();
            for (row, numbers) in (0..).zip(own.chunks_exact_mut(array.row_bytes())) {
                let numbers = &mut numbers[first..first + length];
                match part.suffix {
                    ID => put_indices(numbers, geometry.ids(row)),
                    COVERAGE_ID => {
                        let ids = geometry.coverage_ids(row);
                        put_indices(numbers, ids.into_iter().flatten());
                    }
                    CHANNELS => self.encode_centers(numbers, geometry, row),
                    _ => {}
                }
            }
        }
    }

    /// Copies the numbers of the centers of a row of pixels to their positions, pixel by pixel.
    fn encode_centers(&self, numbers: &mut [u8], geometry: &Geometry, row: u32) {
        let (numbers, _) = numbers.as_chunks_mut();
        for (place, source) in self.centers.iter().enumerate() {
            let own = numbers.iter_mut().skip(place).step_by(self.centers.len());
            match *source {
                Source::Value(quantity, component) => {
                    let values = geometry.values(quantity, component, row);
                    for (number, value) in own.zip(values.into_iter().flatten()) {
                        *number = value.to_le_bytes();
                    }
                }
                Source::Average(average, component) => {
                    let values = geometry.averages(average, component, row);
                    for (number, value) in own.zip(values.into_iter().flatten()) {
                        *number = value.to_le_bytes();
                    }
                }
                Source::Id | Source::CoverageId | Source::Mask => {
                    for (number, id) in own.zip(geometry.ids(row)) {
                        let mask = f64::from(u8::from(id != Geometry::NOTHING));
                        *number = mask.to_le_bytes();
                    }
                }
            }
        }
    }

    /// The files of the picture whose light is at `path`, and the digests that they contain if that of the light is
    /// `digest`.
    pub(crate) fn digests(&self, path: &Path, digest: &Hash) -> Vec<(PathBuf, Hash)> {
        let of = |part: &Part| (beside(path, part.suffix), digest_of(digest, part.suffix));
        self.arrays.iter().map(of).collect()
    }

    /// Writes the files of a picture, with the light in `file`. `next` returns the samples of the strips from the top
    /// downward; there are `strips` of them.
    pub(crate) fn write(
        &self,
        path: &Path,
        file: TemporaryFile,
        digest: &Hash,
        strips: u32,
        mut next: impl FnMut() -> Result<Vec<u8>, Fault>,
    ) -> Result<TemporaryFile, Fault> {
        let mut files = vec![(path.to_owned(), file)];
        for part in &self.arrays[1..] {
            let path = beside(path, part.suffix);
            let file = save::begin(&path).map_err(Fault::Failed)?;
            files.push((path, file));
        }
        for (part, (path, file)) in self.arrays.iter().zip(&mut files) {
            let stamp = Stamp {
                digest: digest_of(digest, part.suffix),
                region: self.region,
            };
            write_bytes(path, file, &header::bytes(&part.array, Some(&stamp)))?;
        }
        for _ in 0..strips {
            let samples = next()?;
            let rows = samples.len() / self.row_bytes();
            let mut rest = &samples[..];
            for (part, (path, file)) in self.arrays.iter().zip(&mut files) {
                let (own, others) = rest.split_at(rows * part.array.row_bytes());
                rest = others;
                write_bytes(path, file, own)?;
            }
        }
        let mut files = files.into_iter();
        let (_, light) = files.next().ok_or(Fault::Stopped)?;
        for (path, file) in files {
            save::finish(&path, Ok(file)).map_err(|unwritten| Fault::Failed(unwritten.into()))?;
        }
        Ok(light)
    }
}

/// Copies the indices of spheres to their positions.
fn put_indices(numbers: &mut [u8], ids: impl Iterator<Item = u32>) {
    let (numbers, _) = numbers.as_chunks_mut();
    for (number, id) in numbers.iter_mut().zip(ids) {
        *number = id.to_le_bytes();
    }
}

/// The additional files that may exist for the light at `path`, with these options.
pub(crate) fn names_beside(path: &Path, options: NpyOptions, has_centers: bool) -> Vec<PathBuf> {
    let errors = [ERROR].into_iter().filter(|_| options.error);
    let centers = [CHANNELS, ID, COVERAGE_ID].into_iter();
    let names = errors.chain(centers.filter(|_| has_centers));
    names.map(|suffix| beside(path, suffix)).collect()
}

/// The path of an additional file.
fn beside(path: &Path, suffix: &str) -> PathBuf {
    if suffix.is_empty() {
        return path.to_owned();
    }
    let mut name = OsString::from(path.file_stem().unwrap_or_default());
    name.push(suffix);
    if let Some(ending) = path.extension() {
        name.push(".");
        name.push(ending);
    }
    path.with_file_name(name)
}

/// The digest of an additional file. It differs from that of the light, so that parts of different files cannot be
/// merged.
fn digest_of(digest: &Hash, suffix: &str) -> Hash {
    if suffix.is_empty() {
        return *digest;
    }
    let mut hasher = Hasher::new_derive_key(PURPOSE);
    hasher.update(digest.as_bytes());
    hasher.update(suffix.as_bytes());
    hasher.finalize()
}

/// Writes some bytes. An error contains the name of the file.
fn write_bytes(path: &Path, file: &mut TemporaryFile, bytes: &[u8]) -> Result<(), Fault> {
    let written = file.file().write_all(bytes);
    written.map_err(|error| Fault::Failed(Failure::io(path, "cannot write the file", &error)))
}

#[cfg(test)]
mod tests;
