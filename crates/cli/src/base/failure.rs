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
    /// The command line asks for what cannot be, or frames of the scene have no view.
    #[error("{0}")]
    Usage(String),
    /// The scene file was refused.
    #[error("{0}")]
    Scene(Box<SceneError>),
    /// Something else went wrong.
    #[error("{0}")]
    Work(String),
    /// A table changed while its frames were rendered: those that follow would show another one.
    #[error("{0}")]
    Changed(String),
}

impl Failure {
    /// A failure to do something with the file at `path`.
    pub(crate) fn at(path: &Path, what: &str) -> Self {
        Self::Work(format!("{}: {what}", path.shown()))
    }

    /// A command line that names the file at `path`, which cannot be used.
    pub(crate) fn unusable(path: &Path, why: &str) -> Self {
        Self::Usage(format!("{}: {why}", path.shown()))
    }

    /// A failure of the operating system to do what `what` names with the file at `path`.
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

/// The words of the operating system, in our manner.
pub(crate) fn reason(error: &io::Error) -> String {
    without_number(&error.to_string())
}

/// A message of the operating system in our manner: the number in "No such file or directory (os error 2)" helps nobody.
pub(crate) fn without_number(message: &str) -> String {
    let end = message.rfind(" (os error").unwrap_or(message.len());
    lower(&message[..end])
}

/// A message of others in our manner, without a capital letter at the start.
pub(crate) fn lower(message: &str) -> String {
    let mut letters = message.chars();
    match letters.next() {
        Some(first) => first.to_lowercase().chain(letters).collect(),
        None => String::new(),
    }
}
