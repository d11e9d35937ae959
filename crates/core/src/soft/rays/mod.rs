//! The light of a sky in a pixel of a crowd, by rays.
//!
//! Where spheres are small on the screen, patches serve few pixels each, and their nodes see thousands of others. Rays take
//! less time then to a loose tolerance: [`net`] says where they begin and lead, and [`surroundings`] what stops them. Each
//! sphere's part of the pixel is known exactly ([`means`]); only its mean light comes from rays.
//!
//! # Accuracy
//! An estimate. The rays of a pixel are copies of a net with independent shifts: the deviation of the copies' means from each
//! other is that of the pixel from the truth, times the root of their number. The claim is [`FACTOR`] times that of the pixel:
//! of normal deviations, 1 pixel in 3,000,000 would be off by more. Three things could fool it. Copies may agree by chance, and
//! end the search: the claim is no less than a part of what fewer rays let expect. All rays may miss what is small: the claim
//! is at least the light of [`UNSEEN`] rays. A sphere may have a larger part of the pixel than of the places: one of few
//! places ([`FEW_PLACES`]) claims as much as these may deviate, on all of its part.

mod cube;
mod means;
mod net;
mod surroundings;
#[cfg(test)]
mod tests;

use std::sync::Arc;

use fearless_simd::Level;
use glam::Mat3;

use self::means::Means;
use self::net::{Net, Shift};
use self::surroundings::{FromSurface, Surroundings};
use super::behind::remove_hidden;
use super::candidate::Candidate;
use super::cap::Cap;
use super::cell::Cells;
use super::line::first;
use super::point::Occluders;
use super::rectangle::{Cell, Integral, Lit};
use super::scene::Soft;
use super::sky::light_of;
use crate::light::shading_normal::ShadingNormal;
use crate::model::camera::Projection;
use crate::model::color::Color;
use crate::model::roughness::PixelKey;
use crate::model::roughness::noise::NoiseCells;
use crate::model::sky::Sky;
use crate::patches::light::Shares;

/// Independent estimates of a pixel.
const COPIES: usize = 64;

/// Rays from a place.
const RAYS: u32 = 4;

/// Places of a copy: the first ones, and the most.
const FIRST: u32 = 1;
const MOST: u32 = net::MOST / RAYS;

/// The claim in standard deviations of the mean, and in parts of what it should be after that of fewer rays.
const FACTOR: f64 = 5.75;
const OF_FEWER: f64 = 0.85;

/// How many times as many rays are the next ones at most: what few tell is little.
const MORE: f64 = 4.0;

/// Rays whose light is claimed at least: if as many of them are dark in the mean, none is with a chance of 6e-6.
const UNSEEN: f64 = 12.0;

/// Spheres with fewer places may have a larger part of the pixel than of the places: they claim half of the brightest light
/// over the root of the number of their places.
const FEW_PLACES: u32 = 16;

/// The parts of the tolerance that are for rays, and for the parts that spheres have in the pixel.
const OF_RAYS: f64 = 0.75;
const OF_AREAS: f64 = 0.2;

/// In worlds of fewer spheres patches see little.
const CROWD: usize = 1 << 8;

/// The least tolerance, in parts of the brightest light.
const LEAST: f64 = 4e-3;

/// Spheres whose surroundings a thread keeps, each up to some 500 KB. Not tuned: a tile sees some ten.
const KEPT: usize = 64;

/// What a thread keeps for rays.
#[derive(Debug)]
pub(crate) struct RayMemory {
    net: Net,
    level: Level,
    /// The name of the world.
    name: u64,
    kept: Vec<Option<(usize, Arc<Surroundings>)>>,
    sums: Vec<Sums>,
    means: Vec<(usize, Lit)>,
    noise: Option<Box<NoiseCells>>,
}

impl Default for RayMemory {
    fn default() -> Self {
        Self {
            net: Net::new(),
            level: Level::new(),
            name: 0,
            kept: vec![None; KEPT],
            sums: Vec::new(),
            means: Vec::new(),
            noise: None,
        }
    }
}

