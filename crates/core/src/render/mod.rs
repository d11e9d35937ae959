//! The loop over the tiles of a picture.

pub(crate) mod renderer;
pub(crate) mod strips;
