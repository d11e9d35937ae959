//! Shadows on eight points of a surface.

use fearless_simd::Simd;
use glam::{DVec2, DVec3};

use super::ball_discs::BallDiscs;
use super::groups::Groups;
use super::tile_balls::TileBall;
use super::trace::{DISTANCE_ERROR, Sight};
use crate::model::camera::Projection;
use crate::model::light::DirectionalLight;
use crate::model::ray::Ray;
use crate::model::sphere::Sphere;
use crate::numeric::bits::set_bits;
use crate::numeric::lanes::f64x8;
use crate::numeric::rounding::UNIT_ROUNDOFF;
use crate::numeric::vectors::Vectors;
use crate::search::discs::{Disc, point_allowance};
use crate::search::shadow_cells::{ShadowCells, SurfacePoint};
use crate::search::visibility::Visibility;

/// The shadows on what a tile sees.
pub(super) struct Shadows<'scene> {
    visibility: &'scene Visibility<'scene>,
    viewpoint: DVec3,
    scale: Scale,
    /// The regions of surfaces that were asked for.
    regions: Vec<Region>,
    /// Those before the balls of the tile, in worlds too large to keep discs.
    of_balls: BallDiscs,
    cells: &'scene mut ShadowCells,
}

/// The size of what a tile sees.
#[derive(Clone, Copy, Debug)]
pub(super) struct Scale {
    /// The balls' unit of length, in those of the world.
    pub(super) length: f64,
    /// About the side of a tile at the distance of 1, or through a parallel lens at any.
    pub(super) tile_side: f64,
    pub(super) projection: Projection,
    /// Whether balls have many samples in a tile.
    pub(super) are_samples_dense: bool,
}

/// A part of a sphere, and the discs that may darken it.
struct Region {
    light: usize,
    sphere: usize,
    /// Its box, across the light.
    low: DVec2,
    high: DVec2,
    discs: Vec<Disc>,
}

/// Eight points that a light may reach.
struct LitPoints<S: Simd> {
    points: Vectors<S>,
    /// Bounds of how far the points are off.
    errors: f64x8<S>,
    /// Across the light.
    right: f64x8<S>,
    up: f64x8<S>,
}

impl<'scene> Shadows<'scene> {
    pub(super) fn new(
        visibility: &'scene Visibility<'scene>,
        viewpoint: DVec3,
        scale: Scale,
        cells: &'scene mut ShadowCells,
    ) -> Self {
        Self {
            visibility,
            viewpoint,
            scale,
            regions: Vec::new(),
            of_balls: BallDiscs::new(visibility.lights().len()),
            cells,
        }
    }

    /// Those of some rays, as bits, that see a point which the light with this index reaches; they see
    /// outer sides that face the light.
    ///
    /// Exact for the points as they were rounded, up to the error that they may have: where it
    /// leaves open on which side of another surface a point lies, it counts as lying on it.
    #[inline(always)]
    pub(super) fn lit<S: Simd>(
        &mut self,
        simd: S,
        index: usize,
        light: &DirectionalLight,
        sight: &Sight<S>,
        groups: &Groups<'_>,
        asked: u64,
    ) -> u64 {
        let lit = self.points(simd, index, sight);
        let mut reached = asked;
        for group in groups.as_slice() {
            let mut lanes = group.lanes & asked;
            if lanes == 0 {
                continue;
            }
            let sphere = group.ball.index();
            let discs = self.visibility.light(index);
            let has_many = group.ball.has_many_samples;
            let side_by_side = self.visibility.is_moderate()
                && if discs.keeps() {
                    has_many || discs.knows(sphere)
                } else {
                    has_many
                        && self.scale.are_samples_dense
                        && self.of_balls.find(self.visibility, index, group.ball)
                };
            let mut alone = lanes;
            if side_by_side {
                // Spheres lie far apart in memory: only here they are read.
                let allowance = point_allowance(&self.visibility.spheres()[sphere]);
                let allowance = f64x8::splat(simd, allowance);
                alone &= !lit.errors.simd_le(allowance).to_bitmask();
            }
            if alone != 0 {
                reached &= !self.ask_all(&lit, index, group.ball, alone);
                lanes &= !alone;
            }
            if lanes != 0 {
                reached &= !self.darkened(simd, &lit, index, light, group.ball, lanes);
            }
        }
        reached
    }

