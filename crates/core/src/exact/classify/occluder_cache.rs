//! The occluders of what a tile sees, and those of what a pixel sees of that.

use std::ops::Range;

use fearless_simd::{Level, Simd, dispatch};
use glam::DVec3;

use super::no_shade::{is_behind, may_begin_inside};
use super::occluders::{Occluder, Occluders, eight};
use super::patch::{Patch, distance_from_cone};
use super::shade_mask::ShadeMask;
use crate::edges::cell::{Ball, Cell};
use crate::edges::silhouette::silhouette;
use crate::exact::scene::{InCamera, Light};
use crate::model::camera::Projection;
use crate::numeric::bits::set_bits;
use crate::numeric::lanes::f64x8;
use crate::numeric::rounding::{GEOMETRY_SLACK, WIDER};
use crate::search::point_occluders::{Beam, Before};

/// The radius in pixels of spheres whose occluders are sought for all of the sphere, not for what a tile
/// sees of it, where they are smaller; which is how pixels stay the same in any tile. A small sphere lies
/// in few tiles, so that little is gained by less. Not tuned.
const SMALL_PX: f64 = 4.0;

/// The spheres that may keep lights from what a tile sees, found when they are asked for.
#[derive(Clone, Debug)]
pub(crate) struct OccluderCache {
    tile: Cell,
    /// The shorter side of a pixel at distance 1; for parallel rays at any.
    pixel: f64,
    pub(crate) level: Level,
    known: Vec<Known>,
    occluders: Occluders,
    /// Their numbers in the scene.
    spheres: Vec<u32>,
    /// Memory of [`Self::shade`]: indices of occluders, and then the numbers of their spheres.
    edges: Vec<u32>,
    /// The shadow edges that [`Self::shade`] has held against each other since they were counted.
    pub(super) compared: u64,
    /// The work in which the tile's occluders are sought and held against what they may shade, in the units of crowds, and
    /// the most of it.
    pub(crate) units: u64,
    most_units: u64,
    /// The number of spheres that were asked whether they matter.
    pub(crate) tests: u64,
}

/// The occluders of a sphere under a light; none where they leave no light at all.
#[derive(Clone, Debug)]
struct Known {
    sphere: usize,
    light: usize,
    range: Option<Range<usize>>,
}

/// The shadow on a patch.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub(crate) enum Shade<'a> {
    Nothing,
    /// The numbers of the spheres whose shadows have edges there.
    Edges(&'a [u32]),
    Everything,
    /// More spheres than are held against each other.
    Crowd,
}

/// The shadow edges on a patch of which more are not held against each other. Not tuned: a pixel has no use for as many.
const MOST_EDGES: usize = 1 << 14;

/// The shadow edges that others leave on a patch of which more are not told apart: half as many are more than a part of a
/// pixel may have.
const MOST_KEPT: usize = 1 << 10;

/// The units of crowds in which a sphere is asked whether it is an occluder, and in which a shadow edge is held against
/// those before it.
const UNITS_OF_OCCLUDER: u64 = 2;
const UNITS_OF_EDGE: u64 = 6;

impl OccluderCache {
    /// Nothing is known yet of the tile that covers this cell, with pixels whose shorter side is this.
    pub(crate) fn new(tile: Cell, pixel: f64) -> Self {
        Self {
            tile,
            pixel,
            level: Level::new(),
            known: Vec::new(),
            occluders: Occluders::default(),
            spheres: Vec::new(),
            edges: Vec::new(),
            compared: 0,
            units: 0,
            most_units: u64::MAX,
            tests: 0,
        }
    }

    /// Forgets a tile, and begins with the one that covers this cell, with pixels whose shorter side is this, where
    /// occluders may cost so many units.
    pub(crate) fn begin(&mut self, tile: Cell, pixel: f64, most_units: u64) {
        self.tile = tile;
        self.pixel = pixel;
        self.known.clear();
        self.occluders.clear();
        self.spheres.clear();
        self.units = 0;
        self.most_units = most_units;
        self.tests = 0;
    }

    /// Returns whether the tile's occluders have cost all that they may: nothing more is known of its shadows.
    pub(crate) fn is_exhausted(&self) -> bool {
        self.units > self.most_units
    }

    /// The most occluders that a sphere of the tile was found to have.
    pub(crate) fn most_occluders(&self) -> usize {
        let ranges = self.known.iter().filter_map(|known| known.range.as_ref());
        ranges.map(|range| range.len()).max().unwrap_or(0)
    }

    /// One of the occluders of a range.
    pub(crate) fn occluder(&self, index: usize) -> Occluder {
        self.occluders.get(index)
    }

