//! Averages over pixels to a tolerance, under any number of lights.

use std::num::NonZeroU32;

use fearless_simd::{Level, dispatch};

use super::budget::Allowance;
use super::classify::magnitude::is_view_moderate;
use super::context::Context;
use super::scene::{InCamera, MOST_LIGHTS};
use super::{Scratch, tile_pixels};
use crate::model::color::Color;
use crate::model::roughness::PixelKey;
use crate::model::view::View;
use crate::model::world::World;
use crate::numeric::bits::set_bits;
use crate::numeric::rounding::WIDER;
use crate::picture::band::Band;
use crate::picture::image::Channels;
use crate::picture::pixel::{Evidence, Pixel, Status, Work};
use crate::picture::tile::Tile;
use crate::sampling::Supersampling;
use crate::search::view_index::ViewIndex;

/// Averages to a tolerance.
///
/// The kernels have room for eight lights. More are integrated in groups of eight, each to its share of
/// the tolerance, and the groups are summed.
#[derive(Clone, Debug)]
pub(crate) struct Exact<'scene> {
    index: ViewIndex<'scene>,
    /// Whether the numbers of the view are moderate enough for edges in doubles.
    is_moderate: bool,
    /// One for each group of lights.
    groups: Vec<Context<'scene>>,
    world: &'scene World,
    /// The error that a pixel may have.
    tolerance: f64,
    /// Whether pictures have an alpha channel in place of the background.
    alpha: bool,
    /// The samples of the last rung: of most pixels, and of those whose spheres are so far that each ray
    /// costs thousands of others.
    samples: Supersampling<'scene>,
    few_samples: Supersampling<'scene>,
    level: Level,
}

/// Samples on a side of a pixel that no other rung answers for.
const SAMPLES: NonZeroU32 = NonZeroU32::new(8).unwrap();
const FEW_SAMPLES: NonZeroU32 = NonZeroU32::new(1).unwrap();

/// How far spheres may be, in radii, for rays to be decided without integers: the square of this is what
/// numbers of twice the precision may lose and still have all places of a double.
const FAR: f64 = (1_u64 << 25) as f64;

/// Memory for a thread, with a part for each group of lights.
#[derive(Debug, Default)]
pub(crate) struct GroupScratch(Vec<Scratch>);

impl GroupScratch {
    /// The units that the pixel at a place of the last tile has cost.
    pub(crate) fn cost_of(&self, place: usize) -> u64 {
        self.0.iter().map(|group| group.costs.of(place)).sum()
    }
}

impl<'scene> Exact<'scene> {
    pub(crate) fn new(
        world: &'scene World,
        view: &View,
        index: &ViewIndex<'scene>,
        tolerance: f64,
        alpha: bool,
    ) -> Self {
        let count = index.visibility.lights().len().div_ceil(MOST_LIGHTS).max(1);
        let lights = index.visibility.lights().iter();
        let lights = lights.map(|light| light.intensity().max_element());
        let contrast = 1.0
            + world.ambient.max_element()
            + world.background.max_element()
            + lights.sum::<f64>();
        let channels = Channels::of(world, alpha);
        let context = |group| Context {
            scene: InCamera::new(world, &index.visibility, view, channels, group),
            view: *view,
            tolerance: tolerance / count as f64,
            is_proved: true,
            has_alpha: alpha,
            background: if alpha || group > 0 {
                Color::ZERO
            } else {
                world.background
            },
            contrast,
            allowance: Allowance::still(count),
        };
        Self {
            is_moderate: is_view_moderate(view),
            groups: (0..count).map(context).collect(),
            world,
            tolerance,
            alpha,
            samples: Supersampling::new(world, view, index, SAMPLES, alpha),
            few_samples: Supersampling::new(world, view, index, FEW_SAMPLES, alpha),
            index: index.clone(),
            level: Level::new(),
        }
    }

    /// The same for one of the moments of a panel of time of a level, which many others share a pixel's budget with.
    pub(crate) fn at_a_moment(mut self, level: u32) -> Self {
        for context in &mut self.groups {
            context.allowance = context.allowance.at_a_moment(level);
        }
        self
    }

    /// The same, with estimates where bounds would claim more.
    pub(crate) fn without_proofs(mut self) -> Self {
        for context in &mut self.groups {
            context.is_proved = false;
        }
        self
    }