    /// Those of some rays, as bits, that see a point which the point light with this index reaches; they see outer
    /// sides that face the light.
    ///
    /// Exact as [`Self::lit`] is.
    #[inline(never)]
    pub(super) fn lit_by_point<S: Simd>(
        &self,
        simd: S,
        index: usize,
        sight: &Sight<S>,
        groups: &Groups<'_>,
        asked: u64,
    ) -> u64 {
        let Some(occluders) = self.visibility.point_light(index) else {
            return asked;
        };
        let (points, errors) = simd.vectorize(
            #[inline(always)]
            || self.places(simd, sight),
        );
        let mut reached = asked;
        for group in groups.as_slice() {
            for lane in set_bits(group.lanes & asked) {
                let sphere = group.ball.index();
                if occluders.is_blocked(points.lane(lane), errors[lane], sphere) {
                    reached &= !(1 << lane);
                }
            }
        }
        reached
    }

    /// The points that are seen, as [`Ray::at`] computes them.
    ///
    /// Each is off by the error of its distance, [`DISTANCE_ERROR`] times at most √3 times the
    /// largest component, and by what [`Ray::point_error`] says of the rounding.
    #[inline(always)]
    fn places<S: Simd>(&self, simd: S, sight: &Sight<S>) -> (Vectors<S>, f64x8<S>) {
        /// As in [`Ray::point_error`].
        const ROUNDING: f64 = 7.0 * UNIT_ROUNDOFF;
        let from_eye = sight.point.times(f64x8::splat(simd, self.scale.length));
        let points = Vectors::splat(simd, self.viewpoint).plus(&from_eye);
        let (x, y, z) = (from_eye.x.abs(), from_eye.y.abs(), from_eye.z.abs());
        let largest = x.max(y).max(z);
        let rounding = (largest + self.viewpoint.abs().max_element()) * ROUNDING;
        (points, largest * (2.0 * DISTANCE_ERROR) + rounding)
    }

    /// The points that are seen, across a light as well.
    #[inline(always)]
    fn points<S: Simd>(&self, simd: S, light: usize, sight: &Sight<S>) -> LitPoints<S> {
        let (points, errors) = self.places(simd, sight);
        let (right, up) = self.visibility.light(light).axes();
        LitPoints {
            points,
            errors,
            right: points.dot_one(right),
            up: points.dot_one(up),
        }
    }

    /// Those of some points, as bits, that other spheres darken.
    #[inline(always)]
    fn darkened<S: Simd>(
        &mut self,
        simd: S,
        lit: &LitPoints<S>,
        index: usize,
        light: &DirectionalLight,
        ball: &TileBall,
        asked: u64,
    ) -> u64 {
        let visibility = self.visibility;
        let sphere = ball.index();
        let discs = if let Some(discs) = self.of_balls.of(index, ball) {
            discs
        } else if let Some(discs) = visibility.light(index).of_sphere(sphere) {
            discs
        } else {
            self.discs_of_region(lit, index, sphere, asked)
        };
        darkened(simd, visibility, (lit, light), discs, asked)
    }

    /// About the side of a tile at a distance.
    fn side(&self, distance: f64) -> f64 {
        self.scale.tile_side
            * match self.scale.projection {
                Projection::Central => distance,
                Projection::Parallel => 1.0,
            }
    }

    /// The discs that may darken some points of a sphere: of a somewhat larger region, as others are
    /// going to ask next.
    #[cold]
    #[inline(never)]
    fn discs_of_region<S: Simd>(
        &mut self,
        lit: &LitPoints<S>,
        light: usize,
        sphere: usize,
        asked: u64,
    ) -> &[Disc] {
        let (mut low, mut high) = (DVec2::INFINITY, DVec2::NEG_INFINITY);
        for lane in set_bits(asked) {
            let place = DVec2::new(lit.right[lane], lit.up[lane]);
            (low, high) = (low.min(place), high.max(place));
        }
        let is_known = |region: &Region| region.light == light && region.sphere == sphere;
        let known = self.regions.iter().position(is_known).unwrap_or_else(|| {
            self.regions.push(Region {
                light,
                sphere,
                low: DVec2::INFINITY,
                high: DVec2::NEG_INFINITY,
                discs: Vec::new(),
            });
            self.regions.len() - 1
        });
        let region = &mut self.regions[known];
        let covers = region.low.cmple(low).all() && high.cmple(region.high).all();
        if !covers {
            (low, high) = (region.low.min(low), region.high.max(high));
            let around = (0.5 * (high - low)).max_element().max(0.0);
            let light = self.visibility.light(light);
            let (right, up) = light.axes();
            let corner = |place: DVec2| right * place.x + up * place.y;
            let corners = [corner(low), corner(high)];
            region.discs.clear();
            light.find(sphere, &corners, 2.0 * around, &mut region.discs);
            (region.low, region.high) = (low - around, high + around);
        }
        &region.discs
    }

