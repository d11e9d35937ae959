//! Pixels of crowds by a raster, to loose tolerances.
//!
//! Where a pixel sees several spheres, its edges are many, and each has little to say. A regular grid of samples
//! meets a loose tolerance in less time than they take.

use std::sync::{Arc, OnceLock};

use crate::model::view::View;
use crate::model::world::World;
use crate::picture::pixel::{Evidence, Pixel, Status, Work};
use crate::picture::tile::Tile;
use crate::raster::{self, Judged, Raster};
use crate::search::view_index::ViewIndex;

/// Samples on a side of a pixel.
const SIDES: [u32; 9] = [4, 6, 8, 10, 12, 16, 20, 24, 32];

/// The raster of the crowds of a view.
#[derive(Clone, Debug)]
pub(super) struct CrowdSamples<'scene> {
    raster: Raster<'scene>,
    view: View,
    tolerance: f64,
    /// The samples on a side of a pixel, if they are worth it; copies share what was found out.
    side: Arc<OnceLock<Option<u32>>>,
}

/// The least tolerance, in contrasts. Below, edges take less time than samples wherever it was measured.
const LEAST_TOLERANCE: f64 = 1e-2;

impl<'scene> CrowdSamples<'scene> {
    /// The raster for a world and a view, if it serves there.
    pub(super) fn new(
        world: &'scene World,
        view: &View,
        index: &ViewIndex<'scene>,
        tolerance: f64,
        alpha: bool,
    ) -> Option<Self> {
        let raster = Raster::new(world, view, index, alpha)?;
        (tolerance >= LEAST_TOLERANCE * raster.contrast()).then(|| Self {
            raster,
            view: *view,
            tolerance,
            side: Arc::default(),
        })
    }

    /// Makes ready for all tiles of the picture.
    pub(super) fn prepare(&self) {
        if self.side().is_some() {
            self.raster.prepare();
        }
    }

    /// The samples on a side of a pixel, if they are worth it.
    fn side(&self) -> Option<u32> {
        *self.side.get_or_init(|| self.side_that_pays())
    }

    /// The pixels of a tile that meet the tolerance, in the order of [`Tile::pixels`], or none of them; returns the
    /// number of samples.
    fn pixels(
        &self,
        tile: Tile,
        scratch: &mut raster::Scratch,
        found: &mut Vec<Option<Pixel>>,
    ) -> u64 {
        found.clear();
        let Some(side) = self.side() else {
            return 0;
        };
        let around = Tile {
            col: tile.col / Tile::SIDE * Tile::SIDE,
            row: tile.row / Tile::SIDE * Tile::SIDE,
            width: Tile::SIDE,
            height: Tile::SIDE,
        };
        let Some(judged) = self.raster.pixels(around, side, scratch) else {
            return 0;
        };
        let pixel = |(col, row): (u32, u32)| {
            let place = (row - around.row) * Tile::SIDE + col - around.col;
            self.met(&judged[place as usize], side)
        };
        found.extend(tile.pixels().map(pixel));
        tile.count() * u64::from(side * side)
    }

    /// A pixel, if it meets the tolerance.
    fn met(&self, judged: &Judged, side: u32) -> Option<Pixel> {
        let error = deviations(side) * judged.error;
        (error <= self.tolerance).then_some(Pixel {
            value: judged.value,
            alpha: judged.alpha,
            error,
            evidence: Evidence::Estimate,
            status: Status::Met,
        })
    }

    /// The number of samples on a side of a pixel with which the picture is thought to take the least time, if that
    /// is less than without any: from some tiles that lie evenly in it.
    fn side_that_pays(&self) -> Option<u32> {
        let (columns, rows) = (
            self.view.width.div_ceil(Tile::SIDE),
            self.view.height.div_ceil(Tile::SIDE),
        );
        let step = ((u64::from(columns) * u64::from(rows) / PROBES) as f64).sqrt() as usize + 1;
        let tiles = |step: usize| {
            let starts = move |count: u32| (0..count).skip(step / 2).step_by(step);
            starts(rows).flat_map(move |row| {
                starts(columns).map(move |column| Tile {
                    col: column * Tile::SIDE,
                    row: row * Tile::SIDE,
                    width: Tile::SIDE,
                    height: Tile::SIDE,
                })
            })
        };
        let mut scratch = raster::Scratch::default();
        let first = PROBING.into_iter();
        let mut probed = first.map(|probe| self.probe(probe, tiles(step), &mut scratch));
        let mut found = probed.find(|found| found.edges > 0.0)?;
        // What few samples tell of more is little: with as many, more balls are seen, and pixels fail that seemed to be met.
        while let Some((side, _)) = found.least()
            && side > found.probe
        {
            // A quarter of the tiles, as each takes longer.
            let finer = self.probe(side, tiles(2 * step), &mut scratch);
            if finer.edges == 0.0 {
                break;
            }
            found = finer;
        }
        let (side, cost) = found.least()?;
        (cost < found.edges).then_some(side)
    }

