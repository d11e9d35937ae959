//! OpenEXR.

mod attributes;
mod block_reader;
pub(crate) mod blocks;
pub(crate) mod channels;
mod data_window;
pub(super) mod header;
pub(crate) mod read;
pub(crate) mod rows;
pub(crate) mod stored;
pub(crate) mod write;
