//! Pictures in sixels: bands of six rows, in 256 colors.
//!
//! Source: "VT330/VT340 Programmer Reference Manual", volume 2, chapter 14, vt100.net.

use std::fmt::Write;

use super::picture::Picture;
use crate::formats::gif::Indexed;

/// The rows of a band.
const BAND: usize = 6;
/// The largest number of colors that terminals have.
const MOST_COLORS: usize = 256;
/// The byte of six empty pixels. Bits of other bytes are added to it, the lowest for the highest row.
const EMPTY: u8 = b'?';
/// Fewer of the same byte are not written as a number and a byte.
const LEAST_RUN: usize = 4;

/// The text that shows the picture at the cursor, and moves the cursor below it.
pub(super) fn text(picture: &Picture) -> String {
    let width = picture.size.width as usize;
    let indexed = Indexed::new(&picture.codes, width, MOST_COLORS);
    // Pixels that are not written stay as they are (1); they are square (1;1).
    let mut text = format!("\x1bP0;1;0q\"1;1;{width};{}", picture.size.height);
    for (index, color) in indexed.palette.iter().enumerate() {
        let [red, green, blue] = color.map(percent);
        // Writing into a string cannot fail.
        let _ = write!(text, "#{index};2;{red};{green};{blue}");
    }
    for band in indexed.indices.chunks(BAND * width) {
        write_band(&mut text, band, width);
        text.push('-');
    }
    text.push_str("\x1b\\\n");
    text
}

/// Writes up to six rows: the pixels of one color after those of another.
fn write_band(text: &mut String, band: &[u8], width: usize) {
    let mut rows = vec![Vec::new(); MOST_COLORS];
    for (row, indices) in band.chunks(width).enumerate() {
        for (col, &index) in indices.iter().enumerate() {
            let sixels = &mut rows[usize::from(index)];
            sixels.resize(width.min(sixels.len().max(col + 1)), EMPTY);
            sixels[col] += 1 << row;
        }
    }
    let rows = rows.iter().enumerate();
    for (index, sixels) in rows.filter(|(_, sixels)| !sixels.is_empty()) {
        let _ = write!(text, "#{index}");
        for run in sixels.chunk_by(|one, other| one == other) {
            let sixel = char::from(run[0]);
            if run.len() < LEAST_RUN {
                run.iter().for_each(|_| text.push(sixel));
            } else {
                let _ = write!(text, "!{}{sixel}", run.len());
            }
        }
        // Back to the start of the band.
        text.push('$');
    }
}

/// The code of a channel in hundredths, to the nearest one.
fn percent(code: u8) -> u32 {
    (u32::from(code) * 100 + 127) / 255
}

#[cfg(test)]
mod tests;