impl RayMemory {
    fn around(&mut self, sphere: usize, occluders: &Occluders<'_>) -> Arc<Surroundings> {
        let kept = &mut self.kept[sphere % KEPT];
        match kept {
            Some((of, around)) if *of == sphere => Arc::clone(around),
            _ => {
                let around = Arc::new(Surroundings::new(sphere, occluders));
                *kept = Some((sphere, Arc::clone(&around)));
                around
            }
        }
    }
}

/// The light at the places where a sphere was seen, copy by copy.
#[derive(Clone, Debug)]
struct Sums {
    places: [u32; COPIES],
    light: [Color; COPIES],
    around: Option<Arc<Surroundings>>,
}

/// One pixel.
pub(crate) struct SkyPixel<'a> {
    pub(crate) sky: &'a Sky,
    pub(crate) cell: Cell,
    pub(crate) projection: Projection,
    pub(crate) key: PixelKey,
    pub(crate) tolerance: f64,
}

impl Soft<'_> {
    /// The average over a pixel by rays; none where patches are thought to take less time, or rays claim too much.
    pub(crate) fn by_rays(
        &self,
        pixel: &SkyPixel<'_>,
        candidates: &[Candidate],
        memory: &mut Option<Box<RayMemory>>,
        cells: &mut Cells,
    ) -> Option<Integral> {
        let occluders = self.occluders()?;
        let brightest = pixel.sky.brightest().max_element();
        let count = self.world.spheres().len();
        if pixel.tolerance < LEAST * brightest || count < CROWD {
            return None;
        }
        let (cell, projection) = (&pixel.cell, pixel.projection);
        let may_see = |one: &&Candidate| one.may_be_in(cell.u, cell.v, projection);
        let mut seen: Vec<Candidate> = candidates.iter().filter(may_see).copied().collect();
        remove_hidden(&mut seen, cell, projection);
        if seen.is_empty()
            || time_of_rays(pixel.tolerance / brightest) > time_of_patches(count, pixel.size(&seen))
        {
            return None;
        }
        let memory = &mut **memory.get_or_insert_default();
        let name = self.index.visibility.patches().name();
        if memory.name != name {
            memory.name = name;
            memory.kept.fill(None);
        }
        memory.sums.clear();
        let none = Sums {
            places: [0; COPIES],
            light: [Color::ZERO; COPIES],
            around: None,
        };
        memory.sums.resize(seen.len(), none);
        let shifts = Shift::all(pixel.key, COPIES);
        let (mut begin, mut end, mut claim) = (0, FIRST, 0.0_f64);
        let most = OF_RAYS * pixel.tolerance;
        loop {
            for number in begin..end {
                for (copy, shift) in shifts.iter().enumerate() {
                    self.add_place(pixel, &seen, &occluders, (number, copy, shift), memory);
                }
            }
            cells.points += u64::from(end - begin) * COPIES as u64;
            let of_fewer = OF_FEWER * claim * (f64::from(begin) / f64::from(end)).sqrt();
            claim = judge(&seen, memory, end, brightest).max(of_fewer);
            let mut times = 1.1 * (claim / most).powi(2);
            if claim <= most {
                let mut means = Means {
                    known: &memory.means,
                    brightest,
                };
                let of_areas = (OF_AREAS * pixel.tolerance, MOST_POINTS);
                let area = cells.average(&mut means, (*cell, projection), candidates, of_areas);
                let error = area.error + claim;
                if error <= pixel.tolerance {
                    return Some(Integral { error, ..area });
                }
                times = MORE;
            }
            if end == MOST {
                return None;
            }
            begin = end;
            end = ((f64::from(end) * times.min(MORE)).ceil() as u32).min(MOST);
        }
    }

    /// Adds the light at a place of a copy.
    fn add_place(
        &self,
        pixel: &SkyPixel<'_>,
        seen: &[Candidate],
        occluders: &Occluders<'_>,
        (number, copy, shift): (u32, usize, &Shift),
        memory: &mut RayMemory,
    ) {
        let Cell { u, v } = pixel.cell;
        let [x, y] = memory.net.place(number, shift);
        let (u, v) = (u[0] + (u[1] - u[0]) * x, v[0] + (v[1] - v[0]) * y);
        let Some((place, true)) = first(seen, u, v, pixel.projection) else {
            return;
        };
        let candidate = &seen[place];
        let point = candidate.surface_point(u, v, pixel.projection);
        let normal = self.view.camera.world_from_camera * point.normal;
        let shading = ShadingNormal::new(self.world, candidate.sphere, pixel.key)
            .of(normal, &mut memory.noise);
        let frame = Cap::below(-shading).frame();
        let axes = Mat3::from_cols(frame.x.as_vec3(), frame.y.as_vec3(), shading.as_vec3());
        let normal = normal.as_vec3();
        let around = memory.sums[place].around.take();
        let around = around.unwrap_or_else(|| memory.around(candidate.sphere, occluders));
        let up = (pixel.sky.above != pixel.sky.below).then(|| pixel.sky.up.as_vec3());
        let mut shares = Shares::ZERO;
        for ray in number * RAYS..(number + 1) * RAYS {
            let direction = axes * memory.net.direction(ray, shift);
            let from_surface = FromSurface { normal, direction };
            if direction.dot(normal) <= 0.0
                || around.stops(memory.level, &from_surface, candidate.sphere, occluders)
            {
                continue;
            }
            if up.is_some_and(|up| direction.dot(up) > 0.0) {
                shares.y += 1.0 / f64::from(RAYS);
            } else {
                shares.x += 1.0 / f64::from(RAYS);
            }
        }
        let light = self.world.albedo(candidate.sphere) * light_of(pixel.sky, shares);
        let sums = &mut memory.sums[place];
        sums.around = Some(around);
        sums.places[copy] += 1;
        sums.light[copy] += light;
    }
}

