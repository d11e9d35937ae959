//! Averages over pixels to a tolerance, under any number of lights.

use std::num::NonZeroU32;
use std::sync::OnceLock;

use fearless_simd::{Level, dispatch};

use self::crowd_samples::{CrowdSamples, OfCrowds};
use super::budget::{Allowance, MOST, MOST_AT_A_MOMENT, MOST_SPHERES};
use super::classify::behind::leave_out_hidden;
use super::classify::magnitude::is_view_moderate;
use super::context::Context;
use super::crowd::UnitsOfTile;
use super::crowd_blocks::{CrowdBlocks, OfTile};
use super::scene::{InCamera, MOST_LIGHTS};
use super::{LitTile, Scratch, tile_pixels};
use crate::model::color::Color;
use crate::model::light_unit::{self, LightUnit};
use crate::model::roughness::PixelKey;
use crate::model::view::View;
use crate::model::world::World;
use crate::numeric::bits::set_bits;
use crate::picture::band::Band;
use crate::picture::image::Channels;
use crate::picture::pixel::{Method, Pixel, Status, Work};
use crate::picture::tile::Tile;
use crate::sampling::Supersampling;
use crate::search::view_index::ViewIndex;
use crate::soft::picture as soft;
use crate::soft::scene::Soft;

mod crowd_samples;
mod range;
mod scattered;

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
    /// The unit of the light that the groups are integrated in.
    unit: f64,
    /// The error that a pixel may have.
    tolerance: f64,
    /// Whether pictures have an alpha channel in place of the background.
    alpha: bool,
    /// The samples of the last rung: of most pixels, and of those whose spheres are so far that each ray
    /// costs thousands of others.
    samples: Supersampling<'scene>,
    few_samples: Supersampling<'scene>,
    blocks: CrowdBlocks,
    /// The samples that answer for pixels of crowds, to loose tolerances.
    crowd: Option<CrowdSamples<'scene>>,
    /// The least and the most light that any pixel may show, once a crowd asks.
    range: OnceLock<[Color; 2]>,
    /// The light whose shadows have no edges.
    soft: Option<Box<Soft<'scene>>>,
    level: Level,
}

/// The spheres that a tile may see.
struct Candidates {
    spheres: Vec<usize>,
    /// At least how many they were before those were left out that are hidden.
    count: usize,
    /// Whether they are too many to be told apart.
    is_hopeless: bool,
}

/// Samples on a side of a pixel that no other rung answers for.
const SAMPLES: NonZeroU32 = NonZeroU32::new(8).unwrap();
const FEW_SAMPLES: NonZeroU32 = NonZeroU32::new(1).unwrap();

/// The light, in units, that an error of the covered area counts as without an alpha channel. Not tuned.
const OF_COVERAGE: f64 = 0.25;

/// Memory for a thread.
#[derive(Debug, Default)]
pub(crate) struct GroupScratch {
    exact: Scratch,
    of_crowds: OfCrowds,
    soft: soft::Scratch,
}

impl GroupScratch {
    /// The units that the pixel at a place of the last tile has cost.
    pub(crate) fn cost_of(&self, place: usize) -> u64 {
        self.exact.lit.iter().map(|lit| lit.costs.of(place)).sum()
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
        let LightUnit { contrast, unit } =
            LightUnit::new(world, index.visibility.all_lights(), index.visibility.sky());
        let contrast = if alpha { contrast.max(1.0) } else { contrast };
        let channels = Channels::of(world, alpha);
        let of_crowds = UnitsOfTile::new(world, view, index);
        let context = |group| {
            let scene = InCamera::new(world, &index.visibility, view, channels, group);
            let scene = scene.in_units_of(unit);
            let normals = scene.single_light().map(|_| scene.of_normals());
            Context {
                scene,
                normals,
                view: *view,
                tolerance: tolerance / unit / count as f64,
                is_proved: true,
                has_alpha: alpha,
                of_coverage: if alpha { 1.0 } else { OF_COVERAGE },
                background: if alpha || group > 0 {
                    Color::ZERO
                } else {
                    world.background / unit
                },
                contrast,
                allowance: Allowance::still(count),
                of_crowds,
            }
        };
        Self {
            is_moderate: is_view_moderate(view),
            groups: (0..count).map(context).collect(),
            world,
            unit,
            tolerance,
            alpha,
            samples: Supersampling::new(world, view, index, SAMPLES, alpha),
            few_samples: Supersampling::new(world, view, index, FEW_SAMPLES, alpha),
            blocks: CrowdBlocks::new(view.width, view.height),
            crowd: CrowdSamples::new(world, view, index, tolerance, alpha),
            index: index.clone(),
            range: OnceLock::new(),
            soft: None,
            level: Level::new(),
        }
    }

