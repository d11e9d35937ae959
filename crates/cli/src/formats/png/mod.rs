pub(in crate::formats) mod animation;
mod curve;
pub(in crate::formats) mod read;
pub(in crate::formats) mod write;
