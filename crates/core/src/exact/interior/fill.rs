//! Pixels of a row that one sphere fills.

use fearless_simd::f64x8;
use fearless_simd::prelude::*;
use glam::DVec3;

use super::parts::{SAMPLES_OF_PARTS, in_parts};
use super::smooth::{Filled, smooth};
use crate::exact::Exact;
use crate::exact::casters::CasterCache;
use crate::exact::edged::cell::Workspace;
use crate::exact::glimpse::Glimpse;
use crate::exact::points::Points;
use crate::exact::scene::MOST_LIGHTS;
use crate::exact::surface::Finish;
use crate::numeric::rounding::UNIT_ROUNDOFF;
use crate::numeric::vectors::Vectors;
use crate::picture::pixel::{Evidence, Pixel, Status};
use crate::picture::tile::Tile;

/// The fall of a highlight over half a pixel, in powers of e, that a pixel's one rule still follows.
const SHARPEST: f64 = 0.25;

impl Exact<'_> {
    /// The pixels of a row that one sphere fills.
    #[expect(
        clippy::too_many_arguments,
        reason = "all of it is at hand where it is called"
    )]
    #[inline(always)]
    pub(crate) fn fill<S: Simd>(
        &self,
        simd: S,
        start: Tile,
        sphere: usize,
        which: u64,
        glimpses: &[Glimpse],
        cache: &mut CasterCache,
        workspace: &mut Workspace,
        pixels: &mut [Pixel],
    ) {
        let scene = &self.context.scene;
        let world = scene.world;
        let material = world.material(sphere);
        let Some(glimpse) = glimpses.iter().find(|glimpse| glimpse.sphere == sphere) else {
            return;
        };
        let ball = &glimpse.ball;
        let mut hard = 0;
        let mut lit = [0_u64; MOST_LIGHTS];
        let mut manner = Manner {
            turn: f64x8::splat(simd, 0.0),
            pace: f64x8::splat(simd, 0.0),
        };
        if ball.outside > 0.0 && !scene.is_enclosed {
            let finish = Finish::new(scene, sphere, self.context.key(start, 0));
            simd.vectorize(
                #[inline(always)]
                || {
                    manner = self.lights(
                        simd, start, which, glimpse, cache, &finish, &mut hard, &mut lit,
                    );
                },
            );
        }
        let easy = which & !hard;
        let any_lit = lit.iter().fold(0, |any, lit| any | lit) & easy;
        let ambient = world.albedo(sphere) * scene.ambient;
        let constant = ambient;
        let flat = Pixel {
            value: constant,
            alpha: 1.0,
            error: ambient.max_element() * UNIT_ROUNDOFF,
            evidence: Evidence::Bound,
            status: Status::Met,
        };
        for lane in lanes(easy & !any_lit) {
            pixels[lane] = flat;
        }
        if any_lit != 0 {
            let pixel_noise = matches!(
                material.roughness,
                Some(crate::Roughness {
                    grain: crate::Grain::Pixel,
                    ..
                })
            );
            // The noise of each pixel is its own: one after the other.
            let groups = if pixel_noise {
                lanes(any_lit).map(|lane| 1 << lane).collect()
            } else {
                vec![any_lit]
            };
            for group in groups {
                let lane = group.trailing_zeros();
                let finish = Finish::new(scene, sphere, self.context.key(start, lane));
                let mut group_lit = lit;
                for lit in &mut group_lit {
                    *lit &= group;
                }
                let noise = &mut workspace.noise;
                let (middle, size) = self.context.rays(simd, start);
                let filled = Filled {
                    ball,
                    finish: &finish,
                    middle,
                    size: [size; 2],
                    lit: &group_lit,
                    turn: manner.turn,
                    pace: manner.pace,
                    which: group,
                    tolerance: self.context.tolerance,
                };
                let light = simd.vectorize(
                    #[inline(always)]
                    || smooth(simd, scene, &filled, noise),
                );
                let work = &mut workspace.work;
                work.samples += light.samples as u64 * u64::from(group.count_ones());
                for lane in lanes(group) {
                    let (mut value, mut error) = (light.values[lane], light.errors[lane]);
                    let is_met = |error: f64| error <= self.context.tolerance;
                    if !is_met(error) && light.divisible >> lane & 1 == 1 {
                        work.samples += SAMPLES_OF_PARTS;
                        if let Some(found) = in_parts(simd, scene, &filled, lane, noise) {
                            (value, error) = found;
                        }
                    }
                    if is_met(error) {
                        pixels[lane] = Pixel {
                            value: self.context.scene.spread(value),
                            alpha: 1.0,
                            error,
                            evidence: Evidence::Estimate,
                            status: Status::Met,
                        };
                    } else {
                        hard |= 1 << lane;
                    }
                }
            }
        }
        for lane in lanes(hard) {
            let here = Tile {
                col: start.col + lane as u32,
                ..start
            };
            pixels[lane] = self.pixel(simd, here, &[(sphere, *ball)], cache, workspace);
        }
    }

    /// Which lights reach all of the pixels `which`, bit by bit, and in which of them that cannot
    /// be said.
    #[expect(
        clippy::too_many_arguments,
        reason = "all of it is at hand where it is called"
    )]
    #[inline(always)]
    fn lights<S: Simd>(
        &self,
        simd: S,
        start: Tile,
        which: u64,
        glimpse: &Glimpse,
        cache: &mut CasterCache,
        finish: &Finish<'_>,
        hard: &mut u64,
        lit: &mut [u64; MOST_LIGHTS],
    ) -> Manner<S> {
        let scene = &self.context.scene;
        let ball = &glimpse.ball;
        let zero = f64x8::splat(simd, 0.0);
        let one = f64x8::splat(simd, 1.0);
        let (ray, size) = self.context.rays(simd, start);
        let points = Points::new(simd, ball, ray);
        let nearest: f64x8<S> = glimpse.nearest.simd_into(simd);
        let farthest: f64x8<S> = glimpse.farthest.simd_into(simd);
        let half_diagonal = size * std::f64::consts::FRAC_1_SQRT_2 * (1.0 + 1e-9);
        let length = points.ray_sq.sqrt();
        let away = (farthest - points.t).max(points.t - nearest) * length;
        let around = farthest * half_diagonal + farthest * length * 1e-12;
        let turn = (away + around) * (1.0 / ball.radius);
        let grazing = (points.normal.dot(&ray) * (-one / length)).max(zero);
        // A root of what vanishes at the silhouette, with the square of this.
        let mut pace = turn * 2.0 / grazing;
        for (light, in_camera) in scene.lights.iter().enumerate() {
            let toward = in_camera.toward;
            let mut reached = which & !*hard;
            if !finish.is_rough() {
                let facing = points.normal.dot_one(toward);
                if !finish.has_whole_exponent() {
                    pace = facing.simd_gt(zero).select(pace.max(turn / facing), pace);
                }
                let faces = facing.simd_gt(turn).to_bitmask();
                let averts = facing.simd_lt(-turn).to_bitmask();
                *hard |= which & !faces & !averts;
                reached &= faces;
            }
            if scene.world.shadows && reached != 0 {
                let range = cache.casters(scene, glimpse.sphere, light);
                let range = range.unwrap_or_else(|| {
                    reached = 0;
                    0..0
                });
                cache.tests += range.len() as u64 * u64::from(reached.count_ones());
                let right = ends(&ray, nearest, farthest, in_camera.right);
                let up = ends(&ray, nearest, farthest, in_camera.up);
                let along = ends(&ray, nearest, farthest, toward);
                for caster in range {
                    let caster = cache.discs.get(caster);
                    let slack = caster.slack;
                    let (x0, x1) = (right.0 - caster.x, right.1 - caster.x);
                    let (y0, y1) = (up.0 - caster.y, up.1 - caster.y);
                    let (z0, z1) = (along.0 - caster.height, along.1 - caster.height);
                    let (dx, dy) = (x1 - x0, y1 - y0);
                    let way_sq = dx * dx + dy * dy;
                    let share = -(x0 * dx + y0 * dy) / way_sq.max(one * f64::MIN_POSITIVE);
                    let share = share.max(zero).min(one);
                    let (x, y) = (x0 + dx * share, y0 + dy * share);
                    let reach = around + (caster.radius + slack);
                    let is_near = (x * x + y * y).simd_le(reach * reach);
                    let is_ahead = z0.min(z1).simd_lt(around + slack);
                    let near = (is_near & is_ahead).to_bitmask();
                    if near & reached == 0 {
                        continue;
                    }
                    let inner = (one * (caster.radius - slack) - around).max(zero);
                    let far_sq = (x0 * x0 + y0 * y0).max(x1 * x1 + y1 * y1);
                    let is_in = far_sq.simd_lt(inner * inner) & z0.max(z1).simd_lt(-around - slack);
                    let dark = is_in.to_bitmask();
                    reached &= !dark;
                    *hard |= near & !dark & reached;
                    reached &= !*hard;
                }
            }
            if reached != 0 {
                let negligible = 0.01 * self.context.tolerance;
                let turn = turn + size;
                let sharp = finish.too_sharp(simd, &points, in_camera, turn, SHARPEST, negligible);
                *hard |= sharp & reached;
                reached &= !*hard;
            }
            lit[light] = reached;
        }
        Manner { turn, pace }
    }
}

/// How the light of pixels changes; see [`Filled`].
#[derive(Clone, Copy, Debug)]
struct Manner<S: Simd> {
    turn: f64x8<S>,
    pace: f64x8<S>,
}

/// How far in the direction of `axis` the rays are at the ends of the ways that they see.
#[inline(always)]
fn ends<S: Simd>(
    ray: &Vectors<S>,
    nearest: f64x8<S>,
    farthest: f64x8<S>,
    axis: DVec3,
) -> (f64x8<S>, f64x8<S>) {
    let along = ray.dot_one(axis);
    (along * nearest, along * farthest)
}

/// The positions of the bits that are set.
fn lanes(mut bits: u64) -> impl Iterator<Item = usize> {
    std::iter::from_fn(move || {
        let lane = (bits != 0).then(|| bits.trailing_zeros() as usize);
        bits &= bits.wrapping_sub(1);
        lane
    })
}
