//! Pictures: pixels, tiles, windows, and how they are written.

pub(crate) mod averages;
pub(crate) mod band;
pub(crate) mod geometry;
pub(crate) mod image;
#[cfg(feature = "image")]
mod image_buffers;
pub(crate) mod pixel;
pub(crate) mod plane;
pub(crate) mod progress;
pub(crate) mod quantities;
pub mod srgb;
pub(crate) mod summary;
pub(crate) mod tile;
pub(crate) mod window;
