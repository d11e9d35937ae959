//! Reasons why a command ended before its work was done.

use std::io;
use std::path::Path;

use marbles_scene::SceneError;
use thiserror::Error;

use super::shown::Shown;
use super::status;

/// A message for the user, and with it the exit code.
#[derive(Debug, Error)]
pub(crate) enum Failure {
    /// The command line is wrong, or frames of the scene have no view.
    #[error("{0}")]
    Usage(String),
    /// The scene file was refused.
    #[error("{0}")]
    Scene(Box<SceneError>),
    /// Something else went wrong.
    #[error("{0}")]
    Work(String),
    /// A table changed while its frames were rendered: the remaining frames would show different data.
    #[error("{0}")]
    Changed(String),
}

impl Failure {
    /// A failure to do something with the file at `path`.
    pub(crate) fn at(path: &Path, what: &str) -> Self {
        Self::Work(format!("{}: {what}", path.shown()))
    }

    /// An error in the command line: it names the file at `path`, which cannot be used.
    pub(crate) fn unusable(path: &Path, why: &str) -> Self {
        Self::Usage(format!("{}: {why}", path.shown()))
    }

    /// A failure of the operating system to do what `what` describes with the file at `path`.
    pub(crate) fn io(path: &Path, what: &str, error: &io::Error) -> Self {
        Self::at(path, &format!("{what}: {}", reason(error)))
    }

    pub(crate) fn exit_code(&self) -> u8 {
        match self {
            Self::Usage(_) | Self::Scene(_) => status::REFUSED,
            Self::Work(_) | Self::Changed(_) => status::FAILURE,
        }
    }
}

/// The message of the operating system, in the style of our messages.
pub(crate) fn reason(error: &io::Error) -> String {
    without_number(&error.to_string())
}

/// A message of the operating system in the style of our messages: without the number, as in "No such file or directory
/// (os error 2)".
pub(crate) fn without_number(message: &str) -> String {
    let end = message.rfind(" (os error").unwrap_or(message.len());
    lower(&message[..end])
}

/// A message of a library in the style of our messages: without a capital letter at the start.
pub(crate) fn lower(message: &str) -> String {
    let mut letters = message.chars();
    match letters.next() {
        Some(first) => first.to_lowercase().chain(letters).collect(),
        None => String::new(),
    }
}
