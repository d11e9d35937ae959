//! Plain supersampling: the yardstick for everything cleverer.
//!
//! Tiles are small, and their rays go side by side: [`near`] finds the spheres that matter in a
//! tile, [`trace`] what eight rays see of them, [`light`] how bright that is, and [`shadow`] where
//! it is dark. All of it decides exactly or leaves the decision to what does, and computes with
//! one rounding an operation, so that a picture is the same to the bit on any processor, and
//! however it is cut into tiles.

mod light;
mod near;
mod rays;
mod shadow;
mod trace;

use std::num::NonZeroU32;

use fearless_simd::prelude::*;
use fearless_simd::{Level, Simd, dispatch, f64x8, mask64x8};
use glam::DVec3;

use self::light::{Light, Looks, Shading, splat};
use self::near::Nearby;
use self::rays::{Place, Rays};
use self::shadow::Shadows;
use self::trace::{Groups, RayRow, Tracer};
use crate::model::color::Color;
use crate::model::roughness::PixelKey;
use crate::model::view::View;
use crate::model::world::World;
use crate::numeric::vectors::Vectors;
use crate::picture::image::{Band, Channels, Prospect};
use crate::picture::integrator::Integrator;
use crate::picture::pixel::{Evidence, Pixel, Status, Work};
use crate::picture::tile::RowLight;
use crate::picture::tile::{Tile, TileLight};
use crate::search::seen::Seen;

/// The mean over the midpoints of a regular N × N division of every pixel.
///
/// # Accuracy
/// An estimate: the spread of the samples over 2N, which is what one straight edge along the
/// grid costs at the worst. An edge that passes between the samples and the pixel's border is not
/// in it, which happens in one edge pixel of five, and then costs less than 1/(2N) too; the largest
/// estimate of a picture covers its largest error. `tests/src/truth.rs` measures all three. One
/// sample alone says nothing: its error is infinite.
#[derive(Clone, Debug)]
pub(crate) struct Supersampling<'scene> {
    seen: Seen<'scene>,
    samples: NonZeroU32,
    channels: Channels,
    alpha: bool,
    rays: Rays,
    shading: Shading<'scene>,
    view: View,
    /// What the processor can do.
    level: Level,
}

impl<'scene> Supersampling<'scene> {
    /// Prepares `samples` × `samples` points in every pixel; with `alpha` the background sends
    /// no light.
    pub(crate) fn new(
        world: &'scene World,
        view: &View,
        seen: &Seen<'scene>,
        samples: NonZeroU32,
        alpha: bool,
    ) -> Self {
        Self {
            seen: seen.clone(),
            samples,
            channels: Channels::of(world, alpha),
            alpha,
            rays: Rays::new(view, samples.get()),
            shading: Shading::new(world, view.frame),
            view: *view,
            level: Level::new(),
        }
    }

    /// What is known of all pixels before they are sampled.
    pub(crate) fn prospect(samples: NonZeroU32) -> Prospect {
        Prospect {
            error: (samples.get() == 1).then_some(f64::INFINITY),
            ending: Some((Evidence::Estimate, Status::NoTolerance)),
        }
    }

    /// A pixel for which a tolerance was asked that cannot be met.
    pub(crate) fn pixel_of_last_resort(&self, key: PixelKey) -> Pixel {
        let PixelKey { col, row, .. } = key;
        let (width, height) = (1, 1);
        let tile = Tile {
            col,
            row,
            width,
            height,
        };
        let mut pixels = Vec::with_capacity(1);
        Integrator::integrate(self, tile, &mut Room::default(), &mut pixels);
        Pixel {
            status: Status::OutOfBudget,
            ..pixels[0]
        }
    }

    /// What rays that meet nothing see.
    fn background(&self) -> Color {
        if self.alpha {
            Color::ZERO
        } else {
            self.shading.world.background
        }
    }

    /// Averages the light of a tile; how many balls were asked whether eight rays meet them, or
    /// none, and no light, where all rays meet nothing.
    fn sample(&self, tile: Tile, room: &mut Room) -> Option<u64> {
        match self.channels {
            Channels::Grey => self.sample_channels::<1>(tile, room),
            Channels::Rgb => self.sample_channels::<3>(tile, room),
        }
    }

    fn sample_channels<const CHANNELS: usize>(&self, tile: Tile, room: &mut Room) -> Option<u64> {
        // Most pictures have empty tiles.
        self.seen.balls(tile).next()?;
        dispatch!(self.level, simd => self.sample_lanes::<_, CHANNELS>(simd, tile, room))
    }