    /// The occluders that may keep a light from a sphere; none where they keep it from all of the sphere.
    pub(crate) fn occluders(
        &mut self,
        scene: &InCamera<'_>,
        sphere: usize,
        light: usize,
    ) -> Option<Range<usize>> {
        let mut known = self.known.iter();
        if let Some(known) = known.find(|known| known.sphere == sphere && known.light == light) {
            return known.range.clone();
        }
        let range = self.find(scene, sphere, light);
        self.known.push(Known {
            sphere,
            light,
            range: range.clone(),
        });
        range
    }

    /// The number in the scene of one of the occluders of a range.
    pub(crate) fn sphere(&self, index: usize) -> usize {
        self.spheres[index] as usize
    }

    /// The occluders that may keep a point light from a sphere, in the order of their numbers.
    pub(crate) fn occluders_of_near(
        &mut self,
        scene: &InCamera<'_>,
        sphere: usize,
        light: usize,
    ) -> Range<usize> {
        let mut known = self.known.iter();
        if let Some(known) = known.find(|known| known.sphere == sphere && known.light == light) {
            return known.range.clone().unwrap_or(0..0);
        }
        let range = self.find_near(scene, sphere, light);
        self.known.push(Known {
            sphere,
            light,
            range: Some(range.clone()),
        });
        range
    }

    /// Looks for these in the hierarchy.
    fn find_near(&mut self, scene: &InCamera<'_>, sphere: usize, light: usize) -> Range<usize> {
        let first = self.spheres.len();
        let of_light = &scene.lights[light];
        let spheres = scene.world.spheres();
        let own = spheres[sphere];
        let patch = self.patch_of_tile(&scene.ball(sphere));
        let (middle, around) = patch.ball();
        let occluders = scene.visibility.point_light(of_light.index);
        if let (Some(occluders), Some(near)) = (occluders, &of_light.near) {
            let apex = scene.in_world(near.position);
            let beam = Beam::new(apex, scene.in_world(middle), around * WIDER);
            let before = Before {
                around: MARGIN * around,
                eye: scene.in_world(DVec3::ZERO),
            };
            let is_parallel = self.tile.is_parallel();
            let add = |candidate: usize| {
                self.tests += 1;
                self.units += UNITS_OF_OCCLUDER;
                let (center, radius) = scene.center(candidate);
                let is_behind = is_behind(center, near.position, (middle, before.around));
                let keeps = !is_behind || may_begin_inside(is_parallel, center, radius);
                if keeps && candidate != sphere && spheres[candidate] != own {
                    self.spheres.push(candidate as u32);
                }
                false
            };
            // Parallel rays begin in a plane, where no box says which spheres they begin inside of.
            if is_parallel {
                occluders.any_in(&beam, add);
            } else {
                occluders.any_before(&beam, &before, add);
            }
        }
        self.spheres[first..].sort_unstable();
        // Both lists have the same places.
        for index in first..self.spheres.len() {
            let (center, radius) = scene.center(self.spheres[index] as usize);
            self.occluders
                .push(&Occluder::new(center, radius, of_light));
        }
        first..self.spheres.len()
    }

    /// The part of a ball that the tile sees; all of a small one.
    fn patch_of_tile(&self, ball: &Ball) -> Patch {
        if self.is_small(ball) {
            return Patch {
                ends: [ball.center; 2],
                around: ball.radius + GEOMETRY_SLACK * ball.center.length(),
                is_parallel: false,
            };
        }
        let discriminant = silhouette(&self.tile, ball);
        let along = self.tile.along(ball.center);
        Patch::new(&self.tile, ball, &discriminant, &along)
    }

    /// Returns whether occluders are sought for all of a ball.
    fn is_small(&self, ball: &Ball) -> bool {
        let distance = match ball.projection {
            Projection::Central => ball.center.z,
            Projection::Parallel => 1.0,
        };
        ball.radius < SMALL_PX * self.pixel * distance
    }

