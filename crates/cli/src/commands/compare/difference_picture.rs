//! A picture of the differences between two pictures.

use std::ops::Range;
use std::path::{Path, PathBuf};

use crate::base::failure::Failure;
use crate::base::shown::Shown;
use crate::base::size::Size;
use crate::files::save::Fault;
use crate::formats::encoding::Format;
use crate::formats::exr::write::write_floats;
use crate::formats::png::write::write_grey;

/// The difference in the middle of the scale of a PNG if there is no tolerance.
const USUAL_MIDDLE: f64 = 1e-3;
/// Powers of ten from the middle of the scale to black and to white.
const DECADES: f64 = 3.0;
/// The largest code of a pixel that is not over the tolerance.
const MIDDLE_CODE: u8 = 127;

/// The file of `--diff`.
///
/// An EXR contains the differences themselves, channel by channel. A PNG shows them in gray, on a logarithmic scale
/// with the tolerance in the middle: everything lighter than the middle is over the tolerance.
#[derive(Debug)]
pub(super) struct DifferencePicture {
    path: PathBuf,
    /// True for an EXR, and false for a PNG.
    holds_floats: bool,
}

impl DifferencePicture {
    /// The picture at `path`, whose extension chooses the format.
    pub(super) fn at(path: &Path) -> Result<Self, Failure> {
        let holds_floats = match Format::of_file(path) {
            Some(Format::Png) => false,
            Some(Format::Exr) => true,
            _ => {
                return Err(Failure::Usage(format!(
                    "--diff: expected a file name that ends in .png or .exr, found `{}`",
                    path.shown()
                )));
            }
        };
        Ok(Self {
            path: path.to_owned(),
            holds_floats,
        })
    }

    pub(super) fn path(&self) -> &Path {
        &self.path
    }

    /// The description of its values.
    pub(super) fn scale(&self, tolerance: Option<f64>) -> String {
        if self.holds_floats {
            return "the differences of each channel".to_owned();
        }
        let middle = middle(tolerance);
        let decades = libm::pow(10.0, DECADES);
        format!(
            "log scale, black <= {:.1e}, middle {middle:e}, white >= {:.1e}",
            middle / decades,
            middle * decades
        )
    }

    /// Writes the picture with these channels. `row` appends the differences of the next row, pixel by pixel, and
    /// returns the columns that they cover; in all other columns there are no differences.
    pub(super) fn write(
        &self,
        size: Size,
        names: &[&str],
        tolerance: Option<f64>,
        mut row: impl FnMut(&mut Vec<f64>) -> Result<Range<u32>, Fault>,
    ) -> Result<(), Failure> {
        if self.holds_floats {
            return write_floats(size, names, &self.path, row);
        }
        let middle = middle(tolerance);
        let mut differences = Vec::new();
        write_grey(size, &self.path, &[], |codes| {
            differences.clear();
            let columns = row(&mut differences)?;
            codes.resize(columns.start as usize, 0);
            let pixels = differences.chunks_exact(names.len());
            let largest = pixels.map(|pixel| pixel.iter().copied().fold(0.0, f64::max));
            // Many pixels differ as much as the one before, and logarithms take time.
            let mut last = (0.0, code(0.0, middle));
            codes.extend(largest.map(|size| {
                if size != last.0 {
                    last = (size, code(size, middle));
                }
                last.1
            }));
            codes.resize(size.width as usize, 0);
            Ok(())
        })
    }
}

/// The difference in the middle of the scale.
fn middle(tolerance: Option<f64>) -> f64 {
    tolerance
        .filter(|&tolerance| tolerance > 0.0)
        .unwrap_or(USUAL_MIDDLE)
}

/// The gray code of a difference: at most [`MIDDLE_CODE`] exactly if the difference does not exceed `middle`.
fn code(size: f64, middle: f64) -> u8 {
    if size == 0.0 {
        return 0;
    }
    let decades = (libm::log10(size / middle) / DECADES).clamp(-1.0, 1.0);
    let above = f64::from(u8::MAX - MIDDLE_CODE - 1);
    // The casts saturate.
    if size > middle {
        MIDDLE_CODE + 1 + (decades * above) as u8
    } else {
        (f64::from(MIDDLE_CODE) * (1.0 + decades)) as u8
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_middle_of_the_scale_tells_what_is_over_it() {
        let tolerance = 3e-4;
        for (size, expected) in [
            (0.0, 0),
            (f64::MIN_POSITIVE, 0),
            (3e-7, 0),
            (tolerance, 127),
            (tolerance.next_up(), 128),
            (0.3, 255),
            (1.0, 255),
            (f64::INFINITY, 255),
        ] {
            assert_eq!(code(size, middle(Some(tolerance))), expected, "{size:e}");
        }
        let codes = (1..1000).map(|step| code(f64::from(step) * 1e-5, 1e-3));
        assert!(codes.is_sorted());
    }

    #[test]
    fn without_a_tolerance_there_is_a_scale_as_well() {
        assert_eq!(middle(None), USUAL_MIDDLE);
        assert_eq!(middle(Some(0.0)), USUAL_MIDDLE);
    }
}
