//! The mean over one pixel by random samples in strata.

use fearless_simd::{Simd, dispatch};

use super::light::splat;
use super::places::{Places, ROWS};
use super::rays::{Place, Rays, Spread};
use super::sums::Sample;
use super::supersampling::{Scratch, Supersampling};
use crate::model::color::Color;
use crate::model::roughness::PixelKey;
use crate::numeric::lanes::LANES;
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
    fn add<S: Simd, const CHANNELS: usize>(&mut self, samples: &Sample<S, CHANNELS>) {
        const HALF: usize = LANES / 2;
        let Sample { light, covered } = samples;
        for channel in 0..CHANNELS {
            let light: [f64; LANES] = light[channel].into();
            for pair in 0..HALF {
                let (one, other) = (light[pair], light[pair + HALF]);
                self.value[channel] += one + other;
                self.squares[channel] += (one - other) * (one - other);
            }
        }
        let apart = (covered ^ (covered >> HALF)) & 0xf;
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
    /// Takes two random samples in each of `side` × `side` strata of a pixel, a multiple of 2.
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
        self.gather(simd, rays, (tile, false), balls);
        let Some(mut sampler) = self.sampler(rays, tile, balls, (cells, geometry)) else {
            let count = 2 * u64::from(side) * u64::from(side);
            pairs.value = self.background() * count as f64;
            return;
        };
        let nothing = Sample {
            light: splat(simd, self.background()),
            covered: 0,
        };
        let mut samples: [Sample<S, CHANNELS>; ROWS] = [nothing; ROWS];
        for cell_row in 0..side / 2 {
            for cell_col in 0..side / 2 {
                let place = Place {
                    col: key.col,
                    row: key.row,
                    cell_col,
                    cell_row,
                    spread: Spread::Strata,
                };
                let places = Places::one(place);
                self.sample_places(simd, &places, &nothing, &mut sampler, &mut samples);
                pairs.add(&samples[0]);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use std::num::NonZeroU32;

    use glam::DVec3;

    use super::*;
    use crate::model::camera::{Camera, Lens};
    use crate::model::material::Material;
    use crate::model::sphere::Sphere;
    use crate::model::view::View;
    use crate::model::world::World;
    use crate::numeric::angle::Angle;
    use crate::search::grid::RayPoints;
    use crate::search::view_index::ViewIndex;
    use crate::search::visibility::Visibility;

    /// Pixels of every kind: far from a ball, near it, on its edge, and inside.
    #[test]
    fn means_are_those_of_many_regular_samples() {
        let mut world = World::new();
        world.background = Color::new(0.1, 0.2, 0.5);
        world.ambient = Color::splat(0.7);
        let white = world.add_material(Material::default());
        let ball = Sphere::new(DVec3::new(0.0, 0.0, 10.0), 2.0).unwrap();
        world.add_sphere(ball, white);
        let lens = Lens::from_field_of_view(Angle::from_degrees(40.0)).unwrap();
        let view = View::new(Camera::default(), lens, 24, 24);
        let visibility = Visibility::new(&world);
        let index = ViewIndex::new(&visibility, &view, RayPoints::All);
        let side = NonZeroU32::new(128).unwrap();
        for alpha in [false, true] {
            let samples = Supersampling::new(&world, &view, &index, side, alpha);
            for (col, row) in (0..24).flat_map(|row| (0..24).map(move |col| (col, row))) {
                let key = PixelKey { col, row, frame: 1 };
                let (pairs, regular) = (samples.scattered(key, 32), samples.pixel(key));
                let off = (pairs.value - regular.value).abs().max_element();
                let off = off.max((pairs.alpha - regular.alpha).abs());
                let most = pairs.squares.max_element().max(pairs.squares_of_alpha);
                // Five deviations of the mean, and what regular samples are off by at an edge.
                let claimed = 5.0 * (0.5 * most).sqrt() / pairs.count as f64;
                assert!(off <= claimed + 4e-3, "({col}, {row}): {off:e} {claimed:e}");
                if regular.error == 0.0 {
                    assert!(off <= 1e-14, "({col}, {row}): {off:e}");
                }
            }
        }
    }
}
