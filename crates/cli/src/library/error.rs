//! Why something was refused, or could not be done.

use marbles_scene::SceneError;
use thiserror::Error as ThisError;

use crate::base::failure::Failure;

/// The reason why a scene could not be rendered, or a picture could not be saved.
#[derive(Debug, ThisError)]
pub enum Error {
    /// A value was refused.
    #[error("{0}")]
    Value(String),
    /// The scene, or a table of it, was refused.
    #[error("{0}")]
    Scene(Box<SceneError>),
    /// A file could not be written.
    #[error("{0}")]
    File(String),
    /// Memory or threads could not be had, or a table changed while its frames were rendered.
    #[error("{0}")]
    Work(String),
}

impl From<Failure> for Error {
    fn from(failure: Failure) -> Self {
        match failure {
            Failure::Usage(message) => Self::Value(message),
            Failure::Scene(error) => Self::Scene(error),
            Failure::Work(message) | Failure::Changed(message) => Self::Work(message),
        }
    }
}
