//! The average over area and time, to a tolerance.
//!
//! The integral over a pixel's area at a moment goes with time without jumps, but with bends where edges
//! reach corners. So time is cut in panels, which a pixel halves where its light is not smooth. All
//! pixels cut at the same places: what is seen at a moment is found out once for all of them.

use std::ops::ControlFlow;

use super::instants::Instant;
use super::instants::Instants;
use super::pace::{Pace, Start};
use super::paint_band;
use super::panel::{MOMENTS, Panel, Part};
use crate::exact::Exact;
use crate::exact::Room;
use crate::model::color::Color;
use crate::model::world::World;
use crate::picture::image::Band;
use crate::picture::integrator::Integrator;
use crate::picture::pixel::Cancelled;
use crate::picture::pixel::{Evidence, Pixel, Status, Work};
use crate::picture::tile::Tile;

/// The share of the tolerance that the integral over area may take at each moment.
const SHARE_OF_AREA: f64 = 0.5;

/// A pixel is given up when it has been looked at in so many panels, and four times as many as it began
/// with.
const MOST_PANELS: usize = 256;

/// Averages to a tolerance over area and time.
///
/// # Accuracy
/// An estimate: by Kronrod's rule against two others on each panel, what is smooth there is known well.
/// What happens only between two moments is missed; `pace` cuts time so that it does not matter.
#[derive(Debug)]
pub(crate) struct ExactOverTime<'scene> {
    world: &'scene World,
    instants: Instants<'scene>,
    tolerance: f64,
    alpha: bool,
    /// About the largest difference of light that something may make.
    contrast: f64,
    pace: Pace,
}

/// What is known of a pixel.
struct Sum {
    /// The first panel's, from which differences are taken, so that what never changes is itself.
    first: Option<(Color, f64)>,
    /// Of the panels that will not be halved.
    value: Color,
    alpha: f64,
    area_error: f64,
    time_error: f64,
    is_lost: bool,
    /// What may have happened between all moments, which is a part of the error over time.
    missed: f64,
    /// Those that may be.
    open: Vec<Part>,
    /// How many panels it has been looked at in, and how many it may be.
    panels: usize,
    most_panels: usize,
    /// Whether its first panels are as short as they should be.
    is_paced: bool,
}

/// A panel that a pixel is to be looked at in.
type Wish = (Panel, u32);

impl<'scene> ExactOverTime<'scene> {
    pub(crate) fn new(
        world: &'scene World,
        instants: Instants<'scene>,
        tolerance: f64,
        alpha: bool,
    ) -> Self {
        let lights = world.lights.iter();
        let lights = lights.map(|light| light.intensity().max_element());
        let brightest = world.ambient.max_element() + lights.sum::<f64>();
        let contrast = brightest.max(world.background.max_element()).max(1.0);
        let (view, motion) = (&instants.view, instants.motion.as_ref());
        let pace = Pace::new(world, view, motion, tolerance / contrast);
        Self {
            world,
            instants,
            tolerance,
            alpha,
            contrast,
            pace,
        }
    }

    /// The pixels of a rectangle as high as a tile, tile by tile.
    fn pixels(
        &self,
        area: Tile,
        room: &mut Room,
        progress: &(dyn Fn(u64) -> ControlFlow<()> + Sync),
    ) -> Result<(Vec<Pixel>, Work), Cancelled> {
        let tiles: Vec<Tile> = area.tiles().collect();
        let places = tiles.iter().flat_map(|tile| tile.pixels());
        let mut sums: Vec<Sum> = Vec::with_capacity(area.count() as usize);
        let mut wishes: Vec<Wish> = Vec::new();
        for (pixel, (col, row)) in places.enumerate() {
            let start = self.pace.start(col, row);
            sums.push(Sum::new(start, self.contrast));
            let level = start.level;
            wishes.extend((0..1 << level).map(|index| (Panel { level, index }, pixel as u32)));
        }
        let mut work = Work::default();
        while !wishes.is_empty() {
            wishes.sort_unstable();
            for of_panel in wishes.chunk_by(|one, other| one.0 == other.0) {
                let panel = of_panel[0].0;
                self.instants
                    .with(panel.number(), &panel.times(), |instants| {
                        self.look(
                            panel,
                            instants,
                            of_panel,
                            (&tiles, room),
                            &mut sums,
                            progress,
                        )
                        .map(|cost| work += cost)
                    })?;
            }
            wishes.clear();
            for (pixel, sum) in sums.iter_mut().enumerate() {
                sum.halve(self.tolerance, |panel| wishes.push((panel, pixel as u32)));
            }
        }
        let pixels = sums.iter().map(|sum| sum.pixel(self.tolerance));
        Ok((pixels.collect(), work))
    }

