//! The place where a file belongs.

use std::fs;
use std::path::{Path, PathBuf};

use super::standard_output;
use crate::base::failure::Failure;

/// Makes sure that the folder for the file at `path` exists.
pub(crate) fn prepare(path: &Path) -> Result<(), Failure> {
    let destination = destination(path)?;
    let folder = folder(&destination);
    fs::create_dir_all(folder)
        .map_err(|error| Failure::io(folder, "cannot create the folder", &error))
}

/// The destination of the file for `path`: symbolic links are followed and kept, and only a file may be replaced.
pub(super) fn destination(path: &Path) -> Result<PathBuf, Failure> {
    /// The number of links that Linux follows.
    const MOST_LINKS: usize = 40;
    if standard_output::is(path) {
        return Ok(path.to_owned());
    }
    let mut destination = path.to_owned();
    for _ in 0..=MOST_LINKS {
        let Ok(target) = fs::read_link(&destination) else {
            return match fs::metadata(&destination) {
                Ok(found) if found.is_dir() => Err("a folder has this name"),
                Ok(found) if !found.is_file() => Err("something that is not a file has this name"),
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
pub(super) fn folder(path: &Path) -> &Path {
    match path.parent() {
        Some(folder) if !folder.as_os_str().is_empty() => folder,
        _ => Path::new("."),
    }
}

/// Returns whether both paths are the same, or lead to the same existing file.
pub(crate) fn is_same(one: &Path, other: &Path) -> bool {
    let place = |path: &Path| fs::canonicalize(path).ok();
    one == other || place(one).is_some_and(|one| place(other) == Some(one))
}