    /// What a tile cost, from the tests of eight rays.
    fn work(&self, tile: Tile, tests: u64) -> Work {
        let side = u64::from(self.samples.get());
        let width = u64::from(tile.width);
        Work {
            samples: width * u64::from(tile.height) * side * side,
            lines: 0,
            candidate_tests: tests * width,
        }
    }

    /// The error of a pixel whose samples are all the same.
    fn error_of_equal_samples(&self) -> f64 {
        if self.samples.get() == 1 {
            f64::INFINITY
        } else {
            0.0
        }
    }

    /// One of the pixels of a tile's light.
    fn pixel(&self, light: &TileLight, col: u32, row: u32) -> Pixel {
        let (row, place) = (light.row(row), col as usize);
        let [red, green, blue] = row.channels.map(|channel| channel[place]);
        Pixel {
            value: match self.channels {
                Channels::Grey => Color::splat(red),
                Channels::Rgb => Color::new(red, green, blue),
            },
            alpha: row.alpha[place],
            error: row.errors[place],
            evidence: Evidence::Estimate,
            status: Status::NoTolerance,
        }
    }

    /// Averages the light of a tile, eight pixels side by side.
    #[inline(always)]
    fn sample_lanes<S: Simd, const CHANNELS: usize>(
        &self,
        simd: S,
        tile: Tile,
        Room { nearby, light }: &mut Room,
    ) -> Option<u64> {
        let world = self.shading.world;
        let bundle = self.rays.bundle(tile);
        let cells = self.rays.cells_on_unit();
        nearby.gather(simd, cells, &bundle, self.seen.balls(tile));
        let first = nearby.balls.first()?;
        let mut tracer = Tracer {
            seen: &self.seen,
            rays: &self.rays,
            nearby,
            tile,
            tests: 0,
            candidates: Vec::new(),
        };
        let mut groups = Groups::new(first);
        let mut looks = Looks::new(&self.shading);
        let mut shadows = world.shadows.then(|| {
            let length = libm::scalbn(1.0, self.seen.length_exponent());
            Shadows::new(self.seen.visibility, self.view.camera.position, length)
        });
        let background = self.background();
        let background: Light<S, CHANNELS> = splat(simd, background);
        let side = self.samples.get();
        let height = tile.height as usize;
        let dark = RayRow::new(simd, Vectors::splat(simd, DVec3::ZERO));
        let mut rows = [dark; Tile::SIDE as usize];
        let nothing = Sample {
            light: background,
            covered: 0,
        };
        let mut samples = [nothing; Tile::SIDE as usize];
        let mut sums = None;
        if side > 1 {
            sums = Some([Sums::<S, CHANNELS>::new(simd); Tile::SIDE as usize]);
        }
        for cell_row in 0..side {
            for cell_col in 0..side {
                let mut place = Place {
                    col: tile.col,
                    row: tile.row,
                    cell_col,
                    cell_row,
                };
                let across = self.rays.across(simd, place, tile.width);
                for row in &mut rows[..height] {
                    *row = RayRow::new(simd, self.rays.directions(across, place));
                    place.row += 1;
                }
                tracer.search(simd, &mut rows);
                place.row = tile.row;
                for (row, sample) in rows[..height].iter().zip(&mut samples) {
                    let sight = tracer.look(simd, place, row, &mut groups);
                    *sample = nothing;
                    if sight.covered != 0 {
                        looks.see(&self.shading, &groups);
                        let seen = (&sight, &groups, &mut looks);
                        let light: Light<S, CHANNELS> =
                            self.shading.light(simd, seen, place, &mut shadows);
                        let covered = mask64x8::from_bitmask(simd, sight.covered);
                        for channel in 0..CHANNELS {
                            sample.light[channel] =
                                covered.select(light[channel], background[channel]);
                        }
                        sample.covered = sight.covered;
                    }
                    place.row += 1;
                }
                if let Some(sums) = &mut sums {
                    for (sums, sample) in sums.iter_mut().zip(&samples) {
                        sums.add(simd, sample.light, sample.covered);
                    }
                }
            }
        }
        for row in 0..height {
            let pixels = light.row_mut(row as u32);
            match &sums {
                Some(sums) => sums[row].store(simd, side, self.alpha, pixels),
                None => samples[row].store(simd, pixels),
            }
        }
        Some(tracer.tests)
    }
}

/// Memory to work in.
#[derive(Debug, Default)]
pub(crate) struct Room {
    nearby: Nearby,
    light: TileLight,
}

