//! The files that a scene is made of, which no output may replace.

use std::collections::HashSet;
use std::fs;
use std::path::{Path, PathBuf};

use marbles_scene::Scene;

use crate::base::failure::Failure;

/// The scene file and the tables that it names.
pub(super) struct Inputs {
    /// At the ends of links.
    places: HashSet<PathBuf>,
}

impl Inputs {
    /// Those of the scene that was read from `path`.
    pub(super) fn of(path: &Path, scene: &Scene) -> Self {
        let files = scene.table_files().into_iter().chain([path.to_owned()]);
        Self {
            // What is gone since it was read can be replaced.
            places: files
                .filter_map(|file| fs::canonicalize(file).ok())
                .collect(),
        }
    }

    /// Refuses outputs that would replace one of them.
    pub(super) fn refuse(&self, outputs: impl IntoIterator<Item = PathBuf>) -> Result<(), Failure> {
        let is_input = |path: &PathBuf| {
            let place = fs::canonicalize(path);
            place.is_ok_and(|place| self.places.contains(&place))
        };
        match outputs.into_iter().find(is_input) {
            Some(path) => {
                let why = "the output would replace the scene, or a table that it names";
                Err(Failure::unusable(&path, why))
            }
            None => Ok(()),
        }
    }
}
