//! Pages of the documentation whose measured parts are written by the measuring programs.
//!
//! A part lies between the lines `<!-- measured: NAME -->` and `<!-- end -->`.

use std::path::{Path, PathBuf};

/// The line after a part.
const END: &str = "<!-- end -->\n";

/// A page with measured parts.
pub struct Page {
    path: PathBuf,
    text: String,
}

impl Page {
    /// Reads a page, by its path in the repository.
    ///
    /// # Panics
    /// If it cannot be read, or lacks one of the parts. This is checked before the measurement.
    pub fn open(path: &str, parts: &[&str]) -> Self {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("..").join(path);
        let text = std::fs::read_to_string(&path);
        let text = text.unwrap_or_else(|error| panic!("{}: {error}", path.display()));
        let page = Self { path, text };
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
        let text = format!("\n{}\n\n", text.trim());
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
