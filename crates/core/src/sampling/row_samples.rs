//! The samples of the pixels of a row, until they are summed.

use fearless_simd::Simd;

use super::rays::{BLOCK_COLS, Place};
use super::sums::{Sample, Sums};
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
    pub(super) fn reset(&mut self, side: u32, channels: usize) {
        self.side = side as usize;
        self.count = self.side * self.side;
        self.numbers.clear();
        self.numbers
            .resize((channels + 1) * LANES * self.count, 0.0);
    }

    /// Stores eight samples of the pixel in this column of the tile.
    #[inline(always)]
    pub(super) fn store<S: Simd, const CHANNELS: usize>(
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
            if width == COLS {
                self.numbers[first..first + COLS].copy_from_slice(numbers);
            } else {
                self.numbers[first..first + width].copy_from_slice(&numbers[..width]);
            }
        }
    }

    /// Adds all samples, cell by cell.
    #[inline(always)]
    pub(super) fn sum<S: Simd, const CHANNELS: usize>(
        &self,
        simd: S,
        sums: &mut Sums<S, CHANNELS>,
    ) {
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
