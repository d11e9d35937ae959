//! Messages for people: the place of a fault, the fault, and the line of the file.

mod error;
mod located;
mod snippet;

pub use error::SceneError;
pub use located::SceneFault;
pub(crate) use located::{in_a_line, locate};
