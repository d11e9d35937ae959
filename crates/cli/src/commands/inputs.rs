//! The input files of a command, which no output may replace.

use std::collections::HashSet;
use std::fs;
use std::path::{Path, PathBuf};

use marbles_scene::Scene;

use crate::base::failure::Failure;

/// The input files.
pub(super) struct Inputs {
    /// Their paths, with symbolic links resolved.
    places: HashSet<PathBuf>,
    /// The reason to refuse an output.
    why: &'static str,
}

impl Inputs {
    /// The scene that was read from `path`, and the tables that it names.
    pub(super) fn of(path: &Path, scene: &Scene) -> Self {
        let files = scene.table_files().into_iter().chain([path.to_owned()]);
        Self {
            places: places(files).collect(),
            why: "the output would replace the scene, or a table that it names",
        }
    }

    /// The parts of a picture.
    pub(super) fn parts(parts: &[PathBuf]) -> Self {
        Self {
            places: places(parts).collect(),
            why: "the output would replace a part",
        }
    }

    /// Refuses outputs that would replace an input file.
    pub(super) fn refuse(&self, outputs: impl IntoIterator<Item = PathBuf>) -> Result<(), Failure> {
        let is_input = |path: &PathBuf| {
            let place = fs::canonicalize(path);
            place.is_ok_and(|place| self.places.contains(&place))
        };
        match outputs.into_iter().find(is_input) {
            Some(path) => Err(Failure::unusable(&path, self.why)),
            None => Ok(()),
        }
    }
}

/// The resolved paths of files. A file that was removed since it was read may be replaced.
fn places(files: impl IntoIterator<Item = impl AsRef<Path>>) -> impl Iterator<Item = PathBuf> {
    let places = files.into_iter().map(fs::canonicalize);
    places.filter_map(Result::ok)
}
