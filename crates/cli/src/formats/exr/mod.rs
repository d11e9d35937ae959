mod channels;
mod header;
pub(in crate::formats) mod read;
pub(in crate::formats) mod write;
