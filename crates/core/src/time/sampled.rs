//! The plain mean over moments.

use std::num::NonZeroU32;
use std::ops::ControlFlow;

use super::instants::Instants;
use super::instants::{GROUP, Instant};
use super::paint_band;
use crate::model::color::Color;
use crate::model::world::World;
use crate::picture::image::Band;
use crate::picture::integrator::Integrator;
use crate::picture::pixel::Cancelled;
use crate::picture::pixel::{Evidence, Pixel, Status, Work};
use crate::picture::tile::Tile;
use crate::sampling::Supersampling;

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

/// What is known of a pixel after some moments.
#[derive(Clone, Copy)]
struct Sum {
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

    /// The pixels of a rectangle as high as a tile, tile by tile.
    fn pixels(
        &self,
        area: Tile,
        progress: &(dyn Fn(u64) -> ControlFlow<()> + Sync),
    ) -> Result<(Vec<Pixel>, Work), Cancelled> {
        let count = self.samples.get();
        let times: Vec<f64> = (0..count)
            .map(|moment| (f64::from(moment) + 0.5) / f64::from(count) - 0.5)
            .collect();
        let mut sums: Vec<Sum> = Vec::new();
        let mut work = Work::default();
        let mut room = Default::default();
        for (group, times) in times.chunks(GROUP).enumerate() {
            self.instants.with(group, times, |instants| {
                for Instant { view, seen } in instants {
                    let (samples, alpha) = (self.samples, self.alpha);
                    let integrator = Supersampling::new(self.world, view, seen, samples, alpha);
                    let mut pixels = Vec::with_capacity(area.count() as usize);
                    for tile in area.tiles() {
                        work += integrator.integrate(tile, &mut room, &mut pixels);
                        if progress(0).is_break() {
                            return Err(Cancelled);
                        }
                    }
                    if sums.is_empty() {
                        sums.extend(pixels.into_iter().map(Sum::new));
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

impl Sum {
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

impl Integrator for SampledOverTime<'_> {
    type Room = ();

    fn integrate(&self, tile: Tile, _: &mut (), pixels: &mut Vec<Pixel>) -> Work {
        let go = |_| ControlFlow::Continue(());
        let Ok((found, work)) = self.pixels(tile, &go) else {
            return Work::default();
        };
        pixels.extend(found);
        work
    }

    fn paint_band(
        &self,
        band: &mut Band<'_>,
        (): &mut (),
        progress: &(dyn Fn(u64) -> ControlFlow<()> + Sync),
    ) -> Result<Work, Cancelled> {
        paint_band(band, progress, |part| self.pixels(part, progress))
    }
}
