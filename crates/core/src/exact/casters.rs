//! What may keep lights from what a tile sees, and from what a pixel sees of that.

use std::ops::Range;

use fearless_simd::prelude::*;
use fearless_simd::{Level, Simd, dispatch, f64x8};

use super::contents::{Patch, Shade};
use super::scene::{InCamera, Light};
use super::squares;
use crate::edges::cell::Cell;
use crate::edges::silhouette::silhouette;
use crate::numeric::bits::set_bits;

/// Spheres as a light sees them, in rows of numbers.
#[derive(Clone, Debug, Default)]
pub(crate) struct Discs {
    x: Vec<f64>,
    y: Vec<f64>,
    /// How far toward the light.
    height: Vec<f64>,
    radius: Vec<f64>,
    /// What rounding may move them by.
    slack: Vec<f64>,
}

/// A sphere as a light sees it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Disc {
    pub(crate) x: f64,
    pub(crate) y: f64,
    pub(crate) height: f64,
    pub(crate) radius: f64,
    pub(crate) slack: f64,
}

impl Discs {
    pub(crate) fn get(&self, index: usize) -> Disc {
        Disc {
            x: self.x[index],
            y: self.y[index],
            height: self.height[index],
            radius: self.radius[index],
            slack: self.slack[index],
        }
    }

    fn push(&mut self, disc: &Disc) {
        self.x.push(disc.x);
        self.y.push(disc.y);
        self.height.push(disc.height);
        self.radius.push(disc.radius);
        self.slack.push(disc.slack);
    }
}

/// Of spheres with a radius of fewer pixels, casters are sought for all of the sphere, not for what a
/// tile sees of it; which is how pixels stay the same in any tile.
const SMALL: f64 = 4.0;

/// The spheres that may keep lights from what a tile sees, found when they are asked for.
#[derive(Clone, Debug)]
pub(crate) struct CasterCache {
    tile: Cell,
    /// The side of a pixel at distance 1.
    pixel: f64,
    pub(crate) level: Level,
    /// Sphere, light, and where their casters stand; none where they leave no light at all.
    known: Vec<(usize, usize, Option<Range<usize>>)>,
    pub(crate) discs: Discs,
    indices: Vec<u32>,
    /// Casters whose shadows have edges on the patch that was asked for last.
    pub(crate) found: Vec<u32>,
    edges: Vec<u32>,
    /// Casters that were asked whether they matter.
    pub(crate) tests: u64,
}

impl CasterCache {
    /// Nothing is known yet of the tile that covers this cell, with pixels of this side.
    pub(crate) fn new(tile: Cell, pixel: f64) -> Self {
        Self {
            tile,
            pixel,
            level: Level::new(),
            known: Vec::new(),
            discs: Discs::default(),
            indices: Vec::new(),
            found: Vec::new(),
            edges: Vec::new(),
            tests: 0,
        }
    }

    /// Where the discs of the spheres are that may keep a light from a sphere; nowhere where they keep it
    /// from all of the sphere.
    pub(crate) fn casters(
        &mut self,
        scene: &InCamera<'_>,
        sphere: usize,
        light: usize,
    ) -> Option<Range<usize>> {
        let known = self
            .known
            .iter()
            .find(|known| known.0 == sphere && known.1 == light);
        if let Some((_, _, range)) = known {
            return range.clone();
        }
        let ball = scene.ball(sphere);
        let is_small = ball.radius < SMALL * self.pixel * ball.center.z;
        let patch = if is_small {
            Patch {
                ends: [ball.center; 2],
                around: ball.radius + 1e-12 * ball.center.length(),
            }
        } else {
            let discriminant = silhouette(&self.tile, &ball);
            let along = self.tile.dot(ball.center);
            Patch::new(&self.tile, &ball, &discriminant, &along)
        };
        let points = patch.ends.map(|point| scene.in_world(point));
        let around = patch.around * (1.0 + 1e-9);
        let first = self.indices.len();
        let of_light = &scene.lights[light];
        let spheres = scene.world.spheres();
        let own = spheres[sphere];
        let mut cover = Cover::new(self.level, &patch, of_light);
        let is_dark = scene
            .visibility
            .any_occluder(of_light.index, &points, around, |candidate| {
                self.tests += 1;
                if candidate == sphere || spheres[candidate] == own {
                    return false;
                }
                let (center, radius) = scene.center(candidate);
                let disc = Disc {
                    x: center.dot(of_light.right),
                    y: center.dot(of_light.up),
                    height: center.dot(of_light.toward),
                    radius,
                    slack: 2e-12 * center.abs().max_element(),
                };
                self.discs.push(&disc);
                self.indices.push(candidate as u32);
                if !is_small {
                    return false;
                }
                cover.add(&disc);
                cover.is_full()
            });
        let range = (!is_dark).then_some(first..self.indices.len());
        self.known.push((sphere, light, range.clone()));
        range
    }

