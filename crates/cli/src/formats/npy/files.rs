//! The files of a picture: an array of its light, and additional arrays.
//!
//! `a.npy` contains the light. `a_error.npy`, `a_channels.npy`, `a_id.npy` and `a_coverage_id.npy` are optional
//! additional files. The rows of all arrays arrive together, strip by strip. The file of the light gets its final name
//! last. `a.npz` contains all arrays, with names.

use std::ffi::OsString;
use std::io::Write;
use std::path::{Path, PathBuf};

use blake3::{Hash, Hasher};

use super::arrays::{Arrays, CHANNELS, COVERAGE_ID, ERROR, ID, Part};
use super::header;
use super::npz::Archive;
use super::stamp::Stamp;
use crate::base::failure::Failure;
use crate::files::save::{self, Fault};
use crate::files::temporary::TemporaryFile;
use crate::formats::encoding::NpyOptions;
use crate::formats::form::Form;

/// The context of the digest of an additional file.
const PURPOSE: &str = "marbles 2026-11-23 (3) digest of an array beside a picture";

/// The arrays of a picture, and whether they are members of one file.
#[derive(Clone, Debug)]
pub(crate) struct Files {
    pub(crate) arrays: Arrays,
    is_archive: bool,
}

impl Files {
    /// The files of a picture of this form.
    pub(crate) fn new(form: &Form, options: NpyOptions) -> Self {
        let is_archive = options.archive;
        let arrays = match is_archive {
            true => Arrays::for_archive(form, options),
            false => Arrays::for_files(form, options),
        };
        Self { arrays, is_archive }
    }

    /// The files of the picture whose light is at `path`, and the digests that they contain if that of the light is
    /// `digest`.
    pub(crate) fn digests(&self, path: &Path, digest: &Hash) -> Vec<(PathBuf, Hash)> {
        if self.is_archive {
            return vec![(path.to_owned(), *digest)];
        }
        let of = |part: &Part| (beside(path, &part.name), digest_of(digest, &part.name));
        self.arrays.all.iter().map(of).collect()
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
        if self.is_archive {
            return self.write_archive(file, digest, strips, next);
        }
        let mut files = vec![(path.to_owned(), file)];
        for part in &self.arrays.all[1..] {
            let path = beside(path, &part.name);
            let file = save::begin(&path).map_err(Fault::Failed)?;
            files.push((path, file));
        }
        for (part, (path, file)) in self.arrays.all.iter().zip(&mut files) {
            let stamp = Stamp {
                digest: digest_of(digest, &part.name),
                region: self.arrays.region,
            };
            write_bytes(path, file, &header::bytes(&part.array, Some(&stamp)))?;
        }
        for _ in 0..strips {
            let samples = next()?;
            let rows = samples.len() / self.arrays.row_bytes();
            let mut rest = &samples[..];
            for (part, (path, file)) in self.arrays.all.iter().zip(&mut files) {
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

    /// The same for arrays that are members of one file. The first one, the light, contains the digest.
    fn write_archive(
        &self,
        mut file: TemporaryFile,
        digest: &Hash,
        strips: u32,
        mut next: impl FnMut() -> Result<Vec<u8>, Fault>,
    ) -> Result<TemporaryFile, Fault> {
        let stamp = Stamp {
            digest: *digest,
            region: self.arrays.region,
        };
        let mut archive = Archive::default();
        for (index, part) in self.arrays.all.iter().enumerate() {
            let header = header::bytes(&part.array, (index == 0).then_some(&stamp));
            let bytes = part.array.bytes();
            let bytes = bytes.ok_or_else(|| Fault::Encoding("it is too large".to_owned()))?;
            archive.add(file.file(), &part.name, &header, bytes)?;
        }
        for _ in 0..strips {
            let samples = next()?;
            let rows = samples.len() / self.arrays.row_bytes();
            let mut rest = &samples[..];
            for (index, part) in self.arrays.all.iter().enumerate() {
                let (own, others) = rest.split_at(rows * part.array.row_bytes());
                rest = others;
                archive.extend(file.file(), index, own)?;
            }
        }
        archive.finish(file.file())?;
        Ok(file)
    }
}

/// The additional files that may exist for the light at `path`, with these options.
pub(crate) fn names_beside(path: &Path, options: NpyOptions, has_centers: bool) -> Vec<PathBuf> {
    if options.archive {
        return Vec::new();
    }
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
