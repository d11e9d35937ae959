//! The mean over a regular grid of samples, tile by tile.

use std::num::NonZeroU32;

use fearless_simd::{Level, Simd, dispatch};
use glam::DVec3;

use super::centers::Centers;
use super::groups::Groups;
use super::last_places::Seen;
use super::light::{Light, Looks, Shading, splat};
use super::rays::{Place, Rays};
use super::shadow::{Scale, Shadows};
use super::sums::{Sample, Sums};
use super::tile_balls::TileBalls;
use super::trace::{RayRow, Tracer};
use crate::model::camera::Projection;
use crate::model::color::Color;
use crate::model::light_unit::{LightUnit, NOTHING};
use crate::model::roughness::PixelKey;
use crate::model::view::View;
use crate::model::world::World;
use crate::numeric::lanes::mask64x8;
use crate::numeric::vectors::Vectors;
use crate::picture::band::Band;
use crate::picture::geometry::{Geometry, TileGeometry};
use crate::picture::image::{Channels, Uniform};
use crate::picture::pixel::{Evidence, Pixel, Status, Work};
use crate::picture::quantities::GeometrySettings;
use crate::picture::tile::{Tile, TileLight};
use crate::search::shadow_cells::ShadowCells;
use crate::search::view_index::ViewIndex;

/// Rows of a tile.
pub(super) const ROWS: usize = Tile::SIDE as usize;

/// The mean over the midpoints of a regular N × N division of every pixel.
///
/// # Accuracy
/// An estimate: the spread of the samples over 2N, which is what one straight edge along the
/// grid costs at the worst. An edge that passes between the samples and the pixel's border is not
/// in it, which happens in one edge pixel of five, and then costs less than 1/(2N) too; the largest
/// estimate of a picture covers its largest error. `tests/tests/truth.rs` measures all three. One
/// sample alone says nothing: its error is infinite.
#[derive(Clone, Debug)]
pub(crate) struct Supersampling<'scene> {
    index: ViewIndex<'scene>,
    samples: NonZeroU32,
    pub(super) channels: Channels,
    alpha: bool,
    /// The light that an error of alpha counts as; 0 if nobody asks for alpha.
    of_alpha: f64,
    /// Light below which there is none: numbers that are so small would be rounded otherwise in other units.
    nothing: f64,
    pub(super) rays: Rays,
    pub(super) shading: Shading<'scene>,
    view: View,
    /// Tells what the samples see, of which there is one a pixel.
    centers: Option<Centers>,
    /// True where nobody asks for light.
    is_dark: bool,
    /// The instructions that the processor has.
    pub(super) level: Level,
}

impl<'scene> Supersampling<'scene> {
    /// Prepares `samples` × `samples` points in every pixel; with `alpha` the background sends
    /// no light.
    pub(crate) fn new(
        world: &'scene World,
        view: &View,
        index: &ViewIndex<'scene>,
        samples: NonZeroU32,
        alpha: bool,
    ) -> Self {
        let LightUnit { unit, .. } = LightUnit::new(world, index.visibility.lights());
        Self {
            index: index.clone(),
            samples,
            channels: Channels::of(world, alpha),
            alpha,
            of_alpha: if alpha { unit } else { 0.0 },
            nothing: NOTHING * unit,
            rays: Rays::new(view, samples.get()),
            shading: Shading::new(world, view, index),
            view: *view,
            centers: None,
            is_dark: false,
            level: Level::new(),
        }
    }

    /// The same that tells what it sees, as well; of more samples than one a pixel, that of the last.
    pub(crate) fn with_geometry(self, settings: GeometrySettings) -> Self {
        Self {
            centers: Some(Centers::new(&self.view, settings)),
            ..self
        }
    }

    /// Samples the geometry that the rays through the centers of pixels see, without light.
    pub(crate) fn of_centers(
        world: &'scene World,
        view: &View,
        index: &ViewIndex<'scene>,
        settings: GeometrySettings,
    ) -> Self {
        let samples = Self::new(world, view, index, NonZeroU32::MIN, false);
        Self {
            is_dark: true,
            ..samples.with_geometry(settings)
        }
    }

    /// True for one sample a pixel, in its center.
    pub(crate) fn is_one(&self) -> bool {
        self.samples.get() == 1
    }

    /// The numbers that are known of all pixels before they are sampled.
    pub(crate) fn uniform(samples: NonZeroU32) -> Uniform {
        Uniform {
            error: (samples.get() == 1).then_some(f64::INFINITY),
            outcome: Some((Evidence::Estimate, Status::NoTolerance)),
        }
    }

    /// One pixel.
    pub(crate) fn pixel(&self, key: PixelKey) -> Pixel {
        let PixelKey { col, row, .. } = key;
        let (width, height) = (1, 1);
        let tile = Tile {
            col,
            row,
            width,
            height,
        };
        let mut pixels = Vec::with_capacity(1);
        self.integrate(tile, &mut Scratch::default(), &mut pixels);
        pixels[0]
    }