    /// Finds the casters of a range whose shadows have edges on a patch; whether they leave any light
    /// there at all.
    pub(crate) fn edges(&mut self, patch: &Patch, light: &Light, range: Range<usize>) -> Shade {
        self.found.clear();
        self.edges.clear();
        let level = self.level;
        let is_dark = dispatch!(level, simd => self.find_edges(simd, patch, light, range));
        if is_dark {
            return Shade::Everything;
        }
        // Pixels do not depend on what else is in their tile.
        self.edges
            .sort_unstable_by_key(|&edge| self.indices[edge as usize]);
        if self.edges.len() > 1 {
            let mut cover = Cover::new(self.level, patch, light);
            self.edges.retain(|&edge| {
                let disc = self.discs.get(edge as usize);
                let matters = !cover.hides(&disc);
                if matters {
                    cover.add(&disc);
                }
                matters
            });
            if cover.is_full() {
                return Shade::Everything;
            }
        }
        for &edge in &self.edges {
            self.found.push(self.indices[edge as usize]);
        }
        if self.found.is_empty() {
            Shade::Nothing
        } else {
            Shade::Edge
        }
    }

    /// Finds them; whether one of them hides the light from all of the patch.
    #[inline(always)]
    fn find_edges<S: Simd>(
        &mut self,
        simd: S,
        patch: &Patch,
        light: &Light,
        range: Range<usize>,
    ) -> bool {
        let zero = f64x8::splat(simd, 0.0);
        let [start, end] = patch.ends;
        let [ax, bx] = [start.dot(light.right), end.dot(light.right)];
        let [ay, by] = [start.dot(light.up), end.dot(light.up)];
        let [az, bz] = [start.dot(light.toward), end.dot(light.toward)];
        let (dx, dy) = (bx - ax, by - ay);
        let way_sq = dx * dx + dy * dy;
        let scale = if way_sq > 0.0 { -1.0 / way_sq } else { 0.0 };
        let mut first = range.start;
        while first < range.end {
            let count = (range.end - first).min(8);
            let x: f64x8<S> = eight(&self.discs.x, first).simd_into(simd);
            let y: f64x8<S> = eight(&self.discs.y, first).simd_into(simd);
            let height: f64x8<S> = eight(&self.discs.height, first).simd_into(simd);
            let radius: f64x8<S> = eight(&self.discs.radius, first).simd_into(simd);
            let slack: f64x8<S> = eight(&self.discs.slack, first).simd_into(simd);
            let around = slack + patch.around;
            let (x0, y0) = (ax - x, ay - y);
            let (x1, y1) = (bx - x, by - y);
            let (z0, z1) = (az - height, bz - height);
            let share = ((x0 * dx + y0 * dy) * scale)
                .max(zero)
                .min(f64x8::splat(simd, 1.0));
            let (near_x, near_y) = (x0 + share * dx, y0 + share * dy);
            let reach = radius + around;
            let is_near = (near_x * near_x + near_y * near_y).simd_le(reach * reach)
                & z0.min(z1).simd_le(around);
            let inner = (radius - around).max(zero);
            let far_sq = (x0 * x0 + y0 * y0).max(x1 * x1 + y1 * y1);
            let is_over = far_sq.simd_lt(inner * inner) & z0.max(z1).simd_lt(-around);
            let valid = (1 << count) - 1;
            if is_over.to_bitmask() & valid != 0 {
                return true;
            }
            for lane in set_bits(is_near.to_bitmask() & valid) {
                self.edges.push((first + lane) as u32);
            }
            first += count;
        }
        false
    }
}

/// Eight numbers from a place on; zeros where there are none.
#[inline(always)]
fn eight(numbers: &[f64], first: usize) -> [f64; 8] {
    let mut eight = [0.0; 8];
    let rest = &numbers[first..];
    let count = rest.len().min(8);
    eight[..count].copy_from_slice(&rest[..count]);
    eight
}

