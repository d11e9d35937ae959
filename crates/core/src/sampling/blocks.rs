//! The samples of the pixels of a row, taken pixel by pixel.
//!
//! In a crowd eight pixels beside each other see eight balls, and each ball only some of their samples. Eight samples
//! of one pixel see two or three balls, and balls that the pixel does not see are not asked.

use fearless_simd::Simd;

use super::rays::{BLOCK_COLS, BLOCK_ROWS, Place, Spread};
use super::sampler::{Places, Sampler};
use super::sums::{Sample, Sums};
use super::supersampling::{ROWS, Supersampling};
use crate::numeric::lanes::{LANES, f64x8, mask64x8};

/// The samples of eight pixels of a row.
#[derive(Debug, Default)]
pub(super) struct RowSamples {
    /// For each channel, and for whether anything is seen, 1 or 0: for each pixel its cells, row by row.
    numbers: Vec<f64>,
    /// Cells on a side of a pixel, and in a pixel.
    side: usize,
    count: usize,
}

impl RowSamples {
    /// Makes place for samples.
    fn reset(&mut self, side: u32, channels: usize) {
        self.side = side as usize;
        self.count = self.side * self.side;
        self.numbers.clear();
        self.numbers
            .resize((channels + 1) * LANES * self.count, 0.0);
    }

    /// Stores eight samples of the pixel in this column of the tile.
    #[inline(always)]
    fn store<S: Simd, const CHANNELS: usize>(
        &mut self,
        simd: S,
        place: Place,
        column: usize,
        sample: &Sample<S, CHANNELS>,
    ) {
        for channel in 0..CHANNELS {
            self.store_numbers(place, (channel, column), &sample.light[channel].into());
        }
        let (one, zero) = (f64x8::splat(simd, 1.0), f64x8::splat(simd, 0.0));
        let covered = mask64x8::from_bitmask(simd, sample.covered).select(one, zero);
        self.store_numbers(place, (CHANNELS, column), &covered.into());
    }

    /// Stores a number of each of eight samples; those beyond the last cells are left out.
    #[inline(never)]
    fn store_numbers(
        &mut self,
        place: Place,
        (channel, column): (usize, usize),
        numbers: &[f64; LANES],
    ) {
        const COLS: usize = BLOCK_COLS as usize;
        let (col, row) = (place.cell_col as usize, place.cell_row as usize);
        let width = COLS.min(self.side - col);
        for (row, numbers) in (row..self.side).zip(numbers.chunks_exact(COLS)) {
            let first = ((channel * LANES + column) * self.side + row) * self.side + col;
            for (cell, &number) in self.numbers[first..].iter_mut().zip(&numbers[..width]) {
                *cell = number;
            }
        }
    }

    /// Adds all samples, cell by cell.
    #[inline(always)]
    fn sum<S: Simd, const CHANNELS: usize>(&self, simd: S, sums: &mut Sums<S, CHANNELS>) {
        for cell in 0..self.count {
            let mut light = [f64x8::splat(simd, 0.0); CHANNELS];
            for (channel, light) in light.iter_mut().enumerate() {
                *light = f64x8::from_array(simd, self.of_cell(channel, cell));
            }
            let covered = f64x8::from_array(simd, self.of_cell(CHANNELS, cell));
            sums.add_counted(light, covered);
        }
    }

    /// The numbers of a cell in all pixels.
    #[inline(never)]
    fn of_cell(&self, channel: usize, cell: usize) -> [f64; LANES] {
        let numbers = &self.numbers[channel * LANES * self.count..][..LANES * self.count];
        let mut of_pixels = [0.0; LANES];
        for (pixel, number) in of_pixels.iter_mut().enumerate() {
            *number = numbers[pixel * self.count + cell];
        }
        of_pixels
    }
}

impl Supersampling<'_> {
    /// Takes and adds `side` × `side` samples of each pixel in a row of the sampler's tile.
    #[inline(never)]
    pub(super) fn sample_blocks<'tile, S: Simd, const CHANNELS: usize>(
        &'tile self,
        simd: S,
        (row, side): (u32, u32),
        nothing: &Sample<S, CHANNELS>,
        (sampler, found): (&mut Sampler<'tile>, &mut RowSamples),
        sums: &mut Sums<S, CHANNELS>,
    ) {
        let tile = sampler.tracer.tile;
        let mut place = Place {
            col: tile.col,
            row: tile.row + row,
            cell_col: 0,
            cell_row: 0,
            spread: Spread::Block,
        };
        found.reset(side, CHANNELS);
        let mut places = Places::in_row(place, row);
        let mut samples = [*nothing; ROWS];
        let blocks = [side.div_ceil(BLOCK_COLS), side.div_ceil(BLOCK_ROWS)];
        for column in 0..tile.width {
            place.col = tile.col + column;
            for block in 0..blocks[0] * blocks[1] {
                place.cell_col = block % blocks[0] * BLOCK_COLS;
                place.cell_row = block / blocks[0] * BLOCK_ROWS;
                places.add(place, column);
                let is_last = column + 1 == tile.width && block + 1 == blocks[0] * blocks[1];
                if places.is_full() || is_last {
                    self.sample_places(simd, &places, nothing, sampler, &mut samples);
                    for (&place, sample) in places.as_slice().iter().zip(&samples) {
                        found.store(simd, place, (place.col - tile.col) as usize, sample);
                    }
                    places.clear();
                }
            }
        }
        found.sum(simd, sums);
    }
}
