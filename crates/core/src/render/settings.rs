//! The choices that a picture is rendered by.

use crate::picture::pixel::Method;

/// The way to render a picture.
///
/// By default, to the tolerance 1e-3 of [`Method::default`], with the background and without an alpha channel.
///
/// # Example
/// ```
/// use marbles_core::{Method, Settings};
///
/// let fine = Settings { method: Method::Tolerance(1e-6), ..Settings::default() };
/// assert!(!fine.alpha);
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Settings {
    /// The way to average pixels.
    pub method: Method,
    /// Leaves the background out and keeps coverage as an alpha channel.
    pub alpha: bool,
}
