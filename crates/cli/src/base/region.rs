//! Parts of pictures, and their positions.

use std::fmt;
use std::str::FromStr;

use marbles_core::Window;

use super::size::Size;

/// A part of a picture, or all of it.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub(crate) struct Region {
    pub(crate) window: Window,
    /// The size of the picture that it is a part of.
    pub(crate) whole: Size,
}

impl Region {
    /// A part of a picture of this size; `None` if it is not inside the picture.
    pub(crate) fn new(window: Window, whole: Size) -> Option<Self> {
        let is_inside = |first: u32, length: u32, all: u32| {
            length > 0 && first.checked_add(length).is_some_and(|end| end <= all)
        };
        let is_inside = is_inside(window.col, window.width, whole.width)
            && is_inside(window.row, window.height, whole.height);
        is_inside.then_some(Self { window, whole })
    }

    /// The whole picture.
    pub(crate) fn all(whole: Size) -> Self {
        let Size { width, height } = whole;
        let window = Window {
            col: 0,
            row: 0,
            width,
            height,
        };
        Self { window, whole }
    }

    pub(crate) fn is_all(&self) -> bool {
        *self == Self::all(self.whole)
    }

    /// The size of the part.
    pub(crate) fn size(&self) -> Size {
        let Window { width, height, .. } = self.window;
        Size { width, height }
    }
}

/// The form in which files store a region: `32,0,16,8 of 600x400`.
impl fmt::Display for Region {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Size { width, height } = self.whole;
        write!(out, "{} of {width}x{height}", shown(&self.window))
    }
}

impl FromStr for Region {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, Self::Err> {
        let parts = text.split_once(" of ");
        let (window, whole) = parts.ok_or("expected a part of a picture")?;
        Self::new(window_of(window)?, whole.parse()?)
            .ok_or_else(|| "expected a part inside the picture".to_owned())
    }
}

/// A window as users write it.
pub(crate) fn shown(window: &Window) -> String {
    let Window {
        col,
        row,
        width,
        height,
    } = window;
    format!("{col},{row},{width},{height}")
}

/// The window that users write as `32,0,16,8`: first column, first row, width and height.
pub(crate) fn window_of(text: &str) -> Result<Window, String> {
    let number = |text: &str| {
        let digits = text.bytes().all(|byte| byte.is_ascii_digit());
        text.parse().ok().filter(|_| digits)
    };
    let numbers: Option<Vec<u32>> = text.split(',').map(number).collect();
    match numbers.as_deref() {
        Some(&[col, row, width, height]) if width > 0 && height > 0 => Ok(Window {
            col,
            row,
            width,
            height,
        }),
        _ => Err(
            "expected COLUMN,ROW,WIDTH,HEIGHT in pixels, with a width and a height of at least 1"
                .to_owned(),
        ),
    }
}

#[cfg(test)]
mod tests;