    /// What the picture is thought to take, from these tiles with so many samples on a side of a pixel.
    fn probe(
        &self,
        probe: u32,
        tiles: impl Iterator<Item = Tile>,
        scratch: &mut raster::Scratch,
    ) -> Probed {
        let mut found = Probed {
            probe,
            costs: [0.0; SIDES.len()],
            edges: 0.0,
        };
        for tile in tiles {
            let Some(judged) = self.raster.pixels(tile, probe, scratch) else {
                continue;
            };
            let balls = Raster::balls_seen(probe, scratch);
            for (judged, balls) in judged.iter().zip(balls) {
                let edges = self.cost_of_edges(balls);
                found.edges += edges;
                for (cost, side) in found.costs.iter_mut().zip(SIDES) {
                    *cost += OF_RASTER + f64::from(side * side);
                    let finer = f64::from(probe) / f64::from(side);
                    let error = judged.error * deviations(side) * libm::pow(finer, POWER);
                    if error > self.tolerance {
                        *cost += edges;
                    }
                }
            }
        }
        found
    }

    /// The time that the edges of a pixel take which sees so many balls, in samples.
    ///
    /// # Accuracy
    /// Off by a factor of up to 2.5 in six crowds that were measured, of 1.3 to 6 balls a pixel.
    fn cost_of_edges(&self, balls: usize) -> f64 {
        let of_pair = if self.raster.has_shadows() {
            200.0
        } else {
            95.0
        };
        of_pair * (balls * balls.saturating_sub(1)) as f64
    }
}

/// What some tiles tell about the time that a picture takes, in samples.
struct Probed {
    /// The samples on a side of a pixel of these tiles.
    probe: u32,
    /// With each of [`SIDES`].
    costs: [f64; SIDES.len()],
    /// Without a raster.
    edges: f64,
}

impl Probed {
    /// The number of samples that takes the least time, none less than the tiles had, and this time.
    fn least(&self) -> Option<(u32, f64)> {
        let sides = SIDES.into_iter().zip(self.costs);
        let sides = sides.filter(|(side, _)| *side >= self.probe);
        sides.min_by(|one, other| one.1.total_cmp(&other.1))
    }
}

/// The tiles that are rasterized to find out how many samples pay, about.
const PROBES: u64 = 64;

/// Samples on a side of a pixel to find that out with: more where spheres are too small for the first.
const PROBING: [u32; 3] = [4, 8, 16];

/// What a raster takes for each pixel besides its samples, in samples.
const OF_RASTER: f64 = 120.0;

/// The power of the distance of samples with which errors fall, about.
const POWER: f64 = 1.4;

/// The standard errors that are claimed, with so many samples on a side of a pixel.
///
/// # Accuracy
/// An estimate: see [`Judged`]. Of 800,000 pixels of six crowds, none was off by more than .77 of this.
fn deviations(side: u32) -> f64 {
    match side {
        ..6 => 8.0,
        6..8 => 7.0,
        8.. => 6.0,
    }
}

/// The pixels of a tile that samples answer for, for one integrator after the other.
#[derive(Debug, Default)]
pub(super) struct OfCrowds {
    raster: raster::Scratch,
    /// In the order of [`Tile::pixels`], or none.
    pixels: Vec<Vec<Option<Pixel>>>,
}

impl OfCrowds {
    /// Finds the pixels of a tile for each of some integrators, if they have a raster; returns what they cost.
    pub(super) fn find<'crowd>(
        &mut self,
        crowds: impl ExactSizeIterator<Item = Option<&'crowd CrowdSamples<'crowd>>>,
        tile: Tile,
    ) -> Work {
        let mut work = Work::default();
        self.pixels.resize(crowds.len(), Vec::new());
        for (crowd, pixels) in crowds.zip(&mut self.pixels) {
            pixels.clear();
            if let Some(crowd) = crowd {
                work.samples += crowd.pixels(tile, &mut self.raster, pixels);
            }
        }
        work
    }

    /// The pixels that are known under all lights, bit by bit.
    pub(super) fn known(&self) -> u64 {
        let known = |pixels: &Vec<Option<Pixel>>| {
            let bits = pixels.iter().enumerate();
            bits.fold(0, |known, (place, pixel)| {
                known | u64::from(pixel.is_some()) << place
            })
        };
        self.pixels
            .iter()
            .map(known)
            .fold(!0, |all, known| all & known)
    }

    /// The pixels of one of the integrators, if samples answer for all of them.
    pub(super) fn all(&self, number: usize) -> Option<Vec<Pixel>> {
        let pixels = self.pixels.get(number)?;
        if pixels.is_empty() {
            return None;
        }
        pixels.iter().copied().collect()
    }

    /// Replaces the pixels of one of the integrators that samples answer for.
    pub(super) fn replace(&self, number: usize, pixels: &mut [Pixel]) {
        for (pixel, found) in pixels.iter_mut().zip(&self.pixels[number]) {
            *pixel = found.unwrap_or(*pixel);
        }
    }
}

#[cfg(test)]
mod tests;
