//! Pictures in linear light.

use rayon::iter::{IndexedParallelIterator, ParallelIterator};
use rayon::slice::ParallelSliceMut;

use crate::Tile;
use crate::integration::Pixel;
use crate::{Radiance, Status};

/// Which numbers a picture holds for each pixel.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub enum Channels {
    /// One: the picture has no color.
    Grey,
    /// Red, green, blue.
    Rgb,
}

impl Channels {
    fn count(self) -> usize {
        match self {
            Self::Grey => 1,
            Self::Rgb => 3,
        }
    }
}

/// A picture: linear light, premultiplied by coverage where it has an alpha channel, and for
/// every pixel the error of these numbers.
///
/// Row 0 is the top row, column 0 the left one.
#[derive(Clone, Debug, PartialEq)]
pub struct Image {
    width: u32,
    height: u32,
    channels: Channels,
    alpha: bool,
    /// Row by row, the channels and then the alpha of each pixel.
    values: Vec<f64>,
    errors: Vec<f64>,
    statuses: Vec<Status>,
}

/// What a picture as a whole achieved.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Summary {
    /// Number of pixels.
    pub pixels: u64,
    /// The largest error that any pixel claims.
    pub largest_error: f64,
    /// Number of pixels that did not meet the tolerance; 0 where none was asked for.
    pub over_tolerance: u64,
}

impl Image {
    /// A black picture.
    pub(crate) fn new(width: u32, height: u32, channels: Channels, alpha: bool) -> Self {
        let pixels = width as usize * height as usize;
        let stride = channels.count() + usize::from(alpha);
        Self {
            width,
            height,
            channels,
            alpha,
            values: vec![0.0; pixels * stride],
            errors: vec![0.0; pixels],
            statuses: vec![Status::NoTolerance; pixels],
        }
    }

    /// Number of columns.
    pub fn width(&self) -> u32 {
        self.width
    }

    /// Number of rows.
    pub fn height(&self) -> u32 {
        self.height
    }

    /// Whether the picture has color.
    pub fn channels(&self) -> Channels {
        self.channels
    }

    /// Whether the picture is premultiplied light without its background, with coverage.
    pub fn has_alpha(&self) -> bool {
        self.alpha
    }

    /// Red, green, blue and alpha of a pixel; grey repeats, and alpha is 1 without its channel.
    ///
    /// # Panics
    /// Outside the picture, as for the other accessors of a pixel.
    pub fn rgba(&self, col: u32, row: u32) -> [f64; 4] {
        let count = self.channels.count();
        let stride = count + usize::from(self.alpha);
        let start = self.index(col, row) * stride;
        let pixel = &self.values[start..start + stride];
        let alpha = if self.alpha { pixel[count] } else { 1.0 };
        match self.channels {
            Channels::Grey => [pixel[0], pixel[0], pixel[0], alpha],
            Channels::Rgb => [pixel[0], pixel[1], pixel[2], alpha],
        }
    }

    /// How far a pixel's numbers may be from the exact area average; infinite where nothing is
    /// known.
    pub fn error(&self, col: u32, row: u32) -> f64 {
        self.errors[self.index(col, row)]
    }

    /// How the work on a pixel ended.
    pub fn status(&self, col: u32, row: u32) -> Status {
        self.statuses[self.index(col, row)]
    }

    /// What the picture as a whole achieved.
    pub fn summary(&self) -> Summary {
        let over = self
            .statuses
            .iter()
            .filter(|status| status.is_over_tolerance())
            .count();
        Summary {
            pixels: self.errors.len() as u64,
            largest_error: self.errors.iter().copied().fold(0.0, f64::max),
            over_tolerance: over as u64,
        }
    }

    /// The picture cut into bands of at most `rows` rows, from the top.
    pub(crate) fn bands_mut(&mut self, rows: u32) -> impl IndexedParallelIterator<Item = Band<'_>> {
        let (width, height) = (self.width, self.height);
        let stride = self.channels.count() + usize::from(self.alpha);
        let pixels = width as usize * rows as usize;
        self.values
            .par_chunks_mut(pixels * stride)
            .zip(self.errors.par_chunks_mut(pixels))
            .zip(self.statuses.par_chunks_mut(pixels))
            .enumerate()
            .map(move |(index, ((values, errors), statuses))| {
                let row = index as u32 * rows;
                let area = Tile {
                    col: 0,
                    row,
                    width,
                    height: rows.min(height - row),
                };
                Band {
                    area,
                    stride,
                    values,
                    errors,
                    statuses,
                }
            })
    }

    fn index(&self, col: u32, row: u32) -> usize {
        assert!(
            col < self.width && row < self.height,
            "pixel ({col}, {row}) is outside"
        );
        row as usize * self.width as usize + col as usize
    }
}

/// Whole rows of a picture, to be written by one thread.
pub(crate) struct Band<'image> {
    pub(crate) area: Tile,
    stride: usize,
    values: &'image mut [f64],
    errors: &'image mut [f64],
    statuses: &'image mut [Status],
}

impl Band<'_> {
    /// Writes the pixels of a tile inside the band, which come in the order of
    /// [`Tile::pixels`].
    pub(crate) fn write<C: Radiance>(&mut self, tile: Tile, pixels: &[Pixel<C>]) {
        for ((col, row), pixel) in tile.pixels().zip(pixels) {
            let index = (row - self.area.row) as usize * self.area.width as usize + col as usize;
            let values = &mut self.values[index * self.stride..][..self.stride];
            let channels = pixel.value.channels();
            values[..channels.len()].copy_from_slice(channels);
            // The alpha channel, where there is one.
            values[channels.len()..].fill(pixel.alpha);
            self.errors[index] = pixel.error;
            self.statuses[index] = pixel.status;
        }
    }
}
