//! A picture of at most 256 colors.

use super::dither::Dither;
use super::histogram::{Color, Histogram};
use super::palette::choose;

/// The colors of a picture, and for each pixel the index of its color, row by row.
pub(crate) struct Indexed {
    pub(crate) palette: Vec<[u8; 3]>,
    pub(crate) indices: Vec<u8>,
}

impl Indexed {
    /// A picture of rows with this many pixels, in at most `most` colors, which may be at most 256.
    pub(crate) fn new(codes: &[Color], width: usize, most: usize) -> Self {
        let mut histogram = Histogram::new(most);
        for run in codes.chunk_by(|one, other| one == other) {
            histogram.add(run[0], run.len() as u64);
        }
        let palette = choose(&histogram, most);
        let mut dither = Dither::new(&palette);
        let pixels = codes.iter().enumerate();
        let indices = pixels.map(|(at, &color)| dither.index(color, at % width, at / width));
        Self {
            indices: indices.collect(),
            palette,
        }
    }
}
