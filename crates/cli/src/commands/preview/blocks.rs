//! Pictures as text: each half block shows two pixels, one above the other.

use std::fmt::Write;

use super::picture::Picture;

/// The foreground color is the upper pixel, the background color the lower one.
const UPPER_HALF: char = '▀';
const RESET: &str = "\x1b[0m";

/// A line for each two rows of pixels, in 24-bit color; each line ends with `end`.
pub(super) fn text(picture: &Picture, end: &str) -> String {
    let mut text = String::new();
    for row in (0..picture.size.height).step_by(2) {
        let upper = picture.row(row);
        // Below the last row of an odd number of them there is none.
        let lower = (row + 1 < picture.size.height).then(|| picture.row(row + 1));
        let (mut letter, mut ground) = (None, None);
        for (col, &color) in upper.iter().enumerate() {
            set(&mut text, 38, &mut letter, Some(color));
            set(&mut text, 48, &mut ground, lower.map(|lower| lower[col]));
            text.push(UPPER_HALF);
        }
        text.push_str(RESET);
        text.push_str(end);
    }
    text
}

/// Selects a color, 38 for the foreground and 48 for the background, unless it is selected already.
fn set(text: &mut String, which: u8, chosen: &mut Option<[u8; 3]>, color: Option<[u8; 3]>) {
    if let Some([red, green, blue]) = color
        && *chosen != color
    {
        // Writing into a string cannot fail.
        let _ = write!(text, "\x1b[{which};2;{red};{green};{blue}m");
        *chosen = color;
    }
}

#[cfg(test)]
mod tests;