/// The time that rays take for a pixel, in milliseconds of one thread, to a tolerance in parts of the brightest light.
///
/// This and the next one are rough: they are from crowds of 200 to 100,000 spheres, of 1.6 to 20 pixels.
fn time_of_rays(tolerance: f64) -> f64 {
    0.1 + 2.0 * (1e-2 / tolerance).powi(2)
}

/// The same of patches on spheres of a radius in pixels, in a world of so many.
fn time_of_patches(count: usize, radius: f64) -> f64 {
    0.14 * libm::pow(count as f64 / 1e3, 0.8) * libm::pow(20.0 / radius, 1.36)
}

/// The points of light that is the same all over a sphere: enough for all edges of a pixel.
const MOST_POINTS: u64 = 20_000;

impl SkyPixel<'_> {
    /// The radius of spheres, in pixels: that of one that covers as much as they do in the mean of their inverses.
    fn size(&self, seen: &[Candidate]) -> f64 {
        let width = self.cell.u[1] - self.cell.u[0];
        let of_one = |one: &Candidate| {
            let distance = match self.projection {
                Projection::Central => one.center.length(),
                Projection::Parallel => 1.0,
            };
            let radius = one.radius / (distance * width);
            1.0 / (radius * radius)
        };
        let sum: f64 = seen.iter().map(of_one).sum();
        (seen.len() as f64 / sum).sqrt()
    }
}

/// Finds the means of all spheres that places of a pixel see; returns what the mean of so many places of each copy is
/// off by at most.
fn judge(seen: &[Candidate], memory: &mut RayMemory, places: u32, brightest: f64) -> f64 {
    let RayMemory { sums, means, .. } = memory;
    means.clear();
    let mut residuals = [Color::ZERO; COPIES];
    for (sums, candidate) in sums.iter().zip(seen) {
        let count: u32 = sums.places.iter().sum();
        if count == 0 {
            continue;
        }
        let mean = sums.light.iter().copied().sum::<Color>() / f64::from(count);
        let error = if count < FEW_PLACES {
            0.5 * brightest / f64::from(count).sqrt()
        } else {
            0.0
        };
        means.push((candidate.number, Lit { light: mean, error }));
        for (copy, residual) in residuals.iter_mut().enumerate() {
            *residual += sums.light[copy] - mean * f64::from(sums.places[copy]);
        }
    }
    let squares: Color = residuals.iter().map(|residual| *residual * *residual).sum();
    let copies = COPIES as f64;
    let count = f64::from(places) * copies;
    let deviation = (squares.max_element() * copies / (copies - 1.0)).sqrt() / count;
    let least = UNSEEN / (count * f64::from(RAYS));
    (FACTOR * deviation).max(least * brightest)
}
