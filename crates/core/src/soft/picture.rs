//! Pixels under soft light.

use std::num::NonZeroU32;

use glam::DVec2;

use super::candidate::Candidate;
use super::cell::Cells;
use super::light::SoftLight;
use super::of_sky::{OfSky, SkyMemory};
use super::of_sun::{OfSun, SunMemory, strongest_highlight};
use super::point::SurfacePoint;
use super::rays::{RayMemory, SkyPixel};
use super::rectangle::Integral;
use super::scene::Soft;
use super::visible::Hidden;
use crate::model::color::Color;
use crate::model::roughness::noise::NoiseCells;
use crate::picture::pixel::{Evidence, Method, Pixel, Status, Work};
use crate::picture::tile::Tile;

/// Memory for a thread.
#[derive(Debug, Default)]
pub(crate) struct Scratch {
    /// None before the first tile with soft light: most worlds have none.
    cells: Option<Box<Cells>>,
    of_suns: Option<Box<SunMemory>>,
    of_skies: Option<Box<SkyMemory>>,
    rays: Option<Box<RayMemory>>,
    hidden: Hidden,
    /// None before the first rough sample.
    noise: Option<Box<NoiseCells>>,
}

/// The points at which the light of a pixel may be computed; those under a sky where a surface is rough, for which no patch
/// stands. Not tuned.
const MOST_POINTS: u64 = 100_000;
const MOST_ROUGH_POINTS: u64 = 20_000;

/// What is left of a number after rounding.
const WITHOUT_ROUNDING: f64 = 1.0 - 1e-12;

