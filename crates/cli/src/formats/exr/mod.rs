//! OpenEXR.

mod attributes;
pub(crate) mod blocks;
mod channels;
pub(super) mod header;
pub(crate) mod read;
pub(crate) mod rows;
pub(crate) mod stored;
pub(crate) mod write;
