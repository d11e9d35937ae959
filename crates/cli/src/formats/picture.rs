//! A picture from a file, as linear light.
//!
//! Samples stay as the file has them, and become light where a pixel is asked for: a table turns codes
//! into light, and it is known what a number of the file may have been before it was rounded.

use std::fmt::Debug;

use crate::base::memory;
use crate::base::size::{LONGEST_SIDE, Size};

/// A picture that was read: linear light, premultiplied by its alpha.
#[derive(Debug)]
pub(crate) struct Picture {
    pub(crate) size: Size,
    /// True where there is one channel of light instead of three.
    pub(crate) grey: bool,
    pub(crate) alpha: bool,
    /// The kind of the file, for people: `PNG, 8 bit sRGB, grey`.
    pub(crate) description: String,
    /// A warning about how the file was understood.
    pub(crate) warning: Option<&'static str>,
    pub(crate) samples: Box<dyn Samples>,
}

/// The samples of a picture.
///
/// Row 0 is the top row, column 0 the left one. All values come as red, green, blue and alpha;
/// grey stands in all three colors, and alpha is 1 where the file has none.
pub(crate) trait Samples: Debug {
    /// The light of a pixel, and its alpha.
    fn rgba(&self, col: u32, row: u32) -> [f64; 4];

    /// The distances from these to the numbers that the file may have rounded: half a step of the
    /// format there.
    fn rounding(&self, col: u32, row: u32) -> [f64; 4];

    /// Returns for each value whether it is the largest that the file can hold, so that a larger one
    /// may be meant.
    fn is_full(&self, col: u32, row: u32) -> [bool; 4];
}

/// Refuses pictures for which there is certainly no memory, where allocating it would end the
/// process.
pub(super) fn check_memory(
    width: usize,
    height: usize,
    bytes_per_pixel: usize,
) -> Result<Size, String> {
    let side = |length: usize| {
        let length = u32::try_from(length).ok();
        length.filter(|length| (1..=LONGEST_SIDE).contains(length))
    };
    let (Some(width), Some(height)) = (side(width), side(height)) else {
        return Err(format!(
            "{width} x {height} pixels, expected each side from 1 to {LONGEST_SIDE}"
        ));
    };
    let size = Size { width, height };
    let bytes = size.pixels().checked_mul(bytes_per_pixel as u64);
    if bytes.is_some_and(memory::is_available) {
        Ok(size)
    } else {
        Err(format!(
            "{width} x {height} pixels need more memory than there is"
        ))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn refuses_sizes_without_memory() {
        const LONGEST: usize = LONGEST_SIDE as usize;
        assert!(check_memory(LONGEST, 1, 1).is_ok());
        for (width, height) in [(0, 1), (1, 0), (LONGEST + 1, 1), (usize::MAX, usize::MAX)] {
            assert!(check_memory(width, height, 1).is_err());
        }
        assert!(check_memory(LONGEST, LONGEST, usize::MAX).is_err());
    }
}
