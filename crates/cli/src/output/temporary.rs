//! Files that exist under a temporary name until they are complete.

use std::fs::{self, File};
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, MutexGuard, PoisonError};

/// How many left-over files of killed processes with the same id are stepped over.
const ATTEMPTS: u32 = 1000;

/// The temporary files of this process.
static REGISTRY: Mutex<Registry> = Mutex::new(Registry {
    open: Vec::new(),
    closed: false,
});

struct Registry {
    open: Vec<PathBuf>,
    closed: bool,
}

/// A file beside the place where it belongs, removed when it is dropped before its time.
pub(super) struct TemporaryFile<'path> {
    file: File,
    path: PathBuf,
    destination: &'path Path,
}

impl<'path> TemporaryFile<'path> {
    /// Creates the file, named after its destination.
    ///
    /// A file that is already there belongs to a process that was killed, or to one on another
    /// machine that has the same id and still writes: it is left alone.
    pub(super) fn beside(destination: &'path Path) -> io::Result<Self> {
        let process = std::process::id();
        let mut registry = registry();
        for attempt in 0..ATTEMPTS {
            if registry.closed {
                break;
            }
            let mut path = destination.as_os_str().to_owned();
            path.push(match attempt {
                0 => format!(".{process}.tmp"),
                _ => format!(".{process}-{attempt}.tmp"),
            });
            let path = PathBuf::from(path);
            match File::options().write(true).create_new(true).open(&path) {
                Err(error) if error.kind() == io::ErrorKind::AlreadyExists => {}
                Err(error) => return Err(error),
                Ok(file) => {
                    registry.open.push(path.clone());
                    return Ok(Self {
                        file,
                        path,
                        destination,
                    });
                }
            }
        }
        Err(if registry.closed {
            io::Error::new(io::ErrorKind::Interrupted, "interrupted")
        } else {
            io::Error::new(
                io::ErrorKind::AlreadyExists,
                "too many temporary files are in the way",
            )
        })
    }

    pub(super) fn write(&mut self, bytes: &[u8]) -> io::Result<()> {
        self.file.write_all(bytes)
    }

    /// Moves the complete file to its destination, in place of what was there.
    pub(super) fn persist(self) -> io::Result<()> {
        // Without this a crash of the machine could leave the name without the bytes.
        self.file.sync_all()?;
        let _registry = registry();
        fs::rename(&self.path, self.destination)
    }
}

impl Drop for TemporaryFile<'_> {
    fn drop(&mut self) {
        let mut registry = registry();
        registry.open.retain(|path| *path != self.path);
        // After the file was moved there is nothing to remove; otherwise nobody waits for the
        // answer.
        let _ = fs::remove_file(&self.path);
    }
}

/// Removes all temporary files and lets no more appear: the process is about to end.
pub(crate) fn abandon_all() {
    let mut registry = registry();
    registry.closed = true;
    for path in registry.open.drain(..) {
        // What cannot be removed stays; there is nobody left to tell.
        let _ = fs::remove_file(path);
    }
}

fn registry() -> MutexGuard<'static, Registry> {
    // The list of paths is valid after every step, so that a panic elsewhere does not spoil it.
    REGISTRY.lock().unwrap_or_else(PoisonError::into_inner)
}
