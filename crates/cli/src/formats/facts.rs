//! The facts that a file tells beside its pixels.

use blake3::Hash;
use marbles_core::{Method, View};

/// The program that files name as their writer.
pub(super) const SOFTWARE: &str = concat!("marbles ", env!("CARGO_PKG_VERSION"));

/// The facts about a picture that its file tells, where the format has room for them.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Facts {
    pub(crate) view: View,
    pub(crate) frame: i32,
    pub(crate) frames_per_second: Option<f64>,
    pub(crate) method: Method,
    /// The digest of all that the whole picture is made from.
    pub(crate) digest: Hash,
}
