//! Which of eight points of a surface a light reaches.

use fearless_simd::prelude::*;
use fearless_simd::{Simd, f64x8};
use glam::DVec3;

use super::trace::{DISTANCE_ERROR, Groups, Sight};
use crate::model::light::DirectionalLight;
use crate::model::ray::Ray;
use crate::numeric::bits::set_bits;
use crate::numeric::rounding::UNIT_ROUNDOFF;
use crate::numeric::vectors::Vectors;
use crate::search::Visibility;
use crate::search::discs::Disc;

/// The shadows on what a tile sees.
pub(super) struct Shadows<'scene> {
    visibility: &'scene Visibility<'scene>,
    viewpoint: DVec3,
    /// Of the balls' unit of length, in those of the world.
    length: f64,
    /// What may darken the patches of surfaces that were asked for.
    patches: Vec<Patch>,
}

/// What may darken a part of a sphere.
struct Patch {
    light: usize,
    sphere: u32,
    /// The part, across the light.
    low: [f64; 2],
    high: [f64; 2],
    discs: Vec<Disc>,
}

/// For so few samples on a sphere it does not pay to find out what may darken it.
const FEW_SAMPLES: f64 = 32.0;

/// Eight points that a light may reach.
struct Lit<S: Simd> {
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
        length: f64,
    ) -> Self {
        Self {
            visibility,
            viewpoint,
            length,
            patches: Vec::new(),
        }
    }

    /// Which of some rays, as bits, see a point that the light with this index reaches; they see
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
            let sphere = group.near.ball.index;
            let allowance = self.visibility.point_allowance(sphere as usize);
            let precise = lit
                .errors
                .simd_le(f64x8::splat(simd, allowance))
                .to_bitmask();
            let side_by_side = self.visibility.is_moderate()
                && (group.near.samples > FEW_SAMPLES
                    || self.visibility.knows_discs(index, sphere as usize));
            let alone = if side_by_side {
                lanes & !precise
            } else {
                lanes
            };
            if alone != 0 {
                reached &= !self.ask_all(&lit, index, light, sphere, alone);
                lanes &= !alone;
            }
            if lanes != 0 {
                reached &= !self.darkened(simd, &lit, index, light, sphere, lanes);
            }
        }
        reached
    }

    /// The points that are seen, as [`Ray::at`] computes them.
    ///
    /// Each is off by the error of its distance, [`DISTANCE_ERROR`] times at most √3 times the
    /// largest component, and by what [`Ray::point_error`] says of the rounding.
    #[inline(always)]
    fn points<S: Simd>(&self, simd: S, light: usize, sight: &Sight<S>) -> Lit<S> {
        const ROUNDING: f64 = 7.0 * UNIT_ROUNDOFF;
        let from_eye = sight.point.times(f64x8::splat(simd, self.length));
        let points = Vectors::splat(simd, self.viewpoint).plus(&from_eye);
        let (x, y, z) = (from_eye.x.abs(), from_eye.y.abs(), from_eye.z.abs());
        let largest = x.max(y).max(z);
        let rounding = (largest + self.viewpoint.abs().max_element()) * ROUNDING;
        let (right, up) = self.visibility.axes(light);
        Lit {
            points,
            errors: largest * (2.0 * DISTANCE_ERROR) + rounding,
            right: points.dot_one(right),
            up: points.dot_one(up),
        }
    }

    /// Which of some points, as bits, other spheres darken.
    #[inline(always)]
    fn darkened<S: Simd>(
        &mut self,
        simd: S,
        lit: &Lit<S>,
        index: usize,
        light: &DirectionalLight,
        sphere: u32,
        asked: u64,
    ) -> u64 {
        let visibility = self.visibility;
        let discs = match visibility.discs(index, sphere as usize) {
            Some(discs) => discs,
            None => self.patch(lit, index, sphere, asked),
        };
        let mut left = asked;
        for disc in discs {
            let (x, y) = (lit.right - disc.center.x, lit.up - disc.center.y);
            let reach = f64x8::splat(simd, disc.radius * disc.radius);
            let beyond = (x * x + y * y).simd_gt(reach).to_bitmask();
            let maybe = left & !beyond;
            if maybe != 0 {
                left &= !blocked(simd, visibility, lit, light, disc.sphere, maybe);
                if left == 0 {
                    break;
                }
            }
        }
        asked & !left
    }

    /// What may darken some points of a sphere: of a somewhat larger part, as others are going to
    /// ask next.
    #[cold]
    #[inline(never)]
    fn patch<S: Simd>(&mut self, lit: &Lit<S>, light: usize, sphere: u32, asked: u64) -> &[Disc] {
        let (mut low, mut high) = ([f64::INFINITY; 2], [f64::NEG_INFINITY; 2]);
        for lane in set_bits(asked) {
            for (axis, place) in [lit.right[lane], lit.up[lane]].into_iter().enumerate() {
                (low[axis], high[axis]) = (low[axis].min(place), high[axis].max(place));
            }
        }
        let known = self
            .patches
            .iter()
            .position(|patch| patch.light == light && patch.sphere == sphere);
        let known = known.unwrap_or_else(|| {
            self.patches.push(Patch {
                light,
                sphere,
                low: [f64::INFINITY; 2],
                high: [f64::NEG_INFINITY; 2],
                discs: Vec::new(),
            });
            self.patches.len() - 1
        });
        let patch = &mut self.patches[known];
        let covers =
            (0..2).all(|axis| patch.low[axis] <= low[axis] && high[axis] <= patch.high[axis]);
        if !covers {
            let mut around = 0.0_f64;
            for axis in 0..2 {
                patch.low[axis] = patch.low[axis].min(low[axis]);
                patch.high[axis] = patch.high[axis].max(high[axis]);
                around = around.max(0.5 * (patch.high[axis] - patch.low[axis]));
            }
            let (right, up) = self.visibility.axes(light);
            let corner = |place: [f64; 2]| right * place[0] + up * place[1];
            let corners = [corner(patch.low), corner(patch.high)];
            patch.discs.clear();
            self.visibility.discs_near(
                light,
                sphere as usize,
                &corners,
                2.0 * around,
                &mut patch.discs,
            );
            for axis in 0..2 {
                patch.low[axis] -= around;
                patch.high[axis] += around;
            }
        }
        &patch.discs
    }

    /// Which of some points, as bits, any other sphere darkens: one point after the other.
    #[inline(never)]
    fn ask_all<S: Simd>(
        &self,
        lit: &Lit<S>,
        index: usize,
        light: &DirectionalLight,
        sphere: u32,
        asked: u64,
    ) -> u64 {
        let is_dark = |&lane: &usize| {
            let to_light = Ray {
                origin: lit.points.lane(lane),
                direction: light.toward(),
            };
            self.visibility
                .is_blocked(index, &to_light, lit.errors[lane], sphere as usize)
        };
        set_bits(asked)
            .filter(is_dark)
            .fold(0, |dark, lane| dark | 1 << lane)
    }
}