    /// The same under all lights, soft ones as well, which have a part of the tolerance of their own.
    pub(crate) fn of_all_light(
        world: &'scene World,
        view: &View,
        index: &ViewIndex<'scene>,
        tolerance: f64,
        alpha: bool,
    ) -> Self {
        let soft = Soft::new(world, view, index, Method::Tolerance(tolerance));
        let rest = match soft {
            Some(_) => tolerance * (1.0 - Soft::SHARE),
            None => tolerance,
        };
        Self {
            soft: soft.map(Box::new),
            ..Self::new(world, view, index, rest, alpha)
        }
    }

    /// Makes ready for a whole picture.
    pub(crate) fn prepare(&self) {
        if let Some(crowd) = &self.crowd {
            crowd.prepare();
        }
    }

    /// The same for one of the moments of a panel of time of a level, which many others share a pixel's budget with.
    pub(crate) fn at_a_moment(mut self, level: u32) -> Self {
        for context in &mut self.groups {
            context.allowance = context.allowance.at_a_moment(level);
            context.of_crowds = context.of_crowds.divided_by(MOST / MOST_AT_A_MOMENT);
            context.normals = None;
        }
        self.crowd = None;
        self
    }

    /// The same, with estimates where bounds would claim more.
    pub(crate) fn without_proofs(mut self) -> Self {
        for context in &mut self.groups {
            context.is_proved = false;
            context.normals = None;
        }
        self
    }

    /// Appends the tile's pixels to `pixels`, in the order of [`Tile::pixels`]; returns what they cost.
    pub(crate) fn integrate(
        &self,
        tile: Tile,
        scratch: &mut GroupScratch,
        pixels: &mut Vec<Pixel>,
    ) -> Work {
        integrate_each(&[self], tile, scratch, &mut |_, found| {
            if let Some(found) = found {
                pixels.extend_from_slice(found);
            } else {
                pixels.extend((0..tile.count()).map(|_| self.empty_pixel()));
            }
        })
    }

    /// Calls `write` with the number of each of some integrators, and the tile's pixels, where any sphere may be seen;
    /// returns what they cost. The integrators have the view and its index in common.
    pub(crate) fn integrate_all(
        integrators: &[&Self],
        tile: Tile,
        scratch: &mut GroupScratch,
        mut write: impl FnMut(usize, &[Pixel]),
    ) -> Work {
        integrate_each(integrators, tile, scratch, &mut |index, pixels| {
            if let Some(pixels) = pixels {
                write(index, pixels);
            }
        })
    }

    fn candidates(&self, tile: Tile) -> Candidates {
        let is_crowd = self.is_moderate && self.index.sees_more_than(tile, MOST_SPHERES);
        let OfTile {
            spheres,
            is_hopeless,
        } = if is_crowd {
            self.blocks.of_tile(&self.groups[0], &self.index, tile)
        } else {
            OfTile {
                spheres: self.index.indices(tile),
                is_hopeless: false,
            }
        };
        Candidates {
            count: spheres
                .len()
                .max(if is_crowd { MOST_SPHERES + 1 } else { 0 }),
            spheres,
            is_hopeless,
        }
    }

    /// The sum of a tile's pixels under all groups of lights, and what the last rungs cost.
    fn sum<'lit>(
        &self,
        tile: Tile,
        (candidates, is_moderate): (&[usize], bool),
        lit: &'lit mut [LitTile],
    ) -> (&'lit mut [Pixel], Work) {
        let mut work = Work::default();
        let Some((
            LitTile {
                pixels,
                costs,
                unknown,
                crowds,
                cache,
                ..
            },
            others,
        )) = lit.split_first_mut()
        else {
            return (&mut [], work);
        };
        for other in others {
            *unknown |= other.unknown;
            for (pixel, more) in pixels.iter_mut().zip(&other.pixels) {
                add(pixel, more);
            }
        }
        let mut range = None;
        // What one group is over its share, another may be below.
        for pixel in &mut *pixels {
            pixel.value = light_unit::in_world(pixel.value, self.unit);
            pixel.error *= self.unit;
            if pixel.error > self.tolerance {
                let range = range.get_or_insert_with(|| self.range_of_light(candidates));
                self.limit(pixel, *range);
            }
            if pixel.error <= self.tolerance {
                pixel.status = Status::Met;
            }
        }

        // The last rungs: samples, which see exactly but miss what lies between them.
        let unmet = self.unmet(pixels) | *unknown;
        if !candidates.is_empty() && unmet != 0 {
            let range = range.unwrap_or_else(|| self.range_of_light(candidates));
            let most_occluders = cache.most_occluders();
            let scattering = if is_moderate {
                self.scattering(candidates, range, most_occluders)
            } else {
                None
            };
            for place in set_bits(unmet).take_while(|&place| (place as u64) < tile.count()) {
                let key = PixelKey {
                    col: tile.col + place as u32 % tile.width,
                    row: tile.row + place as u32 / tile.width,
                    frame: self.groups[0].view.frame,
                };
                let mut samples = 0;
                let scattered =
                    scattering.and_then(|of| self.scattered(key, of, crowds, &mut samples));
                work.samples += samples;
                costs.add(place, samples);
                if let Some(scattered) = scattered {
                    pixels[place] = scattered;
                } else if *unknown >> place & 1 == 1 {
                    pixels[place] = self.sampled(key, candidates, range, (crowds, most_occluders));
                }
            }
        }
        (pixels, work)
    }

    /// The pixels of a tile, bit by bit, that more work might know well enough.
    fn unmet(&self, pixels: &[Pixel]) -> u64 {
        let is_unmet = |pixel: &Pixel| pixel.status == Status::OutOfBudget;
        let bits = pixels.iter().enumerate();
        bits.map(|(place, pixel)| u64::from(is_unmet(pixel)) << place)
            .sum()
    }

    /// A pixel that sees no sphere. Only the first group of lights has a background.
    fn empty_pixel(&self) -> Pixel {
        let pixel = self.groups[0].empty_pixel();
        Pixel {
            value: pixel.value * self.unit,
            ..pixel
        }
    }

    /// True where the same was found out of what both see.
    pub(crate) fn shares_index(&self, other: &Self) -> bool {
        self.index.shares_lists(&other.index)
    }
}

