//! The state of a file, which tells whether it is still the one that was read.

use std::fs::{self, Metadata};
use std::io;
use std::path::Path;
use std::time::SystemTime;

/// The size, the time of the last change and the identity of a file; one that was written over or replaced differs in
/// one of them.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub(crate) struct FileState {
    /// The bytes of the file.
    pub(crate) size: u64,
    changed: Option<SystemTime>,
    /// Device and inode.
    identity: (u64, u64),
}

impl FileState {
    /// The state of the file at `path`.
    ///
    /// # Errors
    /// Refuses folders, and what cannot be read twice, as pipes: tables are.
    pub(crate) fn of(path: &Path) -> io::Result<Self> {
        let metadata = fs::metadata(path)?;
        if metadata.is_dir() {
            return Err(io::ErrorKind::IsADirectory.into());
        }
        if !metadata.is_file() {
            let message = "it is a pipe or a device, but marbles reads tables more than once: save it as a file";
            return Err(io::Error::other(message));
        }
        Ok(Self {
            size: metadata.len(),
            changed: metadata.modified().ok(),
            identity: identity(&metadata),
        })
    }

    /// The state of a table of so many bytes in memory, which does not change.
    pub(super) fn in_memory(size: u64) -> Self {
        Self {
            size,
            changed: None,
            identity: (0, 0),
        }
    }
}

#[cfg(unix)]
fn identity(metadata: &Metadata) -> (u64, u64) {
    use std::os::unix::fs::MetadataExt;
    (metadata.dev(), metadata.ino())
}

#[cfg(not(unix))]
fn identity(_: &Metadata) -> (u64, u64) {
    (0, 0)
}