    /// Looks at some pixels at the moments of a panel.
    fn look(
        &self,
        panel: Panel,
        instants: &[Instant<'_>],
        wishes: &[Wish],
        (tiles, room): (&[Tile], &mut Room),
        sums: &mut [Sum],
        progress: &(dyn Fn(u64) -> ControlFlow<()> + Sync),
    ) -> Result<Work, Cancelled> {
        let tolerance = SHARE_OF_AREA * self.tolerance;
        let integrators: Vec<Exact<'_>> = instants
            .iter()
            .map(|Instant { view, seen }| Exact::new(self.world, view, seen, tolerance, self.alpha))
            .collect();
        let mut work = Work::default();
        let mut pixels = Vec::new();
        // All tiles but the last have as many.
        let tile_pixels = tiles[0].count() as u32;
        for of_tile in wishes.chunk_by(|one, other| one.1 / tile_pixels == other.1 / tile_pixels) {
            let number = of_tile[0].1 / tile_pixels;
            let first = number * tile_pixels;
            let tile = tiles[number as usize];
            let wanted = of_tile.iter().map(|wish| wish.1 - first);
            let around = around(tile, wanted.clone());
            pixels.clear();
            for integrator in &integrators {
                work += integrator.integrate(around, room, &mut pixels);
            }
            let count = around.count() as usize;
            for pixel in wanted {
                let (col, row) = (tile.col + pixel % tile.width, tile.row + pixel / tile.width);
                let place = (row - around.row) * around.width + col - around.col;
                let moments: [Pixel; MOMENTS] =
                    std::array::from_fn(|moment| pixels[moment * count + place as usize]);
                sums[(first + pixel) as usize].add(Part::new(panel, &moments));
            }
            if progress(0).is_break() {
                return Err(Cancelled);
            }
        }
        Ok(work)
    }
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

impl Sum {
    fn new(start: Start, contrast: f64) -> Self {
        let missed = contrast * start.missed;
        Self {
            first: None,
            value: Color::ZERO,
            alpha: 0.0,
            area_error: 0.0,
            time_error: missed,
            is_lost: false,
            missed,
            open: Vec::new(),
            panels: 0,
            most_panels: MOST_PANELS + (4 << start.level),
            is_paced: start.is_paced,
        }
    }

    /// Adds what was seen in a panel.
    fn add(&mut self, part: Part) {
        self.first.get_or_insert((part.value, part.alpha));
        self.panels += 1;
        self.open.push(part);
    }

    /// Counts a panel that will not be halved.
    fn settle(&mut self, part: &Part) {
        let (value, alpha) = self.first.unwrap_or((Color::ZERO, 0.0));
        let length = part.panel.length();
        self.value += (part.value + value * -1.0) * length;
        self.alpha += (part.alpha - alpha) * length;
        self.area_error += part.area_error * length;
        self.time_error += part.time_error;
        self.is_lost |= part.is_lost;
    }

    /// Decides which panels are halved, and calls `wish` for the halves; for none once the tolerance is
    /// met, or no more can be done.
    fn halve(&mut self, tolerance: f64, mut wish: impl FnMut(Panel)) {
        /// Of what may be claimed, what panels that are not halved may.
        const SHARE_OF_REST: f64 = 0.5;
        /// A panel whose claim is as small as this part of its share of the tolerance is not halved.
        const SMALL: f64 = 0.125;
        if self.open.is_empty() {
            return;
        }
        let mut open = std::mem::take(&mut self.open);
        let of_area = |part: &Part| part.area_error * part.panel.length();
        let area: f64 = self.area_error + open.iter().map(of_area).sum::<f64>();
        let of_time = |parts: &[Part]| parts.iter().map(|part| part.time_error).sum::<f64>();
        let is_done = area + self.time_error + of_time(&open) <= tolerance;
        let is_over = self.panels >= self.most_panels || !self.is_paced;
        if is_done || is_over || !area.is_finite() {
            for part in &open {
                self.settle(part);
            }
            return;
        }
        // Where area claims too much, time need not.
        let left = (tolerance - area).max(SHARE_OF_AREA * tolerance) - self.missed;
        let allowed = self.missed + SHARE_OF_REST * left;
        open.sort_by(|one, other| {
            let order = other.time_error.total_cmp(&one.time_error);
            order.then(one.panel.cmp(&other.panel))
        });
        let mut rest = self.time_error + of_time(&open);
        let mut is_halved = false;
        for part in open {
            let is_small = part.time_error <= SMALL * tolerance * part.panel.length();
            match part.panel.halves() {
                Some(halves) if rest > allowed && !is_small => {
                    rest -= part.time_error;
                    is_halved = true;
                    halves.into_iter().for_each(&mut wish);
                }
                _ if is_small => self.settle(&part),
                Some(_) => self.open.push(part),
                None => self.settle(&part),
            }
        }
        if !is_halved {
            let open = std::mem::take(&mut self.open);
            open.iter().for_each(|part| self.settle(part));
        }
    }

    fn pixel(&self, tolerance: f64) -> Pixel {
        let (value, alpha) = self.first.unwrap_or((Color::ZERO, 0.0));
        let error = self.area_error + self.time_error;
        Pixel {
            value: value + self.value,
            alpha: alpha + self.alpha,
            error,
            evidence: Evidence::Estimate,
            status: if self.is_lost || !self.is_paced {
                Status::OutOfBudget
            } else if error <= tolerance {
                Status::Met
            } else if self.area_error > tolerance {
                Status::AtRoundoff
            } else {
                Status::OutOfBudget
            },
        }
    }
}

impl Integrator for ExactOverTime<'_> {
    type Room = Room;

    fn integrate(&self, tile: Tile, room: &mut Room, pixels: &mut Vec<Pixel>) -> Work {
        let go = |_| ControlFlow::Continue(());
        let Ok((found, work)) = self.pixels(tile, room, &go) else {
            return Work::default();
        };
        pixels.extend(found);
        work
    }

    fn paint_band(
        &self,
        band: &mut Band<'_>,
        room: &mut Room,
        progress: &(dyn Fn(u64) -> ControlFlow<()> + Sync),
    ) -> Result<Work, Cancelled> {
        paint_band(band, progress, |part| self.pixels(part, room, progress))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::time::pace::Start;

    #[test]
    fn what_is_claimed_is_of_area_and_of_time() {
        let panel = Panel { level: 0, index: 0 };
        let start = Start {
            level: 0,
            missed: 2e-4,
            is_paced: true,
        };
        for (is_paced, expected) in [(true, Status::Met), (false, Status::OutOfBudget)] {
            let mut sum = Sum::new(Start { is_paced, ..start }, 1.5);
            let pixel = Pixel {
                value: Color::splat(0.5),
                alpha: 1.0,
                error: 1e-4,
                evidence: Evidence::Estimate,
                status: Status::Met,
            };
            sum.add(Part::new(panel, &[pixel; MOMENTS]));
            sum.halve(1e-3, |panel| panic!("{panel:?} is not needed"));
            let found = sum.pixel(1e-3);
            assert_eq!((found.value.x, found.status), (0.5, expected));
            assert!((found.error - 4e-4).abs() < 1e-15, "{:e}", found.error);
        }
    }
}
