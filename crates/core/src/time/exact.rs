//! The average over area and time, to a tolerance.
//!
//! The integral over a pixel's area at a moment goes with time without jumps, but with bends where edges
//! reach corners. So time is cut in panels, which a pixel halves where its light is not smooth. All
//! pixels cut at the same places: what is seen at a moment is found out once for all of them.

use super::band::paint_band;
use super::contrast::Contrast;
use super::instants::{Instant, Instants};
use super::panel::{MOMENTS, Panel, Part};
use super::panel_levels::PanelLevels;
use super::pixel_sum::{PixelSum, SHARE_OF_AREA};
use crate::exact::integrator::{Exact, GroupScratch};
use crate::model::world::World;
use crate::picture::band::Band;
use crate::picture::pixel::{Pixel, Work};
use crate::picture::progress::{Cancelled, Progress};
use crate::picture::tile::Tile;

/// Averages to a tolerance over area and time.
///
/// # Accuracy
/// An estimate: by Kronrod's rule against two others on each panel, what is smooth there is known well.
/// Anything that happens only between two moments is missed; [`PanelLevels`] cut time so that it does not
/// matter.
#[derive(Debug)]
pub(crate) struct ExactOverTime<'scene> {
    world: &'scene World,
    instants: Instants<'scene>,
    tolerance: f64,
    alpha: bool,
    contrast: Contrast,
    levels: PanelLevels,
}

/// A panel that a pixel is to be integrated over.
#[derive(Clone, Copy, Eq, Ord, PartialEq, PartialOrd)]
struct Request {
    panel: Panel,
    /// The pixel's place among those of the rectangle.
    pixel: u32,
}

impl<'scene> ExactOverTime<'scene> {
    pub(crate) fn new(
        world: &'scene World,
        instants: Instants<'scene>,
        tolerance: f64,
        alpha: bool,
    ) -> Self {
        let contrast = Contrast::new(
            world,
            instants.visibility.all_lights(),
            instants.visibility.sky(),
            alpha,
        );
        let (view, motion) = (&instants.view, instants.motion.as_ref());
        let levels = PanelLevels::new(world, view, motion, tolerance / contrast.ordinary);
        Self {
            world,
            instants,
            tolerance,
            alpha,
            contrast,
            levels,
        }
    }

    /// Writes all pixels of a band; returns what they cost.
    pub(crate) fn paint_band(
        &self,
        band: &mut Band<'_>,
        room: &mut GroupScratch,
        progress: &Progress<'_>,
    ) -> Result<Work, Cancelled> {
        paint_band(band, progress, |part| self.pixels(part, room, progress))
    }

    /// The pixels of a rectangle as high as a tile, tile by tile.
    pub(super) fn pixels(
        &self,
        area: Tile,
        room: &mut GroupScratch,
        progress: &Progress<'_>,
    ) -> Result<(Vec<Pixel>, Work), Cancelled> {
        let tiles: Vec<Tile> = area.tiles().collect();
        let places = tiles.iter().flat_map(|tile| tile.pixels());
        let mut sums: Vec<PixelSum> = Vec::with_capacity(area.count() as usize);
        let mut requests: Vec<Request> = Vec::new();
        for (pixel, (col, row)) in (0..).zip(places) {
            let first = self.levels.at(col, row);
            sums.push(PixelSum::new(first, &self.contrast));
            let level = first.level;
            let panels = (0..1 << level).map(|index| Panel { level, index });
            requests.extend(panels.map(|panel| Request { panel, pixel }));
        }
        let mut work = Work::default();
        while !requests.is_empty() {
            requests.sort_unstable();
            for of_panel in requests.chunk_by(|one, other| one.panel == other.panel) {
                let panel = of_panel[0].panel;
                let add = |pixel: u32, part| sums[pixel as usize].add(part);
                let integrate = |instants: &[Instant<'scene>]| {
                    let integrators = self.integrators(instants, panel);
                    let requests = (of_panel, self.contrast.of_alpha);
                    integrate_panel(&integrators, &tiles, requests, (room, progress), add)
                };
                let (number, times) = (panel.number(), panel.times());
                work += self.instants.with(number, &times, integrate)?;
            }
            requests.clear();
            for (pixel, sum) in (0..).zip(&mut sums) {
                sum.halve(self.tolerance, |panel| {
                    requests.push(Request { panel, pixel })
                });
            }
        }
        let pixels = sums.iter().map(|sum| sum.pixel(self.tolerance));
        Ok((pixels.collect(), work))
    }