/// From which of some points, as bits, a sphere hides a light.
///
/// The decisions of [`Sphere::is_met`](crate::Sphere), with the bounds of its first floor; what
/// they leave open, it is asked.
#[inline(always)]
fn blocked<S: Simd>(
    simd: S,
    visibility: &Visibility<'_>,
    lit: &Lit<S>,
    light: &DirectionalLight,
    sphere: u32,
    asked: u64,
) -> u64 {
    /// As for the first floor of decisions about spheres: the operations are the same.
    const DECISION_BOUND: f64 = 24.0 * UNIT_ROUNDOFF;
    let caster = &visibility.spheres()[sphere as usize];
    let (radius, toward) = (caster.radius(), light.toward());
    let direction_sq = toward.length_squared();
    let to_center = Vectors::splat(simd, caster.center()).minus(&lit.points);
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
        dark |= ask(lit, caster, toward, open);
    }
    dark
}

#[cold]
#[inline(never)]
fn ask<S: Simd>(lit: &Lit<S>, caster: &crate::Sphere, toward: DVec3, asked: u64) -> u64 {
    let is_dark = |&lane: &usize| {
        let to_light = Ray {
            origin: lit.points.lane(lane),
            direction: toward,
        };
        caster.is_met(&to_light, lit.errors[lane])
    };
    set_bits(asked)
        .filter(is_dark)
        .fold(0, |dark, lane| dark | 1 << lane)
}

#[cfg(test)]
mod tests;
