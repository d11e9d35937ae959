//! Observations of a cloud's files while they were read.

use std::collections::{BTreeSet, HashMap, HashSet};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};

use crate::table::{FileState, Frames, TableError};
use crate::text::{LocatedFault, Place, harmless};

/// The states of files, and what is left out or in doubt in them.
#[derive(Debug, Default)]
pub(super) struct Observed {
    /// The state of each file when it was opened first.
    states: Mutex<HashMap<PathBuf, FileState>>,
    warnings: Mutex<Warnings>,
    /// The files that were read besides those of the steps.
    others: Mutex<BTreeSet<PathBuf>>,
}

/// Sentences about files.
#[derive(Debug, Default)]
struct Warnings {
    /// All that there ever were: a step may be read several times.
    known: HashSet<String>,
    /// Those that nobody took yet.
    new: Vec<String>,
}

impl Observed {
    /// Refuses a file that is not the one any more that was opened before at `path`.
    pub(super) fn check(&self, path: &Path, frames: &Frames<'_>) -> Result<(), TableError> {
        self.check_state(path, frames.state())
    }

    /// Notes the files that were read besides a table, and refuses one that is not the one any more that was read before.
    pub(super) fn note_others(&self, frames: &mut Frames<'_>) -> Result<(), TableError> {
        for other in frames.take_others() {
            self.check_state(&other.path, other.state)?;
            self.note_doubts(&other.path.display().to_string(), other.doubts);
            self.add_others([other.path]);
        }
        self.add_others(frames.listed_files());
        Ok(())
    }

    fn add_others(&self, paths: impl IntoIterator<Item = PathBuf>) {
        let mut others = self.others.lock().unwrap_or_else(PoisonError::into_inner);
        others.extend(paths);
    }

    /// The files that were read besides those of the steps.
    pub(super) fn others(&self) -> Vec<PathBuf> {
        let others = self.others.lock().unwrap_or_else(PoisonError::into_inner);
        others.iter().cloned().collect()
    }

    fn check_state(&self, path: &Path, state: FileState) -> Result<(), TableError> {
        let mut states = self.states.lock().unwrap_or_else(PoisonError::into_inner);
        match *states.entry(path.to_owned()).or_insert(state) == state {
            true => Ok(()),
            false => Err(TableError::Changed),
        }
    }

    /// Adds sentences, each of them once.
    pub(super) fn warn(&self, warnings: impl IntoIterator<Item = String>) {
        let mut own = self.warnings.lock().unwrap_or_else(PoisonError::into_inner);
        for warning in warnings {
            if own.known.insert(warning.clone()) {
                own.new.push(warning);
            }
        }
    }

    /// Adds what is in doubt in the file that is called `name`.
    pub(super) fn note_doubts(&self, name: &str, doubts: Vec<LocatedFault>) {
        let warning = |doubt: LocatedFault| match doubt.place {
            Place::Text { line, .. } => format!("{}:{line}: {}", harmless(name), doubt.message),
            _ => format!("{}: {}", harmless(name), doubt.message),
        };
        self.warn(doubts.into_iter().map(warning));
    }

    /// The sentences that were added since they were taken.
    pub(super) fn take_warnings(&self) -> Vec<String> {
        let mut own = self.warnings.lock().unwrap_or_else(PoisonError::into_inner);
        std::mem::take(&mut own.new)
    }
}
