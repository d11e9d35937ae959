//! Whole rows of a picture, while they are written.

use super::pixel::{Evidence, Pixel, Status};
use super::plane::{PlaneBand, fill};
use super::tile::{Tile, TileLight};
use crate::model::color::Color;

/// Whole rows of a picture, to be written by one thread.
pub(crate) struct Band<'image> {
    pub(crate) area: Tile,
    /// Numbers of a pixel: its channels, and its alpha where there is one.
    pub(super) stride: usize,
    pub(super) values: &'image mut [f64],
    pub(super) errors: PlaneBand<'image, f64>,
    pub(super) evidence: PlaneBand<'image, Evidence>,
    pub(super) statuses: PlaneBand<'image, Status>,
    /// Values and errors are 0 where nothing was written.
    pub(super) is_blank: bool,
}

impl Band<'_> {
    /// Writes the pixels of a tile inside the band, which come in the order of
    /// [`Tile::pixels`].
    pub(crate) fn write(&mut self, tile: Tile, pixels: &[Pixel]) {
        for ((col, row), pixel) in tile.pixels().zip(pixels) {
            let index = self.index(col, row);
            let values = &mut self.values[index * self.stride..][..self.stride];
            put(values, pixel);
            self.errors.write(index, &[pixel.error]);
            self.evidence.write(index, &[pixel.evidence]);
            self.statuses.write(index, &[pixel.status]);
        }
    }

    /// Writes the same pixel all over a tile inside the band.
    pub(crate) fn write_same(&mut self, tile: Tile, pixel: &Pixel) {
        let (width, stride) = (tile.width as usize, self.stride);
        for row in tile.row..tile.row + tile.height {
            let index = self.index(tile.col, row);
            let values = &mut self.values[index * stride..][..width * stride];
            if stride == 1 {
                fill(values, pixel.value.x);
            } else {
                for values in values.chunks_exact_mut(stride) {
                    put(values, pixel);
                }
            }
            self.errors.fill(index, width, pixel.error);
            self.evidence.fill(index, width, pixel.evidence);
            self.statuses.fill(index, width, pixel.status);
        }
    }

    /// Writes the light of a tile inside the band; all pixels end alike.
    pub(crate) fn write_light(&mut self, tile: Tile, light: &TileLight) {
        let width = tile.width as usize;
        let stride = self.stride;
        for row in 0..tile.height {
            let index = self.index(tile.col, tile.row + row);
            let light = light.row(row);
            let values = &mut self.values[index * stride..][..width * stride];
            match (stride, &light.channels) {
                (1, [grey, ..]) => copy(values, grey),
                (2, [grey, ..]) => interleave(values, [grey, &light.alpha]),
                (3, [red, green, blue]) => interleave(values, [red, green, blue]),
                (_, [red, green, blue]) => interleave(values, [red, green, blue, &light.alpha]),
            }
            self.errors.write(index, &light.errors[..width]);
        }
    }

    /// Writes light that is the same in all pixels of a tile inside the band, and in which nothing
    /// covers them.
    pub(crate) fn write_even_light(&mut self, tile: Tile, color: Color, error: f64) {
        let (width, stride) = (tile.width as usize, self.stride);
        for row in tile.row..tile.row + tile.height {
            let index = self.index(tile.col, row);
            let values = &mut self.values[index * stride..][..width * stride];
            if color != Color::ZERO {
                // The background is left out of a picture with alpha: there are channels only.
                for pixel in values.chunks_exact_mut(stride) {
                    pixel.copy_from_slice(&color.as_ref()[..stride]);
                }
            } else if !self.is_blank {
                for values in values.chunks_mut(Tile::SIDE as usize) {
                    fill(values, 0.0);
                }
            }
            if error != 0.0 || !self.is_blank {
                self.errors.fill(index, width, error);
            }
        }
    }

    fn index(&self, col: u32, row: u32) -> usize {
        let (col, row) = (col - self.area.col, row - self.area.row);
        row as usize * self.area.width as usize + col as usize
    }
}

/// Writes the numbers of a pixel: its channels, then alpha where there is a place for it.
#[inline]
fn put(values: &mut [f64], pixel: &Pixel) {
    let Color { x, y, z } = pixel.value;
    match values {
        [grey] => *grey = x,
        [grey, alpha] => (*grey, *alpha) = (x, pixel.alpha),
        [red, green, blue, alpha @ ..] => {
            (*red, *green, *blue) = (x, y, z);
            alpha.fill(pixel.alpha);
        }
        [] => {}
    }
}

/// Writes a number of every pixel of a row. Most rows are whole: a copy of a known length is a few
/// instructions, and not worth a call.
#[inline(always)]
fn copy(values: &mut [f64], part: &[f64; Tile::SIDE as usize]) {
    if values.len() == part.len() {
        for (value, number) in values.iter_mut().zip(part) {
            *value = *number;
        }
    } else {
        copy_some(values, part);
    }
}

#[cold]
#[inline(never)]
fn copy_some(values: &mut [f64], part: &[f64; Tile::SIDE as usize]) {
    values.copy_from_slice(&part[..values.len()]);
}

/// Writes some numbers of every pixel, pixel by pixel.
fn interleave<const COUNT: usize>(values: &mut [f64], parts: [&[f64; Tile::SIDE as usize]; COUNT]) {
    let (pixels, _) = values.as_chunks_mut::<COUNT>();
    for (place, pixel) in pixels.iter_mut().enumerate() {
        *pixel = parts.map(|part| part[place]);
    }
}
