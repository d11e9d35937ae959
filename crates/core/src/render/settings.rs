//! The choices that a picture is rendered by.

use crate::picture::pixel::Method;

/// The way to render a picture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settings {
    /// The way to average pixels.
    pub method: Method,
    /// Leaves the background out and keeps coverage as an alpha channel.
    pub alpha: bool,
}
