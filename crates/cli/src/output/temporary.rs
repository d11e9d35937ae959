//! Files that exist under a temporary name until they are complete.

use std::ffi::OsString;
use std::fs::{self, File};
use std::io;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, MutexGuard, PoisonError};

/// The longest names, in bytes, that common file systems take.
const LONGEST_NAME: usize = 255;
/// How many left-over files of killed processes with the same id are stepped over.
const ATTEMPTS: u32 = 1000;

/// The temporary files of this process; whoever holds the lock knows that none appears or moves.
static OPEN: Mutex<Vec<PathBuf>> = Mutex::new(Vec::new());

/// A file beside the place where it belongs, removed when it is dropped before its time.
pub(super) struct TemporaryFile<'path> {
    file: File,
    path: PathBuf,
    destination: &'path Path,
}

impl<'path> TemporaryFile<'path> {
    /// Creates the file, named after its destination, with a shorter stem where there is no room.
    ///
    /// A file that is already there belongs to a process that was killed, or to one on another
    /// machine that has the same id and still writes: it is left alone.
    pub(super) fn beside(destination: &'path Path) -> io::Result<Self> {
        let process = std::process::id();
        let mut open = lock();
        for attempt in 0..ATTEMPTS {
            let ending = match attempt {
                0 => format!(".{process}.tmp"),
                _ => format!(".{process}-{attempt}.tmp"),
            };
            let path = with_ending(destination, &ending);
            let mut options = File::options();
            match options.read(true).write(true).create_new(true).open(&path) {
                Err(error) if error.kind() == io::ErrorKind::AlreadyExists => {}
                Err(error) => return Err(error),
                Ok(file) => {
                    open.push(path.clone());
                    return Ok(Self {
                        file,
                        path,
                        destination,
                    });
                }
            }
        }
        Err(io::Error::new(
            io::ErrorKind::AlreadyExists,
            "too many temporary files are in the way",
        ))
    }

    /// Another file for the same place.
    pub(super) fn another(&self) -> io::Result<Self> {
        Self::beside(self.destination)
    }

    /// What is to be read from and written to.
    pub(super) fn file(&mut self) -> &mut File {
        &mut self.file
    }

    /// Moves the complete file to its destination, in place of what was there.
    pub(super) fn persist(self) -> io::Result<()> {
        // Without this a crash of the machine could leave the name without the bytes.
        self.file.sync_all()?;
        let mut open = lock();
        fs::rename(&self.path, self.destination)?;
        open.retain(|path| *path != self.path);
        Ok(())
    }
}

impl Drop for TemporaryFile<'_> {
    fn drop(&mut self) {
        let mut open = lock();
        if let Some(index) = open.iter().position(|path| *path == self.path) {
            open.swap_remove(index);
            // Nobody waits for the answer.
            let _ = fs::remove_file(&self.path);
        }
    }
}

/// The path with an ending added to its name, which is cut at the end of a character where the
/// whole would be too long.
fn with_ending(path: &Path, ending: &str) -> PathBuf {
    let name = path.file_name().unwrap_or_default();
    let room = LONGEST_NAME.saturating_sub(ending.len());
    let mut name = if name.len() <= room {
        name.to_owned()
    } else {
        let name = name.to_string_lossy();
        let characters = name.char_indices();
        let ends = characters.map(|(start, character)| start + character.len_utf8());
        let end = ends.take_while(|&end| end <= room).last().unwrap_or(0);
        OsString::from(&name[..end])
    };
    name.push(ending);
    path.with_file_name(name)
}

/// Removes all temporary files; as long as the answer lives, no file appears or moves.
pub(crate) fn abandon_all() -> impl Sized {
    let mut open = lock();
    for path in open.drain(..) {
        // What cannot be removed stays; there is nobody left to tell.
        let _ = fs::remove_file(path);
    }
    open
}

fn lock() -> MutexGuard<'static, Vec<PathBuf>> {
    // The list is valid after every step, so that a panic elsewhere does not spoil it.
    OPEN.lock().unwrap_or_else(PoisonError::into_inner)
}

#[cfg(test)]
mod tests {
    use std::io::Write;

    use super::*;

    /// A file name in the tests' own folder that no other test uses.
    fn destination(name: &str) -> PathBuf {
        let process = std::process::id();
        std::env::temp_dir().join(format!("marbles-{process}-{name}"))
    }

    #[test]
    fn files_appear_when_they_are_complete() {
        let destination = destination("complete");
        let mut file = TemporaryFile::beside(&destination).unwrap();
        let path = file.path.clone();
        file.file().write_all(b"marbles").unwrap();
        assert!(path.exists() && !destination.exists());
        file.persist().unwrap();
        assert!(!path.exists());
        assert_eq!(fs::read(&destination).unwrap(), b"marbles");
        fs::remove_file(destination).unwrap();
    }

    #[test]
    fn unfinished_files_are_removed() {
        let destination = destination("unfinished");
        let file = TemporaryFile::beside(&destination).unwrap();
        let path = file.path.clone();
        assert!(path.exists());
        drop(file);
        assert!(!path.exists() && !destination.exists());
    }

    #[test]
    fn names_are_cut_between_characters() {
        let long = "ö".repeat(LONGEST_NAME / 2);
        let path = with_ending(&Path::new("folder").join(&long), ".7.tmp");
        // 249 bytes are left, and 248 are filled.
        let expected = format!("{}.7.tmp", &long[..248]);
        assert_eq!(path, Path::new("folder").join(expected));
        assert_eq!(
            with_ending(Path::new("a.png"), ".7.tmp"),
            Path::new("a.png.7.tmp")
        );
    }

    #[test]
    fn files_of_others_are_stepped_over() {
        let destination = destination("others");
        let first = TemporaryFile::beside(&destination).unwrap();
        let second = TemporaryFile::beside(&destination).unwrap();
        assert_ne!(first.path, second.path);
        assert!(first.path.exists() && second.path.exists());
    }
}
