//! A picture from a file, as linear light, row by row.
//!
//! Samples stay encoded as in the file until a pixel is requested. A table converts codes to light, and the rounding of
//! every number is known.

use std::any::Any;
use std::ops::Range;
use std::path::Path;

use image::metadata::Orientation;

use crate::base::failure::lower;
use crate::base::shown::Shown;
use crate::base::size::{LONGEST_SIDE, Size};
use crate::terminal::console::Console;

/// The warnings about files of which only a part is read, or which are shown differently.
pub(super) const ONE_FRAME: &str = "it is an animation: only its first frame is read";
pub(super) const ONE_PICTURE: &str = "it contains several pictures: only the first one is read";
pub(super) const NOT_TURNED: &str = "it asks to be rotated, but is read as it is stored";

/// A picture that is being read: linear light, premultiplied by alpha.
///
/// Only the rows that the file stores together are in memory.
pub(crate) struct Picture {
    pub(crate) size: Size,
    /// Whether there is one channel of light instead of three.
    pub(crate) grey: bool,
    pub(crate) alpha: bool,
    /// The name of its format.
    pub(crate) format: &'static str,
    /// The description of the file for people: `PNG, 8 bit sRGB, gray`.
    pub(crate) description: String,
    /// Warnings about contents that were ignored.
    pub(crate) warnings: Vec<&'static str>,
    pub(crate) row: Box<dyn Samples>,
}

/// The samples of one row of a picture; at the start no row is read.
///
/// Column 0 is the left one. All pixels have red, green, blue and alpha; in gray pictures the three colors are equal,
/// and alpha is 1 if the file has none.
pub(crate) trait Samples: Any {
    /// Advances to the next row, starting with the top one. There must be a next row.
    ///
    /// # Errors
    /// If the file is damaged.
    fn advance(&mut self) -> Result<(), String>;

    /// The columns of the row that may contain data; outside of them all pixels are equal.
    fn held(&self) -> Range<u32> {
        0..LONGEST_SIDE
    }

    /// The columns outside of which this row has the same finite numbers as that of another picture of the same size;
    /// `None` if this is not known without decoding pixels.
    fn differing(&self, _other: &dyn Samples) -> Option<Range<u32>> {
        None
    }

    /// The end of the columns, starting with this one, that are known to have equal numbers.
    fn end_of_run(&self, col: u32) -> u32 {
        col + 1
    }

    /// The light of a pixel, and its alpha.
    fn rgba(&self, col: u32) -> [f64; 4];

    /// The largest rounding error of these numbers: half a step of the format.
    fn rounding(&self, col: u32) -> [f64; 4];

    /// Returns for each value whether it is the largest number of the format, so that the original number may have been
    /// larger.
    fn is_full(&self, col: u32) -> [bool; 4];
}

impl Picture {
    /// Prints the warnings about the file at `path`.
    pub(crate) fn warn(&self, path: &Path, console: &Console) {
        for warning in &self.warnings {
            console.warn(&format!("{}: {warning}", path.shown()));
        }
    }

    /// Goes on to the next row; see [`Samples::advance`].
    pub(crate) fn advance(&mut self) -> Result<(), String> {
        let row = self.row.advance();
        row.map_err(|reason| unusable(self.format, &reason))
    }
}

/// The message about an unusable file, with the reason.
pub(super) fn unusable(format: &str, reason: &str) -> String {
    format!("not a usable {format}: {}", lower(reason))
}

/// Returns whether viewers turn or mirror pictures of this orientation.
pub(super) fn is_turned(orientation: Orientation) -> bool {
    orientation != Orientation::NoTransforms
}

/// The size of a picture, if it is allowed.
pub(super) fn size_of(width: usize, height: usize) -> Result<Size, String> {
    let side = |length: usize| {
        let length = u32::try_from(length).ok();
        length.filter(|length| (1..=LONGEST_SIDE).contains(length))
    };
    match (side(width), side(height)) {
        (Some(width), Some(height)) => Ok(Size { width, height }),
        _ => Err(format!(
            "{width} x {height} pixels, expected each side from 1 to {LONGEST_SIDE}"
        )),
    }
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;

    /// Exif data that contain nothing but an orientation.
    pub(crate) fn exif_of_orientation(number: u8) -> Vec<u8> {
        let start = b"II*\0\x08\0\0\0\x01\0\x12\x01\x03\0\x01\0\0\0";
        [&start[..], &[number, 0, 0, 0, 0, 0, 0, 0]].concat()
    }

    /// The whole picture, for tests that need pixels in any order.
    pub(crate) struct Whole {
        pub(crate) rgba: Vec<Vec<[f64; 4]>>,
        pub(crate) rounding: Vec<Vec<[f64; 4]>>,
        pub(crate) is_full: Vec<Vec<[bool; 4]>>,
    }

    impl Picture {
        /// Reads all rows.
        pub(crate) fn whole(mut self) -> Result<Whole, String> {
            let mut whole = Whole {
                rgba: Vec::new(),
                rounding: Vec::new(),
                is_full: Vec::new(),
            };
            for _ in 0..self.size.height {
                self.advance()?;
                let cols = 0..self.size.width;
                let row = &self.row;
                whole
                    .rgba
                    .push(cols.clone().map(|col| row.rgba(col)).collect());
                let rounding = cols.clone().map(|col| row.rounding(col));
                whole.rounding.push(rounding.collect());
                whole
                    .is_full
                    .push(cols.map(|col| row.is_full(col)).collect());
            }
            Ok(whole)
        }
    }

    #[test]
    fn sides_have_limits() {
        const LONGEST: usize = LONGEST_SIDE as usize;
        assert!(size_of(LONGEST, 1).is_ok());
        for (width, height) in [(0, 1), (1, 0), (LONGEST + 1, 1), (usize::MAX, usize::MAX)] {
            assert!(size_of(width, height).is_err());
        }
    }
}
