//! Windows of a picture.

use crate::model::view::View;

/// A rectangle of a picture's pixels.
///
/// # Example
/// ```
/// use marbles_core::glam::DVec2;
/// use marbles_core::{Camera, Lens, View, Window};
///
/// let view = View::new(Camera::default(), Lens::parallel(8.0, DVec2::ZERO), 640, 480);
/// let whole = Window { col: 0, row: 0, width: 640, height: 480 };
/// assert_eq!(Window::whole(&view), whole);
/// ```
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub struct Window {
    /// Its first column.
    pub col: u32,
    /// Its first row.
    pub row: u32,
    /// Number of columns, at least 1.
    pub width: u32,
    /// Number of rows, at least 1.
    pub height: u32,
}

impl Window {
    /// The whole of a picture.
    pub fn whole(view: &View) -> Self {
        Self {
            col: 0,
            row: 0,
            width: view.width,
            height: view.height,
        }
    }
}