    /// Appends the tile's pixels to `pixels`, in the order of [`Tile::pixels`]; returns what they cost.
    pub(crate) fn integrate(
        &self,
        tile: Tile,
        GroupScratch(scratch): &mut GroupScratch,
        pixels: &mut Vec<Pixel>,
    ) -> Work {
        let candidates = self.index.indices(tile);
        scratch.resize_with(self.groups.len(), Scratch::default);
        let first = pixels.len();
        let mut of_group = Vec::new();
        let mut work = Work::default();
        let mut unknown = 0;
        for (number, (context, scratch)) in self.groups.iter().zip(scratch).enumerate() {
            let target = if number == 0 {
                &mut *pixels
            } else {
                of_group.clear();
                &mut of_group
            };
            scratch.prepare(context, &candidates);
            scratch.costs.clear(tile.count());
            unknown |= if self.is_moderate && scratch.are_balls_moderate() {
                dispatch!(self.level, simd => tile_pixels(simd, context, tile, &candidates, scratch, target))
            } else {
                target.extend(std::iter::repeat_n(
                    context.empty_pixel(),
                    tile.count() as usize,
                ));
                !0
            };
            work += scratch.take_work();
            if number > 0 {
                for (pixel, more) in pixels[first..].iter_mut().zip(&of_group) {
                    add(pixel, more);
                }
            }
        }
        // What one group is over its share, another may be below.
        for pixel in &mut pixels[first..] {
            if pixel.error <= self.tolerance {
                pixel.status = Status::Met;
            }
        }

        // The last rung: samples, which see exactly but miss what lies between them.
        if !candidates.is_empty() {
            for place in set_bits(unknown).take_while(|&place| (place as u64) < tile.count()) {
                let key = PixelKey {
                    col: tile.col + place as u32 % tile.width,
                    row: tile.row + place as u32 / tile.width,
                    frame: self.groups[0].view.frame,
                };
                pixels[first + place] = self.sampled(key, &candidates);
            }
        }
        work
    }

    /// A pixel by samples, whose error is how far any mixture of what its tile may show lies from them.
    fn sampled(&self, key: PixelKey, candidates: &[usize]) -> Pixel {
        let is_far = |&sphere: &usize| {
            let (center, radius) = self.groups[0].scene.center(sphere);
            center.length() > FAR * radius
        };
        let samples = if candidates.iter().any(is_far) {
            &self.few_samples
        } else {
            &self.samples
        };
        let mut pixel = samples.pixel(key);
        let [least, most] = self.range_of_light(candidates);
        let above = (most - pixel.value).max_element();
        let below = (pixel.value - least).max_element();
        pixel.error = above.max(below) * WIDER;
        if self.alpha {
            pixel.error = pixel.error.max(pixel.alpha).max(1.0 - pixel.alpha);
        }
        pixel.evidence = Evidence::Bound;
        pixel.status = if pixel.error <= self.tolerance {
            Status::Met
        } else {
            Status::OutOfBudget
        };
        pixel
    }

    /// Bounds of the light, in each channel, of what may be seen of these spheres and of the background: in the
    /// dark, and where all lights and their highlights are at their highest.
    fn range_of_light(&self, candidates: &[usize]) -> [Color; 2] {
        let world = self.world;
        let background = self.groups[0].background;
        let [mut least, mut most] = [background; 2];
        for &sphere in candidates {
            let lights = self.index.visibility.lights().iter();
            let lights = lights.map(|light| light.brightest_on(&world.spheres()[sphere]));
            let lights = lights.fold(Color::ZERO, |sum, light| sum + light);
            let albedo = world.albedo(sphere);
            let highlight = world.material(sphere).highlight;
            let strength = highlight.map_or(0.0, |highlight| highlight.strength);
            let dark = albedo * world.ambient;
            least = least.min(dark);
            most = most.max(dark + albedo * lights + lights * strength);
        }
        [least, most]
    }

    /// Writes the tile's pixels into the band of a picture that contains it; returns what they cost.
    pub(crate) fn paint(
        &self,
        tile: Tile,
        scratch: &mut GroupScratch,
        band: &mut Band<'_>,
    ) -> Work {
        if self.index.balls(tile).next().is_some() {
            let mut pixels = Vec::with_capacity((tile.width * tile.height) as usize);
            let work = self.integrate(tile, scratch, &mut pixels);
            band.write(tile, &pixels);
            return work;
        }
        // Most pictures have empty tiles. Only the first group of lights has a background.
        band.write_same(tile, &self.groups[0].empty_pixel());
        Work::default()
    }
}

/// Adds the light of another group.
fn add(pixel: &mut Pixel, more: &Pixel) {
    pixel.value += more.value;
    pixel.error += more.error;
    pixel.evidence = pixel.evidence.min(more.evidence);
    if pixel.status == Status::Met || more.status == Status::OutOfBudget {
        pixel.status = more.status;
    }
}

#[cfg(test)]
mod tests;
