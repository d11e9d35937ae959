//! NPY and NPZ, the arrays of NumPy: linear light and errors in double precision.

pub(crate) mod archive;
pub(crate) mod array;
mod arrays;
pub(crate) mod files;
pub(crate) mod given;
mod header;
pub(crate) mod memory;
pub(crate) mod npz;
pub(crate) mod read;
pub(crate) mod rows;
pub(crate) mod stamp;
pub(crate) mod stored;
pub(crate) mod write;

/// The first bytes of every file, of which six are the format's name.
const MAGIC: &[u8] = b"\x93NUMPY";
