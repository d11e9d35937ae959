//! The metadata in picture files.

use blake3::Hash;
use marbles_core::{Method, View};

/// The name of the program in files.
pub(super) const SOFTWARE: &str = concat!("marbles ", env!("CARGO_PKG_VERSION"));

/// The metadata of a picture, stored if the format has room for it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Facts {
    pub(crate) view: View,
    pub(crate) frame: i32,
    pub(crate) frames_per_second: Option<f64>,
    pub(crate) method: Method,
    /// The digest of everything that the whole picture depends on.
    pub(crate) digest: Hash,
}
