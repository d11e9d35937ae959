//! Why a scene file or a frame of it was refused.

use std::fmt;
use std::ops::Range;
use std::path::{Path, PathBuf};

use crate::fault::Fault;
use crate::report::{self, Position, Style};
use crate::table::{TableFault, TablePlace};

/// Why a scene file was refused.
///
/// `Display` is the complete message: for every fault a line `PATH:LINE:COLUMN: …` and the place
/// in the file below it. Of a binary table the line is `PATH: row ROW, column COLUMN, byte BYTE: …`.
#[derive(Clone, Debug)]
pub struct SceneError {
    path: PathBuf,
    faults: Vec<SceneFault>,
    plain: String,
    styled: String,
}

/// A place in a file and what is wrong there.
#[derive(Clone, Debug, Eq, PartialEq)]
pub struct SceneFault {
    /// The line, from 1; in a binary table the row.
    pub line: usize,
    /// The column, in characters from 1; in a binary table that of the table.
    pub column: usize,
    /// What was expected and what was found.
    pub message: String,
}

impl SceneError {
    /// The file in which something is wrong: the scene file, or a table that it names.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// The faults that are told, in the order of the file; none where the file could not be read.
    pub fn faults(&self) -> &[SceneFault] {
        &self.faults
    }

    /// The message with ANSI colors, for a terminal; `Display` is the same without.
    pub fn styled(&self) -> String {
        self.styled.clone()
    }

    /// The error of a file that cannot be read.
    pub(crate) fn unreadable(path: &Path, reason: &str) -> Self {
        let message = |style: Style| report::header(path, &Position::None, reason, style);
        Self {
            path: path.to_path_buf(),
            faults: Vec::new(),
            plain: message(Style::Plain),
            styled: message(Style::Styled),
        }
    }

    /// The error of a table at `path` that a scene file names in its text at `place`.
    pub(crate) fn in_table(
        path: &Path,
        fault: &TableFault,
        (scene, text, place): (&Path, &str, &Range<usize>),
    ) -> Self {
        let (line, column) = report::position(text, place.start);
        let scene = scene.display();
        let named = format!("the table is named at {scene}:{line}:{column}");
        let message = |style: Style| {
            let place = match fault.place {
                TablePlace::Text { .. } => report::in_line(path, fault, style),
                TablePlace::Row { row, column, byte } => {
                    let position = Position::Row { row, column, byte };
                    report::header(path, &position, &fault.message, style)
                }
                TablePlace::Header => report::header(path, &Position::None, &fault.message, style),
            };
            format!("{place}\n{named}")
        };
        let (line, column) = match &fault.place {
            TablePlace::Text { line, text, span } => {
                (*line, text[..span.start].chars().count() + 1)
            }
            TablePlace::Row { row, column, .. } => (*row, *column),
            TablePlace::Header => (1, 1),
        };
        Self {
            path: path.to_path_buf(),
            plain: message(Style::Plain),
            styled: message(Style::Styled),
            faults: vec![SceneFault {
                line: usize::try_from(line).unwrap_or(usize::MAX),
                column,
                message: fault.message.clone(),
            }],
        }
    }

    /// The error of a file in which something is wrong.
    pub(crate) fn refused(path: &Path, text: &str, faults: Vec<Fault>) -> Self {
        let located = report::locate(text, faults);
        Self {
            path: path.to_path_buf(),
            plain: located.message(path, text, Style::Plain),
            styled: located.message(path, text, Style::Styled),
            faults: located.into_faults(),
        }
    }
}

impl fmt::Display for SceneError {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str(&self.plain)
    }
}

impl std::error::Error for SceneError {}

/// Why a frame of a valid scene cannot be rendered.
#[derive(Clone, Copy, Debug, Eq, PartialEq, thiserror::Error)]
#[error("frame {frame}: {fault}")]
pub struct FrameError {
    /// The frame.
    pub frame: i32,
    /// What is wrong in it.
    pub fault: FrameFault,
}

/// What is wrong with the camera in a frame.
#[derive(Clone, Copy, Debug, Eq, PartialEq, thiserror::Error)]
pub enum FrameFault {
    /// Its target is its position.
    #[error("the camera stands at its target and looks nowhere")]
    LooksNowhere,
    /// Its position is beyond the range of numbers.
    #[error("the camera is infinitely far away")]
    TooFar,
}
