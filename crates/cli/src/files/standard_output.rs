//! The standard output as the place of a picture: `-` for a PNG, `exr:-` and so on for other formats.

use std::fs::File;
use std::io::{self, IsTerminal, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};
use std::{env, process};

/// The path that stands for the standard output.
const STANDARD_OUTPUT: &str = "-";

/// The extension of the format that the path of a picture asks for, if the path is the standard output.
pub(crate) fn format_of(path: &Path) -> Option<&str> {
    match path.to_str()? {
        STANDARD_OUTPUT => Some("png"),
        path => path.strip_suffix(STANDARD_OUTPUT)?.strip_suffix(':'),
    }
}

/// The path of a picture that goes to the standard output.
pub(crate) fn path() -> PathBuf {
    PathBuf::from(STANDARD_OUTPUT)
}

/// Returns whether a path is the standard output.
pub(crate) fn is(path: &Path) -> bool {
    path == Path::new(STANDARD_OUTPUT)
}

/// Returns whether a person would see the bytes of pictures.
pub(crate) fn is_terminal() -> bool {
    io::stdout().is_terminal()
}

/// The path of a temporary file for the standard output: in the folder of the system for such files.
pub(super) fn temporary_path() -> PathBuf {
    env::temp_dir().join(format!("marbles-{}", process::id()))
}

/// Copies a complete file to the standard output.
pub(super) fn copy(file: &mut File) -> io::Result<()> {
    file.seek(SeekFrom::Start(0))?;
    let mut out = io::stdout().lock();
    io::copy(file, &mut out)?;
    out.flush()
}
