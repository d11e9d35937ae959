//! The lights that reach all of pixels which one sphere fills.

use fearless_simd::Simd;

use super::domain::{Domain, TowardEye};
use super::filled::FilledRow;
use super::half_turns::{nearness_of_silhouette, view_turn};
use crate::edges::cell::Ball;
use crate::exact::classify::occluder_cache::OccluderCache;
use crate::exact::classify::occluders::Occluder;
use crate::exact::context::{Context, NEGLIGIBLE, Sides};
use crate::exact::points::Points;
use crate::exact::scene::{Light, MOST_LIGHTS};
use crate::exact::surface::Finish;
use crate::numeric::lanes::f64x8;
use crate::numeric::rounding::{GEOMETRY_SLACK, WIDER};
use crate::numeric::vectors::Vectors;

/// The fall of a highlight over half a pixel, in powers of e, that a pixel's one rule still follows. Less
/// sends more pixels to the integrator of edges, more makes the estimates of rules unsure; not tuned.
pub(super) const SHARPEST: f64 = 0.25;

/// The lights that reach eight pixels, and how fast their light changes: see
/// [`Filled`](super::filled::Filled).
#[derive(Clone, Copy, Debug)]
pub(super) struct Reached<S: Simd> {
    /// The pixels all of which a light reaches, bit by bit.
    pub(super) lit: [u64; MOST_LIGHTS],
    /// Pixels that have an edge, or may have one, or a highlight that is too sharp.
    pub(super) hard: u64,
    /// Pixels in which the terminator of a plain surface's only light may be, and nothing else.
    pub(super) turning: u64,
    pub(super) turn: f64x8<S>,
    pub(super) view_turn: f64x8<S>,
    pub(super) nearness: f64x8<S>,
}

/// The domains in which the normals of eight pixels are analytic, and the sides of a pixel.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Analytic<'a, S: Simd> {
    pub(super) domain: Domain<'a, S>,
    pub(super) eye: TowardEye<S>,
    pub(super) sides: Sides,
}

/// The extents of a sphere that fills eight pixels: the same under all lights.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Extents<'a, S: Simd> {
    /// The rays through the middles, and the sides of a pixel.
    ray: Vectors<S>,
    sides: Sides,
    points: Points<S>,
    /// The least and the largest distance, in multiples of the rays, and how far other points lie from the rays.
    depths: [f64x8<S>; 2],
    around: f64x8<S>,
    /// The turn of normals and of directions toward the eye in a pixel, and the distance of its light from a singularity
    /// at the silhouette.
    turn: f64x8<S>,
    view_turn: f64x8<S>,
    nearness: f64x8<S>,
    /// The domains in which normals are analytic, if lights may have them in common.
    pub(super) analytic: Option<Analytic<'a, S>>,
}

impl<'a, S: Simd> Extents<'a, S> {
    #[inline(always)]
    pub(crate) fn new(
        simd: S,
        context: &Context<'_>,
        row: &FilledRow<'a>,
        is_analytic: bool,
    ) -> Self {
        let ball: &'a Ball = &row.coverage.ball;
        let zero = f64x8::splat(simd, 0.0);
        let one = f64x8::splat(simd, 1.0);
        let (ray, sides) = context.rays(simd, row.start);
        let points = Points::new(simd, ball, ray);
        let nearest: f64x8<S> = f64x8::from_array(simd, row.coverage.nearest);
        let farthest: f64x8<S> = f64x8::from_array(simd, row.coverage.farthest);
        let half_diagonal = sides.half_diagonal() * WIDER;
        let length = points.ray_sq.sqrt();
        let away = (farthest - points.t).max(points.t - nearest) * length;
        let mut around = farthest * half_diagonal + farthest * length * GEOMETRY_SLACK;
        if ball.is_parallel() {
            let extent = ball.center.length() + ball.radius;
            let places = ray.x.abs() + ray.y.abs() + farthest.abs();
            around = (places + extent) * GEOMETRY_SLACK + half_diagonal;
        }
        let turn = (away + around) * (1.0 / ball.radius);
        let grazing = (points.normal.dot(&points.ray) * (-one / length)).max(zero);
        let view_turn = view_turn(ball, length, half_diagonal);
        Self {
            ray,
            sides,
            points,
            depths: [nearest, farthest],
            around,
            turn,
            view_turn,
            nearness: nearness_of_silhouette(turn, view_turn, grazing),
            analytic: if is_analytic {
                let domain = Domain::new(simd, ball, &ray, sides.longer());
                Some(Analytic {
                    eye: domain.toward_eye(),
                    domain,
                    sides,
                })
            } else {
                None
            },
        }
    }
}

/// The ends, as a light sees them, of the ways along eight rays on which their pixels see a sphere: across
/// the light, and their heights toward it.
#[derive(Clone, Copy, Debug)]
struct Ends<S: Simd> {
    right: [f64x8<S>; 2],
    up: [f64x8<S>; 2],
    height: [f64x8<S>; 2],
}

impl<S: Simd> Reached<S> {
    /// No light, and nothing that changes.
    #[inline(always)]
    pub(super) fn nothing(simd: S) -> Self {
        Self {
            lit: [0; MOST_LIGHTS],
            hard: 0,
            turning: 0,
            turn: f64x8::splat(simd, 0.0),
            view_turn: f64x8::splat(simd, 0.0),
            nearness: f64x8::splat(simd, 0.0),
        }
    }

