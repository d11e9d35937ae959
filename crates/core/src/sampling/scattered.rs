//! The mean over one pixel by random samples in strata.

use fearless_simd::{Simd, dispatch};
use glam::DVec3;

use super::light::{Light, splat};
use super::rays::{Place, Rays};
use super::supersampling::{ROWS, Sampler, Scratch, Supersampling};
use super::trace::RayRow;
use crate::model::camera::Projection;
use crate::model::color::Color;
use crate::model::roughness::PixelKey;
use crate::numeric::lanes::{LANES, mask64x8};
use crate::numeric::vectors::Vectors;
use crate::picture::image::Channels;
use crate::picture::tile::Tile;

/// The sums over pairs of random samples of a pixel, two in each stratum.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Pairs {
    /// The mean light.
    pub(crate) value: Color,
    /// The share of the samples that see a sphere.
    pub(crate) alpha: f64,
    /// The number of samples.
    pub(crate) count: u64,
    /// The sums of the squared differences in the pairs: of light, and of what alpha is the mean of.
    pub(crate) squares: Color,
    pub(crate) squares_of_alpha: f64,
}

impl Pairs {
    /// Adds eight samples, the first of four pairs and then the others.
    #[inline(always)]
    fn add<S: Simd, const CHANNELS: usize>(&mut self, light: &Light<S, CHANNELS>, covered: u64) {
        const HALF: usize = LANES / 2;
        for channel in 0..CHANNELS {
            let light: [f64; LANES] = light[channel].into();
            for pair in 0..HALF {
                let (one, other) = (light[pair], light[pair + HALF]);
                self.value[channel] += one + other;
                self.squares[channel] += (one - other) * (one - other);
            }
        }
        let apart = (covered ^ covered >> HALF) & 0xf;
        self.alpha += f64::from(covered.count_ones());
        self.squares_of_alpha += f64::from(apart.count_ones());
    }

    /// The means, after sums.
    fn divide(mut self, channels: Channels, count: u64) -> Self {
        if channels == Channels::Grey {
            self.value = Color::splat(self.value.x);
            self.squares = Color::splat(self.squares.x);
        }
        self.count = count;
        self.value /= count as f64;
        self.alpha /= count as f64;
        self
    }
}

impl Supersampling<'_> {
    /// Takes two random samples in each of `side` × `side` strata of a pixel, a multiple of 2, of which something is seen.
    ///
    /// The places depend on the pixel's column and row alone.
    pub(crate) fn scattered(&self, key: PixelKey, side: u32) -> Pairs {
        match self.channels {
            Channels::Grey => self.scattered_channels::<1>(key, side),
            Channels::Rgb => self.scattered_channels::<3>(key, side),
        }
    }

    fn scattered_channels<const CHANNELS: usize>(&self, key: PixelKey, side: u32) -> Pairs {
        let mut pairs = Pairs {
            value: Color::ZERO,
            alpha: 0.0,
            count: 0,
            squares: Color::ZERO,
            squares_of_alpha: 0.0,
        };
        let rays = self.rays.scattered(side);
        dispatch!(self.level, simd => self.add_scattered::<_, CHANNELS>(simd, &rays, (key, side), &mut pairs));
        pairs.divide(self.channels, 2 * u64::from(side) * u64::from(side))
    }

    #[inline(always)]
    fn add_scattered<S: Simd, const CHANNELS: usize>(
        &self,
        simd: S,
        rays: &Rays,
        (key, side): (PixelKey, u32),
        pairs: &mut Pairs,
    ) {
        let tile = Tile {
            col: key.col,
            row: key.row,
            width: 1,
            height: 1,
        };
        let Scratch {
            balls,
            cells,
            geometry,
            ..
        } = &mut Scratch::default();
        self.gather(simd, rays, tile, balls);
        let Some(mut sampler) = self.sampler(rays, tile, balls, (cells, geometry)) else {
            return;
        };
        let Sampler {
            tracer,
            groups,
            looks,
            shadows,
            ..
        } = &mut sampler;
        let background: Light<S, CHANNELS> = splat(simd, self.background());
        let mut rows = [RayRow::new(simd, Vectors::splat(simd, DVec3::ZERO)); ROWS];
        for cell_row in 0..side / 2 {
            for cell_col in 0..side / 2 {
                let place = Place {
                    col: key.col,
                    row: key.row,
                    cell_col,
                    cell_row,
                    is_scattered: true,
                };
                let sight = if rays.projection() == Projection::Parallel {
                    tracer.look_along(simd, place, groups)
                } else {
                    rows[0] = RayRow::new(simd, rays.scattered_directions(simd, place));
                    tracer.search(simd, &mut rows);
                    tracer.look(simd, place, &rows[0], groups)
                };
                let mut light = background;
                if sight.covered != 0 {
                    looks.see(&self.shading, groups);
                    let seen = (&sight, &*groups, &mut *looks);
                    let seen: Light<S, CHANNELS> = self.shading.light(simd, seen, place, shadows);
                    let covered = mask64x8::from_bitmask(simd, sight.covered);
                    for channel in 0..CHANNELS {
                        light[channel] = covered.select(seen[channel], light[channel]);
                    }
                }
                pairs.add::<S, CHANNELS>(&light, sight.covered);
            }
        }
    }
}
