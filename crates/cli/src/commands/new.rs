//! `marbles new`: writes a first scene.

use std::fs::{self, File};
use std::io::{ErrorKind, Write};
use std::path::Path;

use super::args::NewArguments;
use crate::base::failure::Failure;
use crate::base::shown::Shown;
use crate::base::status;
use crate::terminal::console::Console;

const STILL: &str = include_str!("new/still.ron");
const TURNTABLE: &str = include_str!("new/turntable.ron");
/// The word in the comments of the scenes that is replaced by the name of the file.
const NAME: &str = "NAME";

pub(crate) fn run(arguments: &NewArguments, console: &Console) -> Result<u8, Failure> {
    let path = &arguments.scene;
    let ending = path.extension();
    if ending.is_none_or(|ending| !ending.eq_ignore_ascii_case("ron")) {
        return Err(Failure::Usage(format!(
            "expected a file name that ends in .ron, found `{}`",
            path.shown()
        )));
    }
    let text = if arguments.turntable {
        TURNTABLE
    } else {
        STILL
    };
    write(path, &text.replace(NAME, &shown(path)))?;
    console.result(&path.shown());
    if console.is_interactive() {
        let shown = shown(path);
        console.note(&format!("see it: marbles preview {shown} --watch"));
    }
    Ok(status::SUCCESS)
}

/// The name of the file in a comment or a message of one line, quoted if a shell needs it.
fn shown(path: &Path) -> String {
    let name = path.display().to_string();
    let is_plain = |letter: char| letter.is_alphanumeric() || "._-/\\:~+@%".contains(letter);
    if name.chars().all(is_plain) {
        name
    } else if name.contains(|letter: char| letter.is_control() || letter == '\'') {
        NAME.to_owned()
    } else {
        format!("'{name}'")
    }
}

/// Writes a file that must not exist yet.
fn write(path: &Path, text: &str) -> Result<(), Failure> {
    if let Some(folder) = path.parent() {
        fs::create_dir_all(folder)
            .map_err(|error| Failure::io(folder, "cannot create the folder", &error))?;
    }
    // Which asks and creates at once: nobody else's file is ever lost.
    let mut file = File::create_new(path).map_err(|error| match error.kind() {
        ErrorKind::AlreadyExists => Failure::at(path, "the file already exists"),
        _ => Failure::io(path, "cannot create the file", &error),
    })?;
    file.write_all(text.as_bytes()).map_err(|error| {
        // What could not be written is no scene; there is nothing to tell beside the error.
        let _ = fs::remove_file(path);
        Failure::io(path, "cannot write the file", &error)
    })
}

#[cfg(test)]
mod tests;
