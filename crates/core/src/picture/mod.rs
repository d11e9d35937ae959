//! Pictures: pixels, tiles, windows, and what fills them.

pub(crate) mod image;
pub(crate) mod integrator;
pub(crate) mod pixel;
pub(crate) mod plane;
pub(crate) mod tile;
pub(crate) mod window;