    /// Those of some points, as bits, that any other sphere darkens: one point after the other.
    #[inline(never)]
    fn ask_all<S: Simd>(
        &mut self,
        lit: &LitPoints<S>,
        light: usize,
        ball: &TileBall,
        asked: u64,
    ) -> u64 {
        let center = self.viewpoint + ball.ball.to_center * self.scale.length;
        let mut dark = 0;
        for lane in set_bits(asked) {
            let point = lit.points.lane(lane);
            let distance = (point - self.viewpoint).abs().max_element();
            let point = SurfacePoint {
                point,
                error: lit.errors[lane],
                sphere: ball.index(),
                center,
                side: self.side(distance),
            };
            let is_dark = self.cells.is_blocked(self.visibility, light, &point);
            dark |= u64::from(is_dark) << lane;
        }
        dark
    }
}

/// Those of some points, as bits, that a light does not reach because of spheres with some discs.
#[inline(always)]
fn darkened<S: Simd>(
    simd: S,
    visibility: &Visibility<'_>,
    (lit, light): (&LitPoints<S>, &DirectionalLight),
    discs: &[Disc],
    asked: u64,
) -> u64 {
    let mut left = asked;
    for disc in discs {
        let (x, y) = (lit.right - disc.center.x, lit.up - disc.center.y);
        let reach = f64x8::splat(simd, disc.radius * disc.radius);
        let beyond = (x * x + y * y).simd_gt(reach).to_bitmask();
        let maybe = left & !beyond;
        if maybe != 0 {
            left &= !blocked(simd, visibility, lit, light, disc.sphere as usize, maybe);
            if left == 0 {
                break;
            }
        }
    }
    asked & !left
}

/// From which of some points, as bits, a sphere hides a light.
///
/// The decisions of [`Sphere::is_met`](crate::Sphere), with the bounds of its first floor; what
/// they leave open, it is asked.
#[inline(always)]
fn blocked<S: Simd>(
    simd: S,
    visibility: &Visibility<'_>,
    lit: &LitPoints<S>,
    light: &DirectionalLight,
    sphere: usize,
    asked: u64,
) -> u64 {
    /// As for the first floor of decisions about spheres: the operations are the same.
    const DECISION_BOUND: f64 = 24.0 * UNIT_ROUNDOFF;
    let occluder = &visibility.spheres()[sphere];
    let (radius, toward) = (occluder.radius(), light.toward());
    let direction_sq = toward.length_squared();
    let to_center = Vectors::splat(simd, occluder.center()).minus(&lit.points);
    let along = to_center.dot_one(toward);
    let distance_sq = to_center.length_squared();
    let radius_sq = radius * radius;
    let (outside, scale) = (distance_sq - radius_sq, distance_sq + radius_sq);
    let slack = lit.errors * (lit.errors + 2.0 * radius);
    let bound = scale * DECISION_BOUND + slack;
    let discriminant = along * along - outside * direction_sq;
    let discriminant_bound = bound * direction_sq;

    let clear = outside.simd_gt(bound);
    let missed = clear & discriminant.simd_lt(-discriminant_bound);
    let sided = clear | outside.simd_lt(-bound);
    let decided = sided & discriminant.simd_gt(discriminant_bound * 2.0);
    let behind = clear & along.simd_le(f64x8::splat(simd, 0.0));
    let mut dark = asked & (decided & !behind).to_bitmask();
    let open = asked & !(missed | decided).to_bitmask();
    if open != 0 {
        dark |= ask(lit, occluder, toward, open);
    }
    dark
}

#[cold]
#[inline(never)]
fn ask<S: Simd>(lit: &LitPoints<S>, occluder: &Sphere, toward: DVec3, asked: u64) -> u64 {
    let is_dark = |&lane: &usize| {
        let to_light = Ray {
            origin: lit.points.lane(lane),
            direction: toward,
        };
        occluder.is_met(&to_light, lit.errors[lane])
    };
    set_bits(asked)
        .filter(is_dark)
        .fold(0, |dark, lane| dark | 1 << lane)
}

#[cfg(test)]
mod tests;
