//! Files that are read besides the table that the scene names.

use std::path::PathBuf;

use super::file_state::FileState;
use crate::text::LocatedFault;

/// The name of another file, and where it is.
#[derive(Clone, Debug)]
pub(crate) struct OtherName {
    pub(crate) name: String,
    pub(crate) path: PathBuf,
}

/// A file that was read besides a table.
#[derive(Clone, Debug)]
pub(crate) struct OtherFile {
    pub(crate) path: PathBuf,
    /// The state of the file when it was opened.
    pub(crate) state: FileState,
    /// Possible faults in it, and what is left out of it.
    pub(crate) doubts: Vec<LocatedFault>,
}
