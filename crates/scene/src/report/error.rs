//! The error of a scene file that was refused.

use std::fmt;
use std::ops::Range;
use std::path::{Path, PathBuf};

use super::located::{SceneFault, locate, message};
use super::snippet::{Style, Window};
use crate::text::token::line_and_column;
use crate::text::{Fault, LocatedFault, harmless, path_at};

/// The reason for which a scene file was refused.
///
/// `Display` is the complete message: for every fault a line `PATH:LINE:COLUMN: …` and the place in the file below it.
/// For a binary table the line is `PATH: row ROW, column COLUMN, byte BYTE: …`.
///
/// # Example
/// ```
/// use std::path::Path;
///
/// use marbles_scene::Scene;
///
/// let text = "(image: (width: 64, height: 48), lens: Fov(40), camera: Free(),
/// spheres: [(center: (0, 0, 5), radius: -1)])";
/// let error = Scene::parse(text, Path::new("ball.ron")).unwrap_err();
/// let message = error.to_string();
/// let first = "ball.ron:2:39: expected a radius greater than 0, found -1";
/// assert_eq!(message.lines().next(), Some(first));
/// ```
#[derive(Clone, Debug)]
pub struct SceneError {
    path: PathBuf,
    faults: Vec<SceneFault>,
    located: Vec<LocatedFault>,
    /// The text after the messages of the faults.
    end: String,
    is_of_changed_table: bool,
}

/// The words before the place in the scene file that names a table.
const NAMED_AT: &str = "\nthe table is named at ";

impl SceneError {
    /// The refused file: the scene file, or a table that it names.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// The first ten faults, in the order of the file; none if the file could not be read.
    pub fn faults(&self) -> &[SceneFault] {
        &self.faults
    }

    /// Returns whether a table has changed since marbles read it: later frames would show another table than earlier
    /// ones.
    pub fn is_of_changed_table(&self) -> bool {
        self.is_of_changed_table
    }

    /// The same error, of a table that has changed.
    pub(crate) fn of_changed_table(mut self) -> Self {
        self.is_of_changed_table = true;
        self
    }

    /// The message for a terminal of this width, with ANSI colors or without: excerpts of the file fit into a line.
    pub fn for_terminal(&self, columns: usize, with_colors: bool) -> String {
        let style = if with_colors {
            Style::Styled
        } else {
            Style::Plain
        };
        self.message(style, Window::of_columns(columns))
    }

    fn message(&self, style: Style, window: Window) -> String {
        let faults = self.located.iter();
        let parts = faults.map(|fault| message(&self.path, fault, style, window));
        parts.collect::<Vec<_>>().join("\n\n") + &self.end
    }

    /// The error of a file that cannot be read.
    pub(crate) fn unreadable(path: &Path, reason: &str) -> Self {
        Self {
            faults: Vec::new(),
            ..Self::new(
                path,
                vec![(LocatedFault::of_file(reason), String::new())],
                "",
            )
        }
    }

    /// The error of a table at `path` that a scene file names in its text at `place`.
    pub(crate) fn in_table(
        path: &Path,
        fault: LocatedFault,
        (scene, text, place): (&Path, &str, &Range<usize>),
    ) -> Self {
        let (line, column) = line_and_column(text, place.start);
        let scene = harmless(&scene.to_string_lossy());
        let end = format!("{NAMED_AT}{scene}:{line}:{column}");
        Self::new(path, vec![(fault, path_at(text, place.start))], &end)
    }

    /// The same error of a table that no scene file names.
    pub(crate) fn of_table_alone(mut self) -> Self {
        if self.end.starts_with(NAMED_AT) {
            self.end.clear();
        }
        self
    }

    /// The error of a file in which something is wrong.
    pub(crate) fn refused(path: &Path, text: &str, mut faults: Vec<Fault>) -> Self {
        /// The number of faults that are told.
        const MOST_FAULTS: usize = 10;
        faults.sort_by_key(|fault| fault.place.start);
        faults.dedup();
        let end = match faults.len().saturating_sub(MOST_FAULTS) {
            0 => String::new(),
            1 => String::from("\n\nand 1 more fault"),
            untold => format!("\n\nand {untold} more faults"),
        };
        let told = faults.into_iter().take(MOST_FAULTS);
        let faults = told.map(|fault| {
            let value = path_at(text, fault.place.start);
            (locate(text, fault), value)
        });
        Self::new(path, faults.collect(), &end)
    }

    /// The error of these faults, each with the path of its value; `end` follows their messages.
    fn new(path: &Path, faults: Vec<(LocatedFault, String)>, end: &str) -> Self {
        let (located, values): (Vec<_>, Vec<_>) = faults.into_iter().unzip();
        let faults = located.iter().zip(values);
        Self {
            path: path.to_path_buf(),
            faults: faults
                .map(|(fault, value)| SceneFault::new(fault, value))
                .collect(),
            located,
            end: end.to_owned(),
            is_of_changed_table: false,
        }
    }
}

impl fmt::Display for SceneError {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str(&self.message(Style::Plain, Window::WIDE))
    }
}

impl std::error::Error for SceneError {}
