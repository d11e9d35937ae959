//! Files that exist under a temporary name until they are complete.
//!
//! `a.png` is written as `a.png.tmp`, or as `a.png.1.tmp` by a second process at the same time. The process that writes
//! a file holds a lock on it, which ends with the process in any case. So a file that is not locked is left over from a
//! killed process, and may be removed. Only the process with the lock removes or moves a file, so that its name cannot
//! refer to another file meanwhile.

use std::collections::HashMap;
use std::ffi::{OsStr, OsString};
use std::fs::{self, File};
use std::io::{self, ErrorKind, Read, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, MutexGuard, PoisonError, TryLockError};
use std::time::Duration;
use std::{mem, thread};

use super::standard_output;

/// The length of the longest file names, in bytes, on common file systems.
const LONGEST_NAME: usize = 255;
/// Bytes reserved for the suffix.
const LONGEST_ENDING: usize = 16;
const ENDING: &str = ".tmp";
/// The largest number of other processes that may write the same file.
const MOST_OTHERS: u32 = 1000;

/// The temporary files of this process. While a thread holds the lock, no such file appears or moves.
static OPEN: Mutex<Vec<PathBuf>> = Mutex::new(Vec::new());

/// A file in the folder of its destination, or, for the standard output, in that of the system. It is removed if it is
/// dropped before it is complete.
#[derive(Debug)]
pub(crate) struct TemporaryFile {
    /// Locked, if the file system supports locks.
    file: File,
    path: PathBuf,
    destination: PathBuf,
}

impl TemporaryFile {
    /// Creates the file, named after its destination; the name is shortened if it would be too long.
    pub(crate) fn beside(destination: &Path) -> io::Result<Self> {
        for number in 0..MOST_OTHERS {
            if let Some(file) = Self::numbered(destination, number)? {
                return Ok(file);
            }
        }
        let message = "too many temporary files exist already";
        Err(io::Error::new(ErrorKind::AlreadyExists, message))
    }

    /// Creates the file unless another process is writing the same destination.
    pub(crate) fn claim(destination: &Path) -> io::Result<Option<Self>> {
        Self::numbered(destination, 0)
    }

    fn numbered(destination: &Path, number: u32) -> io::Result<Option<Self>> {
        let place = match standard_output::is(destination) {
            true => standard_output::temporary_path(),
            false => destination.to_owned(),
        };
        let mut name = stem(&place);
        if number > 0 {
            name.push(format!(".{number}"));
        }
        name.push(ENDING);
        let path = place.with_file_name(name);
        let mut open = lock();
        let Some(file) = create(&path)? else {
            return Ok(None);
        };
        open.push(path.clone());
        Ok(Some(Self {
            file,
            path,
            destination: destination.to_owned(),
        }))
    }

    /// Another file for the same destination.
    pub(crate) fn another(&self) -> io::Result<Self> {
        Self::beside(&self.destination)
    }

    /// The file, for reading and writing.
    pub(crate) fn file(&mut self) -> &mut File {
        &mut self.file
    }

    /// Moves the complete file to its destination, and replaces the previous file, or copies it to the standard output.
    pub(crate) fn persist(mut self) -> io::Result<()> {
        if standard_output::is(&self.destination) {
            return standard_output::copy(&mut self.file);
        }
        // Without this a crash of the machine could leave the name without the bytes.
        self.file.sync_all()?;
        let mut open = lock();
        fs::rename(&self.path, &self.destination)?;
        open.retain(|path| *path != self.path);
        Ok(())
    }
}

impl Read for TemporaryFile {
    fn read(&mut self, bytes: &mut [u8]) -> io::Result<usize> {
        self.file.read(bytes)
    }
}

impl Write for TemporaryFile {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.file.write(bytes)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.file.flush()
    }
}

impl Seek for TemporaryFile {
    fn seek(&mut self, place: SeekFrom) -> io::Result<u64> {
        self.file.seek(place)
    }
}

impl Drop for TemporaryFile {
    fn drop(&mut self) {
        let mut open = lock();
        if let Some(index) = open.iter().position(|path| *path == self.path) {
            open.swap_remove(index);
            // No caller waits for the answer.
            let _ = fs::remove_file(&self.path);
        }
    }
}

/// Creates a file and locks it. `None` if a file exists that is not left over.
fn create(path: &Path) -> io::Result<Option<File>> {
    /// Each failure because of another process means that the other process made progress.
    const ATTEMPTS: u32 = 10;
    for _ in 0..ATTEMPTS {
        let mut options = File::options();
        match options.read(true).write(true).create_new(true).open(path) {
            Ok(file) => match file.try_lock() {
                // Another process took it for left over.
                Err(fs::TryLockError::WouldBlock) => {}
                Ok(()) if !is_at(&file, path)? => {}
                Ok(()) => return Ok(Some(file)),
                // Without locks no process will take it for left over.
                Err(fs::TryLockError::Error(_)) => return Ok(Some(file)),
            },
            Err(error) if error.kind() == ErrorKind::AlreadyExists => {
                if !remove_left_over(path)? {
                    return Ok(None);
                }
            }
            Err(error) => return Err(error),
        }
    }
    Ok(None)
}

