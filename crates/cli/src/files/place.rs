//! Where files belong, and the way there by temporary ones.

use std::io;
use std::path::{Path, PathBuf};

use super::temporary::{LeftOver, TemporaryFile};
use crate::base::failure::{Failure, lower};
use crate::formats::{Fault, Unwritten};

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

/// Puts the file that `write` has written where it belongs.
pub(crate) fn save(
    path: &Path,
    write: impl FnOnce(TemporaryFile) -> Result<TemporaryFile, Fault>,
) -> Result<(), Unwritten> {
    let destination = destination(path).map_err(Unwritten::Failed)?;
    finish(path, TemporaryFile::beside(&destination), write)
}

/// As [`save`], by way of `file`.
pub(crate) fn finish(
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
pub(crate) fn destination(path: &Path) -> Result<PathBuf, Failure> {
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
pub(crate) fn folder(path: &Path) -> &Path {
    match path.parent() {
        Some(folder) if !folder.as_os_str().is_empty() => folder,
        _ => Path::new("."),
    }
}
