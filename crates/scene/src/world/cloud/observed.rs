//! Observations of a cloud's files while they were read.

use std::collections::{HashMap, HashSet};
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
        let mut states = self.states.lock().unwrap_or_else(PoisonError::into_inner);
        let first = *states.entry(path.to_owned()).or_insert(frames.state());
        match first == frames.state() {
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