    /// Looks for those of a directional light in the hierarchy.
    fn find(&mut self, scene: &InCamera<'_>, sphere: usize, light: usize) -> Option<Range<usize>> {
        let ball = scene.ball(sphere);
        let is_small = self.is_small(&ball);
        let patch = self.patch_of_tile(&ball);
        let points = patch.ends.map(|point| scene.in_world(point));
        let around = patch.around * WIDER;
        let first = self.spheres.len();
        let of_light = &scene.lights[light];
        let spheres = scene.world.spheres();
        let own = spheres[sphere];
        let mut mask = ShadeMask::new(self.level, &patch, of_light);
        let heights = patch.ends.map(|end| end.dot(of_light.toward));
        let lowest = heights[0].min(heights[1]) - 2.0 * around;
        let is_dark = scene
            .visibility
            .any_occluder(of_light.index, &points, around, |candidate| {
                self.tests += 1;
                self.units += UNITS_OF_OCCLUDER;
                if candidate == sphere || spheres[candidate] == own {
                    return false;
                }
                let (center, radius) = scene.center(candidate);
                let occluder = Occluder::new(center, radius, of_light);
                // Outside of a sphere only what lies lower than its center is shaded.
                if occluder.height + 2.0 * occluder.slack < lowest {
                    return false;
                }
                self.occluders.push(&occluder);
                self.spheres.push(candidate as u32);
                if !is_small {
                    return false;
                }
                mask.add(&occluder);
                mask.is_full()
            });
        (!is_dark).then_some(first..self.spheres.len())
    }

    /// The shadow of the occluders of a range on a patch.
    pub(crate) fn shade(&mut self, patch: &Patch, light: &Light, range: Range<usize>) -> Shade<'_> {
        self.edges.clear();
        let level = self.level;
        let is_dark = dispatch!(level, simd => self.find_edges(simd, patch, light, range));
        if is_dark {
            return Shade::Everything;
        }
        if self.edges.len() > MOST_EDGES {
            return Shade::Crowd;
        }
        self.compared += self.edges.len() as u64;
        // Pixels do not depend on what else is in their tile.
        self.edges
            .sort_unstable_by_key(|&edge| self.spheres[edge as usize]);
        if self.edges.len() > 1 {
            let mut mask = ShadeMask::new(self.level, patch, light);
            let mut kept = 0;
            for place in 0..self.edges.len() {
                let edge = self.edges[place];
                let occluder = self.occluders.get(edge as usize);
                self.units += UNITS_OF_EDGE;
                if mask.hides(&occluder) {
                    continue;
                }
                mask.add(&occluder);
                if mask.is_full() {
                    return Shade::Everything;
                }
                self.edges[kept] = edge;
                kept += 1;
                if kept > MOST_KEPT {
                    return Shade::Crowd;
                }
            }
            self.edges.truncate(kept);
        }
        if self.edges.is_empty() {
            return Shade::Nothing;
        }
        for edge in &mut self.edges {
            *edge = self.spheres[*edge as usize];
        }
        Shade::Edges(&self.edges)
    }

    /// Finds the occluders of a range whose shadows have edges on a patch, unless one of them hides the
    /// light from all of it, which is the answer.
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
        let all = &self.occluders;
        // Across the light.
        let widths = patch.widths_of_cone();
        let across = [DVec3::new(ax, ay, 0.0), DVec3::new(bx, by, 0.0)];
        let mut first = range.start;
        while first < range.end {
            let count = (range.end - first).min(8);
            let (x, y) = (eight(simd, &all.x, first), eight(simd, &all.y, first));
            let height = eight(simd, &all.height, first);
            let radius = eight(simd, &all.radius, first);
            let slack = eight(simd, &all.slack, first);
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
                let index = first + lane;
                let is_near = widths.is_none_or(|widths| {
                    let center = DVec3::new(all.x[index], all.y[index], 0.0);
                    let distance = distance_from_cone(across, widths, center);
                    distance <= all.radius[index] + all.slack[index]
                });
                if is_near {
                    self.edges.push(index as u32);
                }
            }
            first += count;
        }
        false
    }
}

/// The times as far as what a tile sees of a sphere that occluders are sought for: what a pixel sees of it lies inside, and
/// so does the ball around that. So a pixel has the same occluders in any tile.
const MARGIN: f64 = 2.1;

#[cfg(test)]
impl OccluderCache {
    /// A cache of some occluders under a light, and their range.
    pub(crate) fn of(
        casters: &[crate::edges::shadow::Caster],
        light: &Light,
    ) -> (Self, Range<usize>) {
        let tile = Cell {
            middle: glam::DVec3::Z,
            size: [1.0; 2],
            projection: crate::model::camera::Projection::Central,
        };
        let mut cache = Self::new(tile, 1.0);
        for (index, caster) in (0..).zip(casters) {
            let occluder = Occluder::new(caster.center, caster.radius, light);
            cache.occluders.push(&occluder);
            cache.spheres.push(index);
        }
        (cache, 0..casters.len())
    }

    /// The numbers of the spheres of a range.
    pub(crate) fn listed(&self, range: Option<Range<usize>>) -> Vec<usize> {
        let spheres = &self.spheres[range.unwrap_or(0..0)];
        spheres.iter().map(|&sphere| sphere as usize).collect()
    }
}