    /// Finds out which lights reach all of the pixels of a row, or none of it, and in which of them that
    /// cannot be said.
    #[inline(always)]
    pub(super) fn new(
        simd: S,
        context: &Context<'_>,
        (row, extents): (&FilledRow<'_>, &Extents<'_, S>),
        finish: &Finish,
        cache: &mut OccluderCache,
    ) -> Self {
        let scene = &context.scene;
        let which = row.which;
        let ball = &row.coverage.ball;
        let Extents {
            ref ray,
            sides,
            ref points,
            depths: [nearest, farthest],
            around,
            turn,
            view_turn,
            mut nearness,
            ..
        } = *extents;
        let zero = f64x8::splat(simd, 0.0);
        let (mut hard, mut turning) = (0, 0);
        let mut lit = [0; MOST_LIGHTS];
        let may_turn = extents.analytic.is_some() && context.normals_on(finish).is_some();
        for (index, light) in scene.lights.iter().enumerate() {
            let mut reached = which & !hard;
            // Terminators.
            if !finish.is_rough() {
                let cosine = points.normal.dot_one(light.toward);
                if !finish.has_whole_exponent() {
                    let is_lit = cosine.simd_gt(zero);
                    nearness = is_lit.select(nearness.max(turn / cosine), nearness);
                }
                let faces = cosine.simd_gt(turn).to_bitmask();
                let averts = cosine.simd_lt(-turn).to_bitmask();
                if may_turn {
                    turning = which & !faces & !averts;
                    reached &= !averts;
                } else {
                    hard |= which & !faces & !averts;
                    reached &= faces;
                }
            }
            // Shadows.
            if scene.world.shadows && reached != 0 && cache.is_exhausted() {
                hard |= reached;
                reached = 0;
            }
            if scene.world.shadows && reached != 0 {
                match cache.occluders(scene, row.coverage.sphere, index) {
                    None => reached = 0,
                    Some(range) => {
                        /// Occluders that a row of pixels is held against in a unit of the work on crowds.
                        const A_UNIT: usize = 4;
                        cache.tests += range.len() as u64 * u64::from(reached.count_ones());
                        cache.units += (range.len() / A_UNIT) as u64;
                        let ends = Ends::new(ball, ray, [nearest, farthest], light);
                        for occluder in range {
                            let occluder = cache.occluder(occluder);
                            let [touched, dark] = ends.shade(simd, &occluder, around);
                            if touched & reached != 0 {
                                reached &= !dark;
                                hard |= touched & !dark & reached;
                                reached &= !hard;
                            }
                        }
                    }
                }
            }
            // Highlights.
            // Those of bumps are told by samples of parts, and by how far their normals turn.
            if reached != 0 && !finish.is_bumpy() {
                let negligible = NEGLIGIBLE * context.tolerance;
                let mut turn = turn;
                if !ball.is_parallel() {
                    turn += sides.longer();
                }
                let sharp = finish.too_sharp(simd, points, light, turn, SHARPEST, negligible);
                hard |= sharp & reached;
                reached &= !hard;
            }
            turning &= reached;
            lit[index] = reached & !turning;
        }
        Self {
            lit,
            hard,
            turning,
            turn,
            view_turn,
            nearness,
        }
    }
}

impl<S: Simd> Ends<S> {
    #[inline(always)]
    fn new(
        ball: &Ball,
        ray: &Vectors<S>,
        [nearest, farthest]: [f64x8<S>; 2],
        light: &Light,
    ) -> Self {
        if ball.is_parallel() {
            let near = Vectors { z: nearest, ..*ray };
            let far = Vectors {
                z: farthest,
                ..*ray
            };
            return Self {
                right: [near.dot_one(light.right), far.dot_one(light.right)],
                up: [near.dot_one(light.up), far.dot_one(light.up)],
                height: [near.dot_one(light.toward), far.dot_one(light.toward)],
            };
        }
        let (right, up) = (ray.dot_one(light.right), ray.dot_one(light.up));
        let height = ray.dot_one(light.toward);
        Self {
            right: [right * nearest, right * farthest],
            up: [up * nearest, up * farthest],
            height: [height * nearest, height * farthest],
        }
    }

    /// The pixels, bit by bit, on which a shadow may lie, and those all of which are in it.
    #[inline(always)]
    fn shade(&self, simd: S, occluder: &Occluder, around: f64x8<S>) -> [u64; 2] {
        let zero = f64x8::splat(simd, 0.0);
        let one = f64x8::splat(simd, 1.0);
        let slack = occluder.slack;
        let [x0, x1] = [self.right[0] - occluder.x, self.right[1] - occluder.x];
        let [y0, y1] = [self.up[0] - occluder.y, self.up[1] - occluder.y];
        let z0 = self.height[0] - occluder.height;
        let z1 = self.height[1] - occluder.height;
        let (dx, dy) = (x1 - x0, y1 - y0);
        let way_sq = dx * dx + dy * dy;
        let share = -(x0 * dx + y0 * dy) / way_sq.max(one * f64::MIN_POSITIVE);
        let share = share.max(zero).min(one);
        let (x, y) = (x0 + dx * share, y0 + dy * share);
        let reach = around + (occluder.radius + slack);
        let is_near = (x * x + y * y).simd_le(reach * reach);
        let is_ahead = z0.min(z1).simd_lt(around + slack);
        let inner = (one * (occluder.radius - slack) - around).max(zero);
        let far_sq = (x0 * x0 + y0 * y0).max(x1 * x1 + y1 * y1);
        let is_in = far_sq.simd_lt(inner * inner) & z0.max(z1).simd_lt(-around - slack);
        [(is_near & is_ahead).to_bitmask(), is_in.to_bitmask()]
    }
}
