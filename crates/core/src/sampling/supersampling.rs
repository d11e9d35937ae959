//! The mean over a regular grid of samples, tile by tile.

use std::num::NonZeroU32;

use fearless_simd::{Level, Simd, dispatch};

use super::centers::Centers;
use super::light::{Shading, splat};
use super::places::{Places, ROWS};
use super::rays::{Place, Rays, Spread};
use super::row_samples::RowSamples;
use super::sums::{Sample, Sums};
use super::tile_balls::TileBalls;
use crate::model::color::Color;
use crate::model::light_unit::{LightUnit, NOTHING};
use crate::model::roughness::PixelKey;
use crate::model::view::View;
use crate::model::world::World;
use crate::picture::band::Band;
use crate::picture::geometry::{Geometry, TileGeometry};
use crate::picture::image::{Channels, Uniform};
use crate::picture::pixel::{Evidence, Method, Pixel, Status, Work};
use crate::picture::quantities::GeometrySettings;
use crate::picture::tile::{Tile, TileLight};
use crate::search::shadow_cells::ShadowCells;
use crate::search::view_index::ViewIndex;
use crate::soft::picture as soft;
use crate::soft::scene::Soft;

/// The number of balls in a tile from which on they are: few of eight pixels beside each other see the same ball then.
const CROWD: usize = 16;

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
    pub(super) index: ViewIndex<'scene>,
    samples: NonZeroU32,
    pub(super) channels: Channels,
    alpha: bool,
    /// The light that an error of alpha counts as; 0 if nobody asks for alpha.
    of_alpha: f64,
    /// Light below which there is none: numbers that are so small would be rounded otherwise in other units.
    nothing: f64,
    pub(super) rays: Rays,
    pub(super) shading: Shading<'scene>,
    pub(super) view: View,
    /// Tells what the samples see, of which there is one a pixel.
    pub(super) centers: Option<Centers>,
    /// True where nobody asks for light.
    pub(super) is_dark: bool,
    /// The number of balls in a tile from which on eight samples of one pixel are taken together.
    crowd: usize,
    /// The light whose shadows have no edges.
    soft: Option<Box<Soft<'scene>>>,
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
        let LightUnit { unit, .. } =
            LightUnit::new(world, index.visibility.all_lights(), index.visibility.sky());
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
            crowd: CROWD,
            soft: None,
            level: Level::new(),
        }
    }

    /// The same under all lights, soft ones as well.
    pub(crate) fn of_all_light(
        world: &'scene World,
        view: &View,
        index: &ViewIndex<'scene>,
        samples: NonZeroU32,
        alpha: bool,
    ) -> Self {
        let soft = Soft::new(world, view, index, Method::Samples(samples));
        Self {
            soft: soft.map(Box::new),
            ..Self::new(world, view, index, samples, alpha)
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

    /// Averages the light of a tile; how often balls were asked whether rays meet them, or none, and no light, where
    /// all rays meet nothing.
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

    /// The work on a tile, from the tests of rays.
    fn work(&self, tile: Tile, tests: u64) -> Work {
        let side = u64::from(self.samples.get());
        let width = u64::from(tile.width);
        Work {
            samples: width * u64::from(tile.height) * side * side,
            lines: 0,
            candidate_tests: tests,
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

    /// Averages the light of a tile.
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
            samples: row_samples,
            ..
        }: &mut Scratch,
    ) -> Option<u64> {
        let side = self.samples.get();
        let may_take_blocks = self.rays.are_dense() && self.centers.is_none();
        self.gather(simd, &self.rays, (tile, may_take_blocks), balls);
        let memory = (shadow_cells, geometry);
        let mut sampler = self.sampler(&self.rays, tile, balls, memory)?;
        let nothing = Sample {
            light: splat(simd, self.background()),
            covered: 0,
        };
        let as_light = (self.of_alpha, self.nothing);
        let height = tile.height as usize;
        let mut samples = [nothing; ROWS];
        let mut sums = None;
        if side > 1 {
            sums = Some([Sums::<S, CHANNELS>::new(simd); ROWS]);
        }
        let are_blocks = may_take_blocks && balls.list.len() >= self.crowd;
        if are_blocks && let Some(sums) = &mut sums {
            for (row, sums) in sums[..height].iter_mut().enumerate() {
                let of_row = (row as u32, side);
                self.sample_blocks(simd, of_row, &nothing, (&mut sampler, row_samples), sums);
            }
        }
        let columns = if are_blocks { 0 } else { side };
        for cell_row in 0..side {
            for cell_col in 0..columns {
                let place = Place {
                    col: tile.col,
                    row: tile.row,
                    cell_col,
                    cell_row,
                    spread: Spread::Pixels,
                };
                let places = Places::rows(place, tile.height);
                self.sample_places(simd, &places, &nothing, &mut sampler, &mut samples);
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
                Some(sums) => sums[row].store(simd, side, as_light, pixels),
                None => samples[row].store(simd, self.nothing, pixels),
            }
        }
        Some(sampler.tracer.tests)
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
        let first = pixels.len();
        pixels.extend(tile_pixels.map(pixel));
        if let Some(soft) = self.soft.as_ref().filter(|_| tests.is_some()) {
            soft.add(tile, &mut scratch.soft, &mut pixels[first..]);
        }
        self.work(tile, tests.unwrap_or(0))
    }

    /// Writes the tile's pixels into the band of a picture that contains it; returns what they cost.
    pub(crate) fn paint(&self, tile: Tile, scratch: &mut Scratch, band: &mut Band<'_>) -> Work {
        if self.soft.is_some() {
            let mut pixels = Vec::with_capacity(tile.count() as usize);
            let work = self.integrate(tile, scratch, &mut pixels);
            band.write(tile, &pixels);
            return work;
        }
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
    samples: RowSamples,
    soft: soft::Scratch,
}

#[cfg(test)]
mod tests;
