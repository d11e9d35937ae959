//! The strips of a TIFF that is rendered.

use std::ops::Range;

use marbles_core::Image;

use super::shape::Shape;
use crate::formats::encoding::TiffOptions;
use crate::formats::form::Form;

/// The strips of the pictures of a sequence.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Strips {
    pub(crate) shape: Shape,
    /// See [`TiffOptions`].
    gain: f64,
}

impl Strips {
    pub(crate) fn new(form: &Form, options: TiffOptions) -> Self {
        Self {
            shape: Shape::of(form, options),
            gain: options.gain,
        }
    }

    /// Copies the numbers of rows of an image to their positions in a strip; see [`Shape::encode`].
    pub(crate) fn encode(
        &self,
        samples: &mut [u8],
        col: u32,
        image: &Image,
        rows: Range<u32>,
    ) -> u64 {
        self.shape.encode(samples, col, image, rows, self.gain)
    }
}
