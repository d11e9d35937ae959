//! The plain mean over moments.

use std::num::NonZeroU32;

use super::band::paint_band;
use super::instants::{GROUP, Instant, Instants};
use crate::model::color::Color;
use crate::model::world::World;
use crate::picture::band::Band;
use crate::picture::pixel::{Evidence, Pixel, Status, Work};
use crate::picture::progress::{Cancelled, Progress};
use crate::picture::tile::Tile;
use crate::sampling::{Scratch, Supersampling};

/// The mean over the midpoints of N equal parts of the time, at each of which pixels are the means of
/// N × N samples.
///
/// # Accuracy
/// An estimate: the mean of the moments' own, and the spread of the moments over 2N.
#[derive(Debug)]
pub(crate) struct SampledOverTime<'scene> {
    world: &'scene World,
    instants: Instants<'scene>,
    samples: NonZeroU32,
    alpha: bool,
}

/// The sums over some moments of a pixel.
#[derive(Clone, Copy)]
struct MomentSum {
    first: Pixel,
    /// Sums of differences from the first.
    value: Color,
    alpha: f64,
    error: f64,
    low: Color,
    high: Color,
    least_alpha: f64,
    greatest_alpha: f64,
}

impl<'scene> SampledOverTime<'scene> {
    pub(crate) fn new(
        world: &'scene World,
        instants: Instants<'scene>,
        samples: NonZeroU32,
        alpha: bool,
    ) -> Self {
        Self {
            world,
            instants,
            samples,
            alpha,
        }
    }

    /// Writes all pixels of a band; returns what they cost.
    pub(crate) fn paint_band(
        &self,
        band: &mut Band<'_>,
        scratch: &mut Scratch,
        progress: &Progress<'_>,
    ) -> Result<Work, Cancelled> {
        paint_band(band, progress, |part| self.pixels(part, scratch, progress))
    }

    /// The pixels of a rectangle as high as a tile, tile by tile.
    pub(super) fn pixels(
        &self,
        area: Tile,
        scratch: &mut Scratch,
        progress: &Progress<'_>,
    ) -> Result<(Vec<Pixel>, Work), Cancelled> {
        let count = self.samples.get();
        let times: Vec<f64> = (0..count)
            .map(|moment| (f64::from(moment) + 0.5) / f64::from(count) - 0.5)
            .collect();
        let mut sums: Vec<MomentSum> = Vec::new();
        let mut work = Work::default();
        for (group, times) in times.chunks(GROUP).enumerate() {
            self.instants.with(group, times, |instants| {
                for Instant { view, index } in instants {
                    let (samples, alpha) = (self.samples, self.alpha);
                    let integrator =
                        Supersampling::of_all_light(self.world, view, index, samples, alpha);
                    let mut pixels = Vec::with_capacity(area.count() as usize);
                    for tile in area.tiles() {
                        work += integrator.integrate(tile, scratch, &mut pixels);
                        if progress(0).is_break() {
                            return Err(Cancelled);
                        }
                    }
                    if sums.is_empty() {
                        sums.extend(pixels.into_iter().map(MomentSum::new));
                    } else {
                        for (sum, pixel) in sums.iter_mut().zip(&pixels) {
                            sum.add(pixel);
                        }
                    }
                }
                Ok(())
            })?;
        }
        let pixels = sums.iter().map(|sum| sum.mean(count, self.alpha)).collect();
        Ok((pixels, work))
    }
}

impl MomentSum {
    fn new(first: Pixel) -> Self {
        Self {
            first,
            value: Color::ZERO,
            alpha: 0.0,
            error: first.error,
            low: first.value,
            high: first.value,
            least_alpha: first.alpha,
            greatest_alpha: first.alpha,
        }
    }

    fn add(&mut self, pixel: &Pixel) {
        self.value += pixel.value + self.first.value * -1.0;
        self.alpha += pixel.alpha - self.first.alpha;
        self.error += pixel.error;
        self.low = self.low.min(pixel.value);
        self.high = self.high.max(pixel.value);
        self.least_alpha = self.least_alpha.min(pixel.alpha);
        self.greatest_alpha = self.greatest_alpha.max(pixel.alpha);
    }

    fn mean(&self, count: u32, alpha: bool) -> Pixel {
        let count = f64::from(count);
        let range = self.high + self.low * -1.0;
        let of_alpha = if alpha {
            self.greatest_alpha - self.least_alpha
        } else {
            0.0
        };
        let spread = of_alpha.max(range.max_element());
        Pixel {
            value: self.first.value + self.value * (1.0 / count),
            alpha: self.first.alpha + self.alpha / count,
            error: self.error / count + spread / (2.0 * count),
            evidence: Evidence::Estimate,
            status: Status::NoTolerance,
        }
    }
}
