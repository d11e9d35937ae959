//! Pages of the documentation whose measured parts are written by the measuring programs.
//!
//! A part lies between the lines `<!-- measured: NAME -->` and `<!-- end -->`, and begins with the commit that was
//! measured.

use std::path::{Path, PathBuf};
use std::process::Command;

/// The line after a part.
const END: &str = "<!-- end -->\n";

/// The files and folders that marbles is built from.
const SOURCES: [&str; 3] = ["crates", "Cargo.toml", "Cargo.lock"];

/// A page with measured parts.
pub struct Page {
    path: PathBuf,
    text: String,
    /// The commit that is measured, in words.
    commit: String,
}

impl Page {
    /// Reads a page, by its path in the repository.
    ///
    /// # Panics
    /// If it cannot be read, or lacks one of the parts. This is checked before the measurement.
    pub fn open(path: &str, parts: &[&str]) -> Self {
        let path = repository().join(path);
        let text = std::fs::read_to_string(&path);
        let text = text.unwrap_or_else(|error| panic!("{}: {error}", path.display()));
        let commit = commit();
        let page = Self { path, text, commit };
        for part in parts {
            page.place(part);
        }
        page
    }

    /// Replaces a part, and writes the page.
    ///
    /// # Panics
    /// If the page lacks the part, or cannot be written.
    pub fn write(&mut self, part: &str, text: &str) {
        let (start, end) = self.place(part);
        let text = format!("\nMeasured at {}.\n\n{}\n\n", self.commit, text.trim());
        self.text.replace_range(start..end, &text);
        let written = std::fs::write(&self.path, &self.text);
        written.unwrap_or_else(|error| panic!("{}: {error}", self.path.display()));
    }

    /// The byte range of a part, without the lines around it.
    fn place(&self, part: &str) -> (usize, usize) {
        let head = format!("<!-- measured: {part} -->\n");
        let start = self.text.find(&head).map(|at| at + head.len());
        let end = start.and_then(|start| Some(start + self.text[start..].find(END)?));
        let place = start.zip(end);
        place.unwrap_or_else(|| panic!("{}: no part \"{part}\"", self.path.display()))
    }
}

fn repository() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..")
}

/// The commit that changed marbles last, its date, and whether marbles has changed since.
fn commit() -> String {
    let last = git(&["log", "-1", "--format=%h (%cs)"]);
    let changes = git(&["status", "--porcelain"]);
    match last.zip(changes) {
        Some((last, changes)) if changes.is_empty() => last,
        Some((last, _)) => format!("{last} + changes"),
        None => "an unknown commit".to_owned(),
    }
}

/// The output of a command of git about the sources; none without git or its repository.
fn git(words: &[&str]) -> Option<String> {
    let mut command = Command::new("git");
    command.args(words).arg("--").args(SOURCES);
    let output = command.current_dir(repository()).output().ok()?;
    let text = String::from_utf8(output.stdout).ok()?;
    output.status.success().then(|| text.trim().to_owned())
}