    /// The light of rays that meet nothing.
    pub(super) fn background(&self) -> Color {
        if self.alpha {
            Color::ZERO
        } else {
            self.shading.world.background
        }
    }

    /// Averages the light of a tile; how many balls were asked whether eight rays meet them, or
    /// none, and no light, where all rays meet nothing.
    fn sample(&self, tile: Tile, scratch: &mut Scratch) -> Option<u64> {
        if self.centers.is_some() {
            scratch.geometry.clear();
        }
        match self.channels {
            Channels::Grey => self.sample_channels::<1>(tile, scratch),
            Channels::Rgb => self.sample_channels::<3>(tile, scratch),
        }
    }

    fn sample_channels<const CHANNELS: usize>(
        &self,
        tile: Tile,
        scratch: &mut Scratch,
    ) -> Option<u64> {
        // Most pictures have empty tiles.
        self.index.balls(tile).next()?;
        dispatch!(self.level, simd => self.sample_lanes::<_, CHANNELS>(simd, tile, scratch))
    }

    /// The work on a tile, from the tests of eight rays.
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
        if self.is_one() { f64::INFINITY } else { 0.0 }
    }

    /// One of the pixels of a tile's light.
    fn pixel_of(&self, light: &TileLight, col: u32, row: u32) -> Pixel {
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
        Scratch {
            balls,
            light,
            geometry,
            cells: shadow_cells,
        }: &mut Scratch,
    ) -> Option<u64> {
        self.gather(simd, &self.rays, tile, balls);
        let memory = (shadow_cells, geometry);
        let mut sampler = self.sampler(&self.rays, tile, balls, memory)?;
        let nothing = Sample {
            light: splat(simd, self.background()),
            covered: 0,
        };
        let side = self.samples.get();
        let height = tile.height as usize;
        let mut samples = [nothing; ROWS];
        let mut sums = None;
        if side > 1 {
            sums = Some([Sums::<S, CHANNELS>::new(simd); ROWS]);
        }
        for cell_row in 0..side {
            for cell_col in 0..side {
                let place = Place {
                    col: tile.col,
                    row: tile.row,
                    cell_col,
                    cell_row,
                    is_scattered: false,
                };
                self.sample_cell(simd, place, &nothing, &mut sampler, &mut samples);
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
                Some(sums) => sums[row].store(simd, side, (self.of_alpha, self.nothing), pixels),
                None => samples[row].store(simd, self.nothing, pixels),
            }
        }
        Some(sampler.tracer.tests)
    }

    /// Finds the balls that rays of a tile may meet.
    #[inline(never)]
    pub(super) fn gather<S: Simd>(&self, simd: S, rays: &Rays, tile: Tile, balls: &mut TileBalls) {
        let mut cells = rays.cells_on_unit();
        if rays.projection() == Projection::Parallel {
            cells *= libm::scalbn(1.0, self.index.length_exponent());
        }
        simd.vectorize(
            #[inline(always)]
            || balls.gather(simd, cells, &rays.bundle(tile), self.index.balls(tile)),
        );
    }

    /// Prepares the search among the balls of a tile, if there is any.
    pub(super) fn sampler<'tile>(
        &'tile self,
        rays: &'tile Rays,
        tile: Tile,
        balls: &'tile TileBalls,
        (cells, geometry): (&'tile mut ShadowCells, &'tile mut TileGeometry),
    ) -> Option<Sampler<'tile>> {
        let first = balls.list.first()?;
        Some(Sampler {
            tracer: Tracer {
                index: &self.index,
                rays,
                balls,
                tile,
                tests: 0,
            },
            groups: Groups::new(first),
            looks: Looks::new(&self.shading),
            geometry,
            shadows: (self.shading.world.shadows && !self.is_dark).then(|| {
                let length = libm::scalbn(1.0, self.index.length_exponent());
                let size = Scale {
                    length,
                    tile_side: rays.tile_side(),
                    projection: rays.projection(),
                };
                let viewpoint = self.view.camera.position;
                Shadows::new(&self.index.visibility, viewpoint, size, cells)
            }),
        })
    }

    /// Takes a sample of each pixel of a tile, or eight scattered samples of one pixel; `nothing` where no sphere is seen.
    ///
    /// Compiled once, and not wherever samples are taken.
    #[inline(never)]
    pub(super) fn sample_cell<'tile, S: Simd, const CHANNELS: usize>(
        &'tile self,
        simd: S,
        place: Place,
        nothing: &Sample<S, CHANNELS>,
        sampler: &mut Sampler<'tile>,
        samples: &mut [Sample<S, CHANNELS>; ROWS],
    ) {
        simd.vectorize(
            #[inline(always)]
            || self.sample_lanes_of_cell(simd, place, nothing, sampler, samples),
        );
    }

    #[inline(always)]
    fn sample_lanes_of_cell<'tile, S: Simd, const CHANNELS: usize>(
        &'tile self,
        simd: S,
        mut place: Place,
        nothing: &Sample<S, CHANNELS>,
        sampler: &mut Sampler<'tile>,
        samples: &mut [Sample<S, CHANNELS>; ROWS],
    ) {
        let Sampler {
            tracer,
            groups,
            looks,
            geometry,
            shadows,
        } = sampler;
        let height = tracer.tile.height as usize;
        let dark = RayRow::new(simd, Vectors::splat(simd, DVec3::ZERO));
        let mut rows = [dark; ROWS];
        let rays = tracer.rays;
        let across = rays.across(simd, place, tracer.tile.width);
        let is_parallel = rays.projection() == Projection::Parallel;
        if !is_parallel {
            for row in &mut rows[..height] {
                let directions = if place.is_scattered {
                    rays.scattered_directions(simd, place)
                } else {
                    rays.directions(across, place)
                };
                *row = RayRow::new(simd, directions);
                place.row += 1;
            }
            tracer.search(simd, &mut rows);
        }
        place.row = tracer.tile.row;
        for (row, sample) in rows[..height].iter().zip(samples) {
            let sight = if is_parallel {
                tracer.look_along(simd, place, groups)
            } else {
                tracer.look(simd, place, row, groups)
            };
            *sample = *nothing;
            if let Some(centers) = &self.centers {
                let row = &mut geometry.rows[(place.row - tracer.tile.row) as usize % ROWS];
                if sight.covered != 0 {
                    let seen = Seen {
                        sight: &sight,
                        groups,
                        place,
                        across,
                    };
                    centers.record(simd, &seen, tracer, &self.shading, looks, row);
                }
            }
            if sight.covered != 0 && !self.is_dark {
                looks.see(&self.shading, groups);
                let seen = (&sight, &*groups, &mut *looks);
                let light: Light<S, CHANNELS> = self.shading.light(simd, seen, place, shadows);
                let covered = mask64x8::from_bitmask(simd, sight.covered);
                let background = &nothing.light;
                for channel in 0..CHANNELS {
                    sample.light[channel] = covered.select(light[channel], background[channel]);
                }
                sample.covered = sight.covered;
            }
            place.row += 1;
        }
    }

    /// Appends the tile's pixels to `pixels`, in the order of [`Tile::pixels`]; returns what they cost.
    pub(crate) fn integrate(
        &self,
        tile: Tile,
        scratch: &mut Scratch,
        pixels: &mut Vec<Pixel>,
    ) -> Work {
        let tests = self.sample(tile, scratch);
        let light = &mut scratch.light;
        if tests.is_none() {
            light.fill(self.background(), self.error_of_equal_samples());
        }
        let tile_pixels = tile.pixels();
        let pixel = |(col, row)| self.pixel_of(light, col - tile.col, row - tile.row);
        pixels.extend(tile_pixels.map(pixel));
        self.work(tile, tests.unwrap_or(0))
    }

    /// Writes the tile's pixels into the band of a picture that contains it; returns what they cost.
    pub(crate) fn paint(&self, tile: Tile, scratch: &mut Scratch, band: &mut Band<'_>) -> Work {
        let tests = self.sample(tile, scratch);
        if tests.is_some() {
            band.write_light(tile, &scratch.light);
        } else {
            band.write_even_light(tile, self.background(), self.error_of_equal_samples());
        }
        self.work(tile, tests.unwrap_or(0))
    }

    /// Writes what a tile sees, of a picture whose first pixel is in this column and row, after its light was
    /// written with this memory.
    pub(crate) fn write_geometry(
        &self,
        tile: Tile,
        scratch: &Scratch,
        (first, geometry): ((u32, u32), &mut Geometry),
    ) {
        if self.centers.is_some() {
            geometry.write(tile, first, &scratch.geometry);
        }
    }

    /// Writes what a tile sees, and no light; returns what it costs.
    pub(crate) fn see(
        &self,
        tile: Tile,
        scratch: &mut Scratch,
        (first, geometry): ((u32, u32), &mut Geometry),
    ) -> Work {
        let tests = self.sample(tile, scratch);
        geometry.write(tile, first, &scratch.geometry);
        self.work(tile, tests.unwrap_or(0))
    }
}

/// Memory to work in, for one world.
#[derive(Debug, Default)]
pub(crate) struct Scratch {
    pub(super) balls: TileBalls,
    light: TileLight,
    pub(super) geometry: TileGeometry,
    pub(super) cells: ShadowCells,
}

/// The search for what the rays of a tile see, and for its light.
pub(super) struct Sampler<'tile> {
    pub(super) tracer: Tracer<'tile>,
    pub(super) groups: Groups<'tile>,
    pub(super) looks: Looks<'tile>,
    /// The geometry that is seen, if somebody asks.
    geometry: &'tile mut TileGeometry,
    pub(super) shadows: Option<Shadows<'tile>>,
}

#[cfg(test)]
mod tests;