/// Removes a file that no process is writing; returns whether it is gone.
fn remove_left_over(path: &Path) -> io::Result<bool> {
    match File::options().read(true).write(true).open(path) {
        Ok(file) => match file.try_lock() {
            Ok(()) => Ok(!is_at(&file, path)? || fs::remove_file(path).is_ok()),
            Err(_) => Ok(false),
        },
        Err(error) if error.kind() == ErrorKind::NotFound => Ok(true),
        // It belongs to somebody else.
        Err(error) if error.kind() == ErrorKind::PermissionDenied => Ok(false),
        // A folder has the name, or the like.
        Err(_) if path.symlink_metadata().is_ok_and(|found| !found.is_file()) => Ok(false),
        Err(error) => Err(error),
    }
}

/// Returns whether this file still has its name. Needs no file descriptor, because there may be none left.
#[cfg(unix)]
fn is_at(file: &File, path: &Path) -> io::Result<bool> {
    use std::os::unix::fs::MetadataExt;

    let ours = file.metadata()?;
    match path.symlink_metadata() {
        Ok(found) => Ok((ours.dev(), ours.ino()) == (found.dev(), found.ino())),
        Err(error) if error.kind() == ErrorKind::NotFound => Ok(false),
        Err(error) => Err(error),
    }
}

/// Returns whether this file still has its name.
#[cfg(not(unix))]
fn is_at(file: &File, path: &Path) -> io::Result<bool> {
    use same_file::Handle;

    let ours = Handle::from_file(file.try_clone()?)?;
    match Handle::from_path(path) {
        Ok(found) => Ok(ours == found),
        Err(error) if error.kind() == ErrorKind::NotFound => Ok(false),
        Err(error) => Err(error),
    }
}

/// The name of a file, cut at a character boundary if it would be too long with suffixes.
fn stem(path: &Path) -> OsString {
    let name = path.file_name().unwrap_or_default();
    let room = LONGEST_NAME - LONGEST_ENDING;
    if name.len() <= room {
        return name.to_owned();
    }
    let name = name.to_string_lossy();
    let characters = name.char_indices();
    let ends = characters.map(|(start, character)| start + character.len_utf8());
    let end = ends.take_while(|&end| end <= room).last().unwrap_or(0);
    OsString::from(&name[..end])
}

/// The start of a temporary file's name: the name of its destination, or the beginning of it.
fn stem_of_temporary(name: &OsStr) -> Option<&str> {
    let name = name.to_str()?.strip_suffix(ENDING)?;
    Some(match name.rsplit_once('.') {
        Some((stem, number)) if number.parse::<u32>().is_ok() => stem,
        _ => name,
    })
}

/// Temporary files that existed at the start, folder by folder.
#[derive(Debug, Default)]
pub(crate) struct LeftOver {
    folders: HashMap<PathBuf, HashMap<OsString, Vec<PathBuf>>>,
}

impl LeftOver {
    /// Removes those for one destination that no process is writing.
    pub(crate) fn remove(&mut self, destination: &Path) {
        let folder = super::destination::folder(destination);
        if !self.folders.contains_key(folder) {
            self.folders.insert(folder.to_owned(), temporaries(folder));
        }
        let found = self.folders.get_mut(folder);
        let found = found.and_then(|found| found.remove(&stem(destination)));
        for path in found.into_iter().flatten() {
            // What cannot be looked at stays: it is in nobody's way.
            let _ = remove_left_over(&path);
        }
    }
}

/// The temporary files in a folder, by the start of their names.
fn temporaries(folder: &Path) -> HashMap<OsString, Vec<PathBuf>> {
    let mut found: HashMap<OsString, Vec<PathBuf>> = HashMap::new();
    // What cannot be looked at cannot be written to either, which others will say.
    for entry in fs::read_dir(folder).into_iter().flatten().flatten() {
        if let Some(stem) = stem_of_temporary(&entry.file_name()) {
            found.entry(stem.into()).or_default().push(entry.path());
        }
    }
    found
}

/// Removes all temporary files. While the returned value lives, no file appears or moves.
pub(crate) fn abandon_all() -> impl Sized {
    let mut open = lock();
    for path in open.drain(..) {
        // What cannot be removed stays; there is nobody left to tell.
        let _ = fs::remove_file(path);
    }
    open
}

/// Removes all temporary files of a process that is about to end; a file that another thread is just creating or moving
/// may stay.
///
/// Allocates no memory unless names are very long, and does not wait for more than a moment.
pub(crate) fn abandon_now() {
    const ATTEMPTS: u32 = 100;
    const PAUSE: Duration = Duration::from_millis(1);
    for _ in 0..ATTEMPTS {
        let open = match OPEN.try_lock() {
            Ok(open) => open,
            Err(TryLockError::Poisoned(poisoned)) => poisoned.into_inner(),
            Err(TryLockError::WouldBlock) => {
                thread::sleep(PAUSE);
                continue;
            }
        };
        for path in &*open {
            let _ = fs::remove_file(path);
        }
        // No other thread makes one more.
        mem::forget(open);
        return;
    }
}

fn lock() -> MutexGuard<'static, Vec<PathBuf>> {
    // The list is valid after every step, so that a panic elsewhere does not spoil it.
    OPEN.lock().unwrap_or_else(PoisonError::into_inner)
}

#[cfg(test)]
mod tests;
