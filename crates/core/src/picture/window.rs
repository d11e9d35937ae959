//! Windows of a picture.

use crate::model::view::View;

/// A rectangle of a picture's pixels.
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