#[cfg(test)]
impl CasterCache {
    /// What some casters under a light would be kept as, and where.
    pub(crate) fn of(
        casters: &[crate::edges::shadow::Caster],
        light: &Light,
    ) -> (Self, Range<usize>) {
        let tile = Cell {
            middle: glam::DVec3::Z,
            size: [1.0; 2],
            is_transposed: false,
        };
        let mut cache = Self::new(tile, 1.0);
        for (index, caster) in (0..).zip(casters) {
            cache.discs.push(&Disc {
                x: caster.center.dot(light.right),
                y: caster.center.dot(light.up),
                height: caster.center.dot(light.toward),
                radius: caster.radius,
                slack: 2e-12 * caster.center.abs().max_element(),
            });
            cache.indices.push(index);
        }
        (cache, 0..casters.len())
    }

    /// The indices of the spheres of a range.
    pub(crate) fn listed(&self, range: Option<Range<usize>>) -> Vec<usize> {
        let indices = &self.indices[range.unwrap_or(0..0)];
        indices.iter().map(|&index| index as usize).collect()
    }
}

/// What discs cover of the box around a patch, as a light sees it: in squares, a bit each.
#[derive(Clone, Copy, Debug)]
struct Cover {
    level: Level,
    low: [f64; 2],
    step: [f64; 2],
    /// Nothing of the patch lies higher.
    top: f64,
    covered: u64,
}

impl Cover {
    fn new(level: Level, patch: &Patch, light: &Light) -> Self {
        let mut places = [[0.0; 2]; 3];
        for (place, axis) in places.iter_mut().zip([light.right, light.up, light.toward]) {
            *place = patch.ends.map(|end| end.dot(axis));
        }
        let most = places
            .iter()
            .flatten()
            .fold(0.0_f64, |most, x| most.max(x.abs()));
        let around = patch.around + 1e-12 * most;
        let [x, y, height] = places;
        let low = [x[0].min(x[1]) - around, y[0].min(y[1]) - around];
        let high = [x[0].max(x[1]) + around, y[0].max(y[1]) + around];
        Self {
            level,
            low,
            step: [
                (high[0] - low[0]) / squares::SIDE as f64,
                (high[1] - low[1]) / squares::SIDE as f64,
            ],
            top: height[0].max(height[1]) + around,
            covered: 0,
        }
    }

    fn is_full(&self) -> bool {
        self.covered == squares::ALL
    }

    /// Covers the cells whose corners lie in a disc that is wholly above the patch.
    fn add(&mut self, disc: &Disc) {
        let radius = disc.radius - disc.slack;
        if radius > 0.0 && disc.height - disc.slack > self.top {
            self.covered |= squares::between(self.lines(disc, 0.0, radius, 1e-9));
        }
    }

    /// Whether all cells that a disc may touch are covered.
    fn hides(&self, disc: &Disc) -> bool {
        if self.covered == 0 {
            return false;
        }
        // A cell is touched where its middle is no farther than half its diagonal.
        let [x, y] = self.step;
        let reach = disc.radius + disc.slack + 0.5 * (x * x + y * y).sqrt() * (1.0 + 1e-9);
        self.lines(disc, 0.5, reach, -1e-9) & squares::ALL & !self.covered == 0
    }

    /// Which points of the grid lie in a circle around a disc's middle: a byte for each of eight lines,
    /// which are shifted by a part of a cell.
    fn lines(&self, disc: &Disc, shift: f64, radius: f64, margin: f64) -> u64 {
        dispatch!(self.level, simd => self.lines_of(simd, disc, shift, radius, margin))
    }

    #[inline(always)]
    fn lines_of<S: Simd>(&self, simd: S, disc: &Disc, shift: f64, radius: f64, margin: f64) -> u64 {
        let lines: [f64; 8] = [0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0];
        let lines: f64x8<S> = lines.simd_into(simd);
        let y = (lines + shift) * self.step[1] + (self.low[1] - disc.y);
        let rest = y * y * -1.0 + radius * radius;
        let half = rest.max(f64x8::splat(simd, 0.0)).sqrt() * (1.0 / self.step[0]);
        let middle = (disc.x - self.low[0]) / self.step[0] - shift;
        let (first, last): ([f64; 8], [f64; 8]) = (
            (middle - half + margin).into(),
            (half + (middle - margin)).into(),
        );
        let inside = rest.simd_gt(0.0).to_bitmask();
        let mut bits = 0;
        for line in 0..8 {
            let first = first[line].ceil().clamp(0.0, 8.0) as u32;
            let end = (last[line].floor() + 1.0).clamp(0.0, 8.0) as u32;
            if inside >> line & 1 == 1 && first < end {
                let row = (1_u64 << end) - (1 << first);
                bits |= row << (8 * line);
            }
        }
        bits
    }
}