/// A sample of each of eight pixels.
#[derive(Clone, Copy)]
struct Sample<S: Simd, const CHANNELS: usize> {
    light: Light<S, CHANNELS>,
    /// The pixels in which anything is seen, as bits.
    covered: u64,
}

impl<S: Simd, const CHANNELS: usize> Sample<S, CHANNELS> {
    /// Stores the only sample that is taken.
    #[inline(always)]
    fn store(&self, simd: S, pixels: &mut RowLight) {
        for channel in 0..CHANNELS {
            self.light[channel].store_slice(&mut pixels.channels[channel]);
        }
        let (one, zero) = (f64x8::splat(simd, 1.0), f64x8::splat(simd, 0.0));
        let covered = mask64x8::from_bitmask(simd, self.covered);
        covered.select(one, zero).store_slice(&mut pixels.alpha);
        f64x8::splat(simd, f64::INFINITY).store_slice(&mut pixels.errors);
    }
}

/// What is known of eight pixels after some samples.
#[derive(Clone, Copy)]
struct Sums<S: Simd, const CHANNELS: usize> {
    sum: Light<S, CHANNELS>,
    low: Light<S, CHANNELS>,
    high: Light<S, CHANNELS>,
    covered: f64x8<S>,
}

impl<S: Simd, const CHANNELS: usize> Sums<S, CHANNELS> {
    #[inline(always)]
    fn new(simd: S) -> Self {
        Self {
            sum: [f64x8::splat(simd, 0.0); CHANNELS],
            low: [f64x8::splat(simd, f64::INFINITY); CHANNELS],
            high: [f64x8::splat(simd, f64::NEG_INFINITY); CHANNELS],
            covered: f64x8::splat(simd, 0.0),
        }
    }

    #[inline(always)]
    fn add(&mut self, simd: S, light: Light<S, CHANNELS>, covered: u64) {
        for channel in 0..CHANNELS {
            let light = light[channel];
            let (low, high) = (self.low[channel], self.high[channel]);
            self.sum[channel] += light;
            self.low[channel] = light.simd_lt(low).select(light, low);
            self.high[channel] = light.simd_gt(high).select(light, high);
        }
        let (one, zero) = (f64x8::splat(simd, 1.0), f64x8::splat(simd, 0.0));
        self.covered += mask64x8::from_bitmask(simd, covered).select(one, zero);
    }

    /// The means, and their errors: the spread of the samples, alpha being one more channel, over
    /// twice the samples a side.
    #[inline(always)]
    fn store(self, simd: S, side: u32, alpha: bool, pixels: &mut RowLight) {
        let count = (u64::from(side) * u64::from(side)) as f64;
        let (one, zero) = (f64x8::splat(simd, 1.0), f64x8::splat(simd, 0.0));
        let mut spread = zero;
        if alpha {
            let all = f64x8::splat(simd, count);
            let partly = self.covered.simd_gt(zero) & self.covered.simd_lt(all);
            spread = partly.select(one, zero);
        }
        for channel in 0..CHANNELS {
            let range = self.high[channel] - self.low[channel];
            spread = range.simd_gt(spread).select(range, spread);
            // Equal samples are their mean, which rounding would move.
            let mean = self.sum[channel] * (1.0 / count);
            let mean = range.simd_eq(zero).select(self.low[channel], mean);
            mean.store_slice(&mut pixels.channels[channel]);
        }
        (self.covered / count).store_slice(&mut pixels.alpha);
        (spread / (2.0 * f64::from(side))).store_slice(&mut pixels.errors);
    }
}

impl Integrator for Supersampling<'_> {
    type Room = Room;

    fn integrate(&self, tile: Tile, room: &mut Room, pixels: &mut Vec<Pixel>) -> Work {
        let tests = self.sample(tile, room);
        let light = &mut room.light;
        if tests.is_none() {
            light.fill(self.background(), self.error_of_equal_samples());
        }
        let tile_pixels = tile.pixels();
        let pixel = |(col, row)| self.pixel(light, col - tile.col, row - tile.row);
        pixels.extend(tile_pixels.map(pixel));
        self.work(tile, tests.unwrap_or(0))
    }

    fn paint(&self, tile: Tile, room: &mut Room, band: &mut Band<'_>) -> Work {
        let tests = self.sample(tile, room);
        if tests.is_some() {
            band.write_light(tile, &room.light);
        } else {
            band.write_even_light(tile, self.background(), self.error_of_equal_samples());
        }
        self.work(tile, tests.unwrap_or(0))
    }
}

#[cfg(test)]
mod tests;