    /// The integrators over area at the moments of a panel.
    fn integrators(&self, instants: &[Instant<'scene>], panel: Panel) -> Vec<Exact<'scene>> {
        let tolerance = SHARE_OF_AREA * self.tolerance;
        let at = |Instant { view, index }: &Instant<'scene>| {
            Exact::of_all_light(self.world, view, index, tolerance, self.alpha)
                .at_a_moment(panel.level)
                .without_proofs()
        };
        instants.iter().map(at).collect()
    }
}

/// Integrates some pixels over a panel, by the integrators at its moments, and calls `add` for each; an error of alpha
/// counts as so much light.
fn integrate_panel(
    integrators: &[Exact<'_>],
    tiles: &[Tile],
    (requests, of_alpha): (&[Request], f64),
    (room, progress): (&mut GroupScratch, &Progress<'_>),
    mut add: impl FnMut(u32, Part),
) -> Result<Work, Cancelled> {
    let mut work = Work::default();
    let (mut pixels, mut costs) = (Vec::new(), Vec::new());
    // All tiles but the last have as many.
    let tile_pixels = tiles[0].count() as u32;
    for of_tile in
        requests.chunk_by(|one, other| one.pixel / tile_pixels == other.pixel / tile_pixels)
    {
        let number = of_tile[0].pixel / tile_pixels;
        let first = number * tile_pixels;
        let tile = tiles[number as usize];
        let place = |request: &Request| request.pixel - first;
        for (around, requests) in rectangles(tile, of_tile, place) {
            let count = around.count() as usize;
            pixels.clear();
            costs.clear();
            costs.resize(count, 0);
            for integrator in integrators {
                work += integrator.integrate(around, room, &mut pixels);
                for (place, cost) in costs.iter_mut().enumerate() {
                    *cost += room.cost_of(place);
                }
            }
            for request in requests {
                let pixel = place(request);
                let (col, row) = (tile.col + pixel % tile.width, tile.row + pixel / tile.width);
                let place = (row - around.row) * around.width + col - around.col;
                let moments: [Pixel; MOMENTS] =
                    std::array::from_fn(|moment| pixels[moment * count + place as usize]);
                let part = Part {
                    units: costs[place as usize],
                    ..Part::new(request.panel, &moments, of_alpha)
                };
                add(request.pixel, part);
            }
        }
        if progress(0).is_break() {
            return Err(Cancelled);
        }
    }
    Ok(work)
}

/// The rectangles that are integrated for some pixels of a tile, in order, and the requests of each: one around
/// all, or, where these are few of it, one around each run of them in a row.
fn rectangles(
    tile: Tile,
    requests: &[Request],
    place: impl Fn(&Request) -> u32 + Copy,
) -> Vec<(Tile, &[Request])> {
    let all = around(tile, requests.iter().map(place));
    if 2 * requests.len() as u64 >= all.count() {
        return vec![(all, requests)];
    }
    let is_next = |one: &Request, other: &Request| {
        place(other) == place(one) + 1 && !place(other).is_multiple_of(tile.width)
    };
    let runs = requests.chunk_by(is_next);
    runs.map(|run| (around(tile, run.iter().map(place)), run))
        .collect()
}

/// The rectangle around some pixels of a tile.
fn around(tile: Tile, mut pixels: impl Iterator<Item = u32>) -> Tile {
    let place = |pixel: u32| (pixel % tile.width, pixel / tile.width);
    let first = pixels.next().map_or((0, 0), place);
    let (mut low, mut high) = (first, first);
    for (col, row) in pixels.map(place) {
        low = (low.0.min(col), low.1.min(row));
        high = (high.0.max(col), high.1.max(row));
    }
    Tile {
        col: tile.col + low.0,
        row: tile.row + low.1,
        width: high.0 - low.0 + 1,
        height: high.1 - low.1 + 1,
    }
}
