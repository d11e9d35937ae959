//! Exact pixels of the scenes in `tests/truth/promise`, and how far the renderer is off from them.

pub mod honesty;
pub mod measure;
pub mod pixels;
