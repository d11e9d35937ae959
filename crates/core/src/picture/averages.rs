//! Averages over what pixels see of spheres.

use super::tile::Tile;
use super::window::Window;

/// The averages that are wanted of a picture's pixels.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct AverageSettings {
    /// True if [`Average::Normal`] is wanted.
    pub normal: bool,
    /// True if [`Average::Coverage`] is wanted, and the sphere that it is of.
    pub coverage: bool,
    /// The error that is accepted in what is averaged: greater than 0.
    pub tolerance: f64,
}

/// An average over a pixel.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub enum Average {
    /// The mean of the shading normal over the part of the pixel in which spheres are seen: x, y and z in the axes of the
    /// normals, no unit vector where the surface bends; then the error of each. The tolerance is met by the integral, so
    /// that the error is at most the tolerance divided by the part. It is an estimate, which what fools the claims of
    /// pictures may fool: the means are made of such. An inner side, which no light reaches, counts as 0. Where nothing
    /// is seen all are 0.
    Normal,
    /// The part of the pixel in which the sphere is seen that most of the pixel sees, from 0 to 1, and an estimate of its
    /// error.
    Coverage,
}

impl Average {
    /// The number of its components.
    pub const fn components(self) -> usize {
        match self {
            Self::Normal => 4,
            Self::Coverage => 2,
        }
    }
}

/// The averages over the pixels of a rectangle.
#[derive(Clone, Debug, Default)]
pub(crate) struct Averages {
    width: usize,
    normals: Vec<[f64; 4]>,
    coverages: Vec<Coverage>,
}

/// The sphere that most of a pixel sees.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Coverage {
    /// Its index, or the one that stands for none.
    pub(crate) id: u32,
    /// The part of the pixel in which it is seen, and the error of that.
    pub(crate) share: [f64; 2],
}

impl Averages {
    /// Averages of so many columns and rows, in which nothing is seen yet; `nothing` is the index of no sphere.
    pub(crate) fn new(
        (width, height): (u32, u32),
        settings: &AverageSettings,
        nothing: u32,
    ) -> Self {
        let count = width as usize * height as usize;
        let of_nothing = Coverage {
            id: nothing,
            share: [0.0; 2],
        };
        Self {
            width: width as usize,
            normals: vec![[0.0; 4]; if settings.normal { count } else { 0 }],
            coverages: vec![of_nothing; if settings.coverage { count } else { 0 }],
        }
    }

    /// The place of a tile's pixel, where the first pixel is the one in this column and row of a larger picture.
    fn place(&self, tile: Tile, pixel: usize, (col, row): (u32, u32)) -> usize {
        let (down, right) = (pixel as u32 / tile.width, pixel as u32 % tile.width);
        (tile.row - row + down) as usize * self.width + (tile.col - col + right) as usize
    }

    /// Writes the mean normal of a tile's pixel, and its error.
    pub(crate) fn put_normal(
        &mut self,
        (tile, pixel): (Tile, usize),
        first: (u32, u32),
        normal: [f64; 4],
    ) {
        let place = self.place(tile, pixel, first);
        self.normals[place] = normal;
    }

    /// Writes which sphere covers most of a tile's pixel.
    pub(crate) fn put_coverage(
        &mut self,
        (tile, pixel): (Tile, usize),
        first: (u32, u32),
        coverage: Coverage,
    ) {
        let place = self.place(tile, pixel, first);
        self.coverages[place] = coverage;
    }

    /// The indices of the spheres that most of the pixels in a row of a window see; `None` where they were not wanted.
    pub(crate) fn ids(&self, window: Window, row: u32) -> Option<impl Iterator<Item = u32>> {
        let coverages = self.row(&self.coverages, window, row)?;
        Some(coverages.iter().map(|coverage| coverage.id))
    }

    /// A component of an average in the pixels of a row of a window; `None` where it was not wanted.
    pub(crate) fn values(
        &self,
        (average, component): (Average, usize),
        window: Window,
        row: u32,
    ) -> Option<Vec<f64>> {
        Some(match average {
            Average::Normal => {
                let normals = self.row(&self.normals, window, row)?;
                normals.iter().map(|normal| normal[component]).collect()
            }
            Average::Coverage => {
                let coverages = self.row(&self.coverages, window, row)?;
                let shares = coverages.iter().map(|coverage| coverage.share[component]);
                shares.collect()
            }
        })
    }

    /// The pixels in a row of a window.
    fn row<'a, T>(&self, all: &'a [T], window: Window, row: u32) -> Option<&'a [T]> {
        let first = (window.row + row) as usize * self.width + window.col as usize;
        all.get(first..first + window.width as usize)
    }
}
