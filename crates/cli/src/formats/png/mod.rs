//! PNG.

pub(crate) mod animation;
pub(crate) mod curve;
mod decoder;
mod lines;
pub(crate) mod read;
pub(crate) mod rows;
pub(crate) mod shape;
pub(crate) mod stored;
pub(crate) mod write;