/// Writes a tile's pixels into the bands of several pictures that contain it; returns what they cost.
///
/// The pictures have the view and its index in common; their lights differ.
pub(crate) fn paint_each(
    pictures: &mut [(&Exact<'_>, &mut Band<'_>)],
    tile: Tile,
    scratch: &mut GroupScratch,
) -> Work {
    let integrators: Vec<&Exact<'_>> = pictures.iter().map(|(exact, _)| *exact).collect();
    integrate_each(&integrators, tile, scratch, &mut |index, pixels| {
        let (exact, band) = &mut pictures[index];
        match pixels {
            Some(pixels) => band.write(tile, pixels),
            // Most pictures have empty tiles.
            None => band.write_same(tile, &exact.empty_pixel()),
        }
    })
}

/// Calls `write` with the number of each of some integrators, and the tile's pixels, or none where no sphere may be seen;
/// returns what they cost.
///
/// The integrators have the view and its index in common.
fn integrate_each(
    integrators: &[&Exact<'_>],
    tile: Tile,
    GroupScratch {
        exact: scratch,
        of_crowds,
        soft: of_soft,
    }: &mut GroupScratch,
    write: &mut dyn FnMut(usize, Option<&[Pixel]>),
) -> Work {
    let Some(first) = integrators.first() else {
        return Work::default();
    };
    let of_integrators = integrators.iter().map(|exact| exact.crowd.as_ref());
    let mut work = of_crowds.find(of_integrators, tile);
    let known = of_crowds.known();
    let all = (1_u128 << tile.count()) - 1;
    if u128::from(known) & all == all {
        scratch.leave_out(tile);
        for (index, exact) in integrators.iter().enumerate() {
            let mut pixels = of_crowds.all(index);
            if let (Some(pixels), Some(soft)) = (&mut pixels, &exact.soft) {
                work += soft.add(tile, of_soft, pixels);
            }
            write(index, pixels.as_deref());
        }
        return work;
    }
    let candidates = first.candidates(tile);
    if candidates.spheres.is_empty() {
        scratch.leave_out(tile);
        for index in 0..integrators.len() {
            write(index, None);
        }
        return work;
    }
    let contexts = integrators.iter().flat_map(|exact| &exact.groups);
    let contexts: Vec<&Context<'_>> = contexts.collect();
    let Candidates {
        mut spheres,
        count,
        is_hopeless,
    } = candidates;
    if !is_hopeless {
        scratch.prepare(contexts[0], &spheres);
    }
    scratch.begin(&contexts, tile, count);
    scratch.known = known;
    let is_moderate = !is_hopeless && first.is_moderate && scratch.are_balls_moderate();
    if is_moderate && spheres.len() > MOST_SPHERES {
        leave_out_hidden(&contexts[0].cell(tile), &mut spheres, &mut scratch.balls);
    }
    let candidates = &spheres[..];
    if is_moderate {
        dispatch!(first.level, simd => tile_pixels(simd, &contexts, tile, candidates, scratch));
    } else {
        for lit in &mut scratch.lit {
            lit.unknown = !known;
        }
    }
    work += scratch.take_work();
    let mut rest = &mut scratch.lit[..];
    for (index, exact) in integrators.iter().enumerate() {
        let lit;
        (lit, rest) = std::mem::take(&mut rest).split_at_mut(exact.groups.len());
        let (pixels, more) = exact.sum(tile, (candidates, is_moderate), lit);
        work += more;
        of_crowds.replace(index, pixels);
        if let Some(soft) = &exact.soft {
            work += soft.add(tile, of_soft, pixels);
        }
        write(index, Some(pixels));
    }
    work
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
