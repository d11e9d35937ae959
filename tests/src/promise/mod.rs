//! Exact pixels of the scenes in `tests/truth/promise`, and the errors of the renderer in them.

pub mod honesty;
pub mod measure;
pub mod pixels;
