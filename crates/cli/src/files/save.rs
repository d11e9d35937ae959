//! Saves files through temporary files.

use std::io::{self, Write};
use std::path::Path;

use super::destination::destination;
use super::temporary::{LeftOver, TemporaryFile};
use crate::base::failure::{Failure, lower};

/// A reason why a file was not written.
#[derive(Debug)]
pub(crate) enum Unwritten {
    Failed(Failure),
    /// The remaining parts of the picture will not come.
    Stopped,
}

/// A reason why something could not be encoded or written, before the file is known.
#[derive(Debug)]
pub(crate) enum Fault {
    Io(io::Error),
    Encoding(String),
    /// Another file is the cause.
    Failed(Failure),
    /// See [`Unwritten`].
    Stopped,
}

impl From<Unwritten> for Failure {
    fn from(unwritten: Unwritten) -> Self {
        match unwritten {
            Unwritten::Failed(failure) => failure,
            Unwritten::Stopped => Self::Work("the picture is not complete".to_owned()),
        }
    }
}

impl From<io::Error> for Fault {
    fn from(error: io::Error) -> Self {
        Self::Io(error)
    }
}

/// Begins a file for `path`.
pub(crate) fn begin(path: &Path) -> Result<TemporaryFile, Failure> {
    TemporaryFile::beside(&destination(path)?).map_err(|error| uncreated(path, &error))
}

/// Begins a file for `path` unless another running process is writing it.
pub(crate) fn claim(path: &Path) -> Result<Option<TemporaryFile>, Failure> {
    TemporaryFile::claim(&destination(path)?).map_err(|error| uncreated(path, &error))
}

/// Removes the temporary files that killed processes left for `path`.
pub(crate) fn clean(path: &Path, left_over: &mut LeftOver) {
    if let Ok(destination) = destination(path) {
        left_over.remove(&destination);
    }
}

fn uncreated(path: &Path, error: &io::Error) -> Failure {
    Failure::io(path, "cannot create the file", error)
}

/// Writes a file that is not a picture, or is already encoded.
pub(crate) fn write_bytes(bytes: &[u8], path: &Path) -> Result<(), Failure> {
    Ok(save(path, |mut file| {
        file.file().write_all(bytes)?;
        Ok(file)
    })?)
}

/// Moves the file that `write` has written to its destination.
pub(crate) fn save(
    path: &Path,
    write: impl FnOnce(TemporaryFile) -> Result<TemporaryFile, Fault>,
) -> Result<(), Unwritten> {
    let destination = destination(path).map_err(Unwritten::Failed)?;
    let file = TemporaryFile::beside(&destination).map_err(Fault::Io);
    finish(path, file.and_then(write))
}

/// Moves a file that was written for `path` to its destination.
pub(crate) fn finish(path: &Path, written: Result<TemporaryFile, Fault>) -> Result<(), Unwritten> {
    let moved = written.and_then(|file| Ok(file.persist()?));
    moved.map_err(|fault| match fault {
        Fault::Io(error) => Unwritten::Failed(Failure::io(path, "cannot write the file", &error)),
        Fault::Encoding(error) => {
            let message = format!("cannot encode the picture: {}", lower(&error));
            Unwritten::Failed(Failure::at(path, &message))
        }
        Fault::Failed(failure) => Unwritten::Failed(failure),
        Fault::Stopped => Unwritten::Stopped,
    })
}