impl Soft<'_> {
    /// Adds the soft light to the pixels of a tile, in the order of [`Tile::pixels`]; returns what it costs.
    pub(crate) fn add(&self, tile: Tile, scratch: &mut Scratch, pixels: &mut [Pixel]) -> Work {
        match self.method {
            Method::Samples(samples) => self.add_samples(tile, samples, scratch, pixels),
            Method::Tolerance(tolerance) => self.add_averages(tile, tolerance, scratch, pixels),
        }
    }

    fn light_at(&self, point: &SurfacePoint, hidden: &mut Hidden) -> Color {
        let occluders = self.occluders();
        let lights = self.lights.iter();
        lights
            .map(|light| light.at(point, self.world, occluders.as_ref(), hidden))
            .sum()
    }

    /// The mean over N × N samples of each pixel.
    fn add_samples(
        &self,
        tile: Tile,
        samples: NonZeroU32,
        scratch: &mut Scratch,
        pixels: &mut [Pixel],
    ) -> Work {
        let side = u64::from(samples.get());
        let count = (side * side) as f64;
        let candidates = self.candidates(tile).unwrap_or_default();
        let projection = self.view.lens.projection();
        for ((col, row), pixel) in tile.pixels().zip(pixels) {
            let key = self.key(col, row);
            let (mut sum, mut least, mut most) = (Color::ZERO, Color::INFINITY, Color::ZERO);
            for place in 0..side * side {
                let (x, y) = (place % side, place / side);
                let cell = (u64::from(col) * side + x, u64::from(row) * side + y);
                let at = self.view.cell_center(cell.0, cell.1, samples.get());
                let ray = self.view.ray(at);
                let DVec2 { x, y } = at * self.unit_of_cells();
                let is_dark = candidates.iter().any(|one| {
                    let inside = one.distance(x, y, projection);
                    one.hides_light && inside.is_some_and(|(_, is_inside)| is_inside)
                });
                let light = match self.index.nearest(tile, &ray) {
                    Some((sphere, hit)) if !is_dark && !self.is_outline(sphere, &ray, &hit) => {
                        let point = self.point(sphere, &ray, &hit, key, &mut scratch.noise);
                        point.map(|point| self.light_at(&point, &mut scratch.hidden))
                    }
                    _ => None,
                };
                let light = light.unwrap_or_default();
                sum += light;
                least = least.min(light);
                most = most.max(light);
            }
            pixel.value += sum / count;
            pixel.error += (most - least).max_element() / (2.0 * side as f64);
            pixel.evidence = Evidence::Estimate;
        }
        Work::default()
    }

    /// The averages over pixels.
    fn add_averages(
        &self,
        tile: Tile,
        tolerance: f64,
        scratch: &mut Scratch,
        pixels: &mut [Pixel],
    ) -> Work {
        let candidates = self.candidates(tile);
        let Scratch {
            cells,
            of_suns,
            of_skies,
            rays,
            hidden,
            ..
        } = scratch;
        let of_suns = of_suns.get_or_insert_default();
        let of_skies = of_skies.get_or_insert_default();
        let cells = cells.get_or_insert_default();
        let before = cells.points;
        let projection = self.view.lens.projection();
        let is_rough = |candidate: &Candidate| {
            let material = self.world.material(candidate.sphere);
            material.roughness.is_some()
        };
        let most_of_sky = match &candidates {
            Some(candidates) if candidates.iter().any(is_rough) => MOST_ROUGH_POINTS,
            _ => MOST_POINTS,
        };
        // Of the tolerance, what hard light has left for soft light, at least the part that is its own.
        let of_hard_light = pixels
            .iter()
            .map(|pixel| pixel.error.min(Self::SHARE * tolerance));
        let mut rests: Vec<f64> = of_hard_light.map(|error| tolerance - error).collect();
        let least = WITHOUT_ROUNDING * (1.0 - Self::SHARE) * tolerance / self.lights.len() as f64;
        for (number, light) in self.lights.iter().enumerate() {
            let left = (self.lights.len() - number) as f64;
            cells.begin();
            of_skies.begin();
            let in_camera = match light {
                SoftLight::Sun(sun) => Some(sun.turned(&self.camera_from_world())),
                SoftLight::Sky(_) => None,
            };
            let casters = match (&in_camera, &candidates) {
                (Some(sun), Some(candidates)) => self.casters(tile, sun, candidates),
                _ => Vec::new(),
            };
            let pixels = tile.pixels().zip(&mut *pixels);
            for (((col, row), pixel), rest) in pixels.zip(&mut rests) {
                let key = self.key(col, row);
                let cell = (self.cell(col, row), projection);
                // A light may use up more than its share where it gives up.
                let share = (WITHOUT_ROUNDING * *rest / left).max(least);
                let average = match (&candidates, &in_camera) {
                    // Numbers that are too extreme.
                    (None, _) => Integral {
                        value: Color::ZERO,
                        error: light.brightest().max_element()
                            * (1.0 + strongest_highlight(self.world)),
                    },
                    (Some(candidates), Some(sun)) => {
                        let mut of_sun = OfSun {
                            world: self.world,
                            sun,
                            world_from_camera: &self.view.camera.world_from_camera,
                            projection,
                            key,
                            casters: &casters,
                            memory: of_suns,
                            hidden,
                        };
                        cells.average(&mut of_sun, cell, candidates, (share, MOST_POINTS))
                    }
                    (Some(candidates), None) => {
                        let SoftLight::Sky(sky) = light else { continue };
                        let of_pixel = SkyPixel {
                            sky,
                            cell: cell.0,
                            projection,
                            key,
                            tolerance: share,
                        };
                        let by_rays = self.by_rays(&of_pixel, candidates, rays, cells);
                        let mut of_sky = OfSky {
                            soft: self,
                            sky,
                            patches: self.index.visibility.patches(),
                            key,
                            projection,
                            pixel: cell.0.u[1] - cell.0.u[0],
                            side: cell.0.u[1] - cell.0.u[0],
                            allowed: share / sky.brightest().max_element(),
                            memory: of_skies,
                            hidden,
                        };
                        by_rays.unwrap_or_else(|| {
                            cells.average(&mut of_sky, cell, candidates, (share, most_of_sky))
                        })
                    }
                };
                *rest -= average.error;
                pixel.value += average.value;
                pixel.error += average.error;
                pixel.evidence = pixel.evidence.min(Evidence::Estimate);
            }
        }
        for pixel in pixels {
            if pixel.error <= tolerance {
                pixel.status = Status::Met;
            } else if pixel.status == Status::Met {
                pixel.status = Status::OutOfBudget;
            }
        }
        Work {
            samples: cells.points - before,
            ..Work::default()
        }
    }
}
