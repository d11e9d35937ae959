//! The samples of eight pixels, summed.

use fearless_simd::Simd;

use super::light::Light;
use crate::numeric::lanes::{f64x8, mask64x8};
use crate::picture::tile::RowLight;

/// A sample of each of eight pixels.
#[derive(Clone, Copy)]
pub(super) struct Sample<S: Simd, const CHANNELS: usize> {
    pub(super) light: Light<S, CHANNELS>,
    /// The pixels in which anything is seen, as bits.
    pub(super) covered: u64,
}

impl<S: Simd, const CHANNELS: usize> Sample<S, CHANNELS> {
    /// Stores the only sample that is taken; light below `nothing` counts as none.
    #[inline(always)]
    pub(super) fn store(&self, simd: S, nothing: f64, pixels: &mut RowLight) {
        for channel in 0..CHANNELS {
            pixels.channels[channel] = without(self.light[channel], nothing).into();
        }
        let (one, zero) = (f64x8::splat(simd, 1.0), f64x8::splat(simd, 0.0));
        let covered = mask64x8::from_bitmask(simd, self.covered);
        pixels.alpha = covered.select(one, zero).into();
        pixels.errors = f64x8::splat(simd, f64::INFINITY).into();
    }
}

/// The sums and ranges of some samples of eight pixels.
#[derive(Clone, Copy)]
pub(super) struct Sums<S: Simd, const CHANNELS: usize> {
    sum: Light<S, CHANNELS>,
    low: Light<S, CHANNELS>,
    high: Light<S, CHANNELS>,
    covered: f64x8<S>,
}

impl<S: Simd, const CHANNELS: usize> Sums<S, CHANNELS> {
    #[inline(always)]
    pub(super) fn new(simd: S) -> Self {
        Self {
            sum: [f64x8::splat(simd, 0.0); CHANNELS],
            low: [f64x8::splat(simd, f64::INFINITY); CHANNELS],
            high: [f64x8::splat(simd, f64::NEG_INFINITY); CHANNELS],
            covered: f64x8::splat(simd, 0.0),
        }
    }

    /// Adds a sample of each pixel, which sees something in these pixels, as bits.
    #[inline(always)]
    pub(super) fn add(&mut self, simd: S, light: Light<S, CHANNELS>, covered: u64) {
        let (one, zero) = (f64x8::splat(simd, 1.0), f64x8::splat(simd, 0.0));
        let covered = mask64x8::from_bitmask(simd, covered).select(one, zero);
        self.add_counted(light, covered);
    }

    /// The same, which counts as one where it sees something.
    #[inline(always)]
    pub(super) fn add_counted(&mut self, light: Light<S, CHANNELS>, covered: f64x8<S>) {
        for channel in 0..CHANNELS {
            let light = light[channel];
            let (low, high) = (self.low[channel], self.high[channel]);
            self.sum[channel] += light;
            self.low[channel] = light.simd_lt(low).select(light, low);
            self.high[channel] = light.simd_gt(high).select(light, high);
        }
        self.covered += covered;
    }

    /// The means, and their errors: the spread of the samples over twice the samples per side. Alpha is one more
    /// channel, times what an error of it counts as. Numbers below `nothing` count as 0.
    #[inline(always)]
    pub(super) fn store(
        self,
        simd: S,
        side: u32,
        (of_alpha, nothing): (f64, f64),
        pixels: &mut RowLight,
    ) {
        let count = (u64::from(side) * u64::from(side)) as f64;
        let zero = f64x8::splat(simd, 0.0);
        let mut spread = zero;
        if of_alpha > 0.0 {
            let all = f64x8::splat(simd, count);
            let partly = self.covered.simd_gt(zero) & self.covered.simd_lt(all);
            spread = partly.select(f64x8::splat(simd, of_alpha), zero);
        }
        for channel in 0..CHANNELS {
            let range = self.high[channel] - self.low[channel];
            spread = range.simd_gt(spread).select(range, spread);
            // Equal samples are their mean, which rounding would move.
            let mean = self.sum[channel] * (1.0 / count);
            let mean = range.simd_eq(zero).select(self.low[channel], mean);
            pixels.channels[channel] = without(mean, nothing).into();
        }
        pixels.alpha = (self.covered / count).into();
        pixels.errors = without(spread / (2.0 * f64::from(side)), nothing).into();
    }
}

/// Numbers that are at least 0, those below `nothing` as 0.
#[inline(always)]
fn without<S: Simd>(number: f64x8<S>, nothing: f64) -> f64x8<S> {
    let zero = f64x8::splat(number.simd(), 0.0);
    number.simd_lt(nothing).select(zero, number)
}
