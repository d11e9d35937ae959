//! The samples of the pixels of a row, taken pixel by pixel.
//!
//! In a crowd eight pixels beside each other see eight balls, and each ball only some of their samples. Eight samples
//! of one pixel see two or three balls, and balls that the pixel does not see are not asked.

use fearless_simd::Simd;

use super::places::{Places, ROWS};
use super::rays::{BLOCK_COLS, BLOCK_ROWS, Place, Spread};
use super::row_samples::RowSamples;
use super::sampler::Sampler;
use super::sums::{Sample, Sums};
use super::supersampling::Supersampling;

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
