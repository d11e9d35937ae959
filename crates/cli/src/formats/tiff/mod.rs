//! TIFF.

mod decoder;
mod directory;
pub(crate) mod read;
pub(crate) mod rows;
pub(crate) mod shape;
pub(crate) mod stored;
mod strips;
pub(crate) mod write;

pub(crate) use self::strips::Strips;
