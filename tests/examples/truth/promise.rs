//! What the test of the promise measures.

#[path = "../../src/promise/measure.rs"]
pub(crate) mod measure;
#[path = "../../src/promise/pixels.rs"]
pub(crate) mod pixels;
