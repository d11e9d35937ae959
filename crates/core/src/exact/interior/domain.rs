//! The complex neighborhoods of pixels in which normals are analytic, and how far light changes there.
//!
//! Let a ray be d = d₀ + (x, y, 0) with complex |x|, |y| ≤ h around the middle d₀ of a pixel. With B = d · c,
//! A = d · d and Q = B² − A K it meets a sphere at t d, t = K / (B + √Q), where the normal is n = (t d − c) / r.
//! Q is a polynomial: |Q − Q₀| ≤ G h + S h², with the sums G and S of its coefficients' sizes. Where that is
//! κ Q₀, κ < 1, the root has no singularity; as the coefficients of 1 − √(1 − z) are positive,
//!
//! ```text
//! |√Q − √Q₀| ≤ √Q₀ (1 − √(1 − κ)) = q,    |B − B₀| ≤ h (|c_x| + |c_y|) = b ≤ B₀ / 2.
//! ```
//!
//! So with W = B₀ + √Q₀ and w = b + q, |t − t₀| ≤ t₀ w / (W − w) and |t| ≤ t₀ W / (W − w), and
//!
//! ```text
//! |n·l − n₀·l| ≤ t₀ / (r (W − w)) · (W h (|l_x| + |l_y|) + w |d₀·l|).
//! ```
//!
//! All of this shrinks at least as fast as h, as it is convex in h and begins at 0.
//!
//! Rules are exact for polynomials of degree 3, and n·l is nearly one. With A = A₀ (1 + α), |α| ≤ a ≤ ½, and
//! Q = Q₀ (1 + ε), |ε| ≤ κ, it is (B − √Q) (d·l) / (r A) less a constant, where
//!
//! ```text
//! √Q = √Q₀ (1 + ε/2 + ρ),    |ρ| ≤ 1 − √(1 − κ) − κ/2,    1/A = (1 − α + α² / (1 + α)) / A₀.
//! ```
//!
//! B and d·l are linear, with |B| ≤ B₀ + b and |d·l| ≤ m = |d₀·l| + h (|l_x| + |l_y|), and α and ε quadratic. So it
//! differs from a polynomial of degree 3 by 1 / (r A₀) times
//!
//! ```text
//! √Q₀ m (|ρ| / (1 − a) + κ a / 2 + (1 + κ/2) a² / (1 − a)) + (B₀ + b) m a² / (1 − a)
//!     + b h (|l_x| + |l_y|) 2 h² / A₀
//! ```
//!
//! or less: by ρ, by ε α / 2, by α² / (1 + α), and by the product of the linear parts of B and d·l with the
//! quadratic one of α.

//!
//! For parallel rays Q = r² − a² − b² with the linear ways a, b from the center to the ray, n = (a, b, −√Q) / r, and
//! all of this becomes simpler: n·l changes by ((|l_x| + |l_y|) h + |l_z| q) / r or less, and differs from a
//! polynomial of degree 3 by √Q₀ |l_z| |ρ| / r. The directions toward the eye do not change.

mod derivatives;

use fearless_simd::Simd;
use glam::DVec3;

use crate::edges::cell::Ball;
use crate::exact::classify::discriminant::{Discriminant, bend};
use crate::numeric::lanes::{f64x8, mask64x8};
use crate::numeric::rounding::UNIT_ROUNDOFF;
use crate::numeric::vectors::Vectors;

/// κ, and 1 − √(1 − κ) for 0.91: rounding makes less than this difference wrong in Q₀, G and h, see [`SOUND`].
const KAPPA: f64 = 0.9;
const CHANGE_OF_ROOT: f64 = 0.7;

/// |ρ|, and κ / 2, for 0.91.
const BEND_OF_ROOT: f64 = 0.245;
const HALF_KAPPA: f64 = 0.455;

/// The least Q₀ over A r (r + |c|): Q₀ is off by 40 roundoffs of that or less, which is 0.5 % of this.
const SOUND: f64 = 1e-12;

/// The least B₀ over (√A + h) |c|. The center in the camera's frame is off by 10 roundoffs of |c|: so B₀ is known to
/// 1.2e-10, and so is b, beside it. Of spheres that the eye is not near, K is r² or more, and B₀, which is √(A K) or
/// more, is more than that.
const LEAST_ALONG: f64 = 1e-5;

/// The error of rounding in G h + S h² may be this share of Q₀: a fifth of what κ leaves.
const OF_TERMS: f64 = 0.002;

/// 1 / √(1 − z) − 1 ≤ 0.83 z for z ≤ ½, and √2 or less.
const OF_ROOT: f64 = 0.83;
const ROOT_OF_TWO: f64 = 1.42;

/// Neighborhoods of eight pixels in which normals are analytic.
#[derive(Clone, Copy, Debug)]
pub(super) struct Domain<'a, S: Simd> {
    ball: &'a Ball,
    /// The directions of the rays.
    ray: Vectors<S>,
    ray_sq: f64x8<S>,
    /// The pixels that have one.
    pub(super) is_known: mask64x8<S>,
    /// Half of the longer side of the pixel over h.
    pub(super) share: f64x8<S>,
    /// h.
    reach: f64x8<S>,
    /// B₀, and b.
    along: f64x8<S>,
    slack: f64x8<S>,
    /// t₀, and √Q₀.
    t: f64x8<S>,
    root: f64x8<S>,
    /// Half of the derivatives of Q along both axes.
    half_slopes: [f64x8<S>; 2],
    /// The factors on |l_x| + |l_y| and |d₀·l| in the change of n·l.
    factors: [f64x8<S>; 2],
    /// A bound of what rounding makes wrong in normals, anywhere in the pixel.
    pub(super) rounding: f64x8<S>,
    /// Those in the middle, for parallel rays alone.
    normal: Vectors<S>,
}

/// A quantity in the middles of eight pixels, and a bound of its change in their domains.
#[derive(Clone, Copy, Debug)]
pub(super) struct Change<S: Simd> {
    pub(super) value: f64x8<S>,
    pub(super) change: f64x8<S>,
    /// If that holds only in a part of the domain: a half over that part, which changes by this part of the
    /// change.
    pub(super) limit: Option<f64x8<S>>,
    /// A bound of what rounding makes wrong in it.
    pub(super) rounding: f64x8<S>,
}

/// The directions toward the eye.
#[derive(Clone, Copy, Debug)]
pub(super) struct TowardEye<S: Simd> {
    /// 1 / √A₀.
    inverse: f64x8<S>,
    /// The change of A, relatively.
    stretch: f64x8<S>,
    /// n·v, and its change.
    cosine: f64x8<S>,
    change: f64x8<S>,
}

impl<'a, S: Simd> Domain<'a, S> {
    /// The domain of pixels with these rays through their middles, whose longer side is this.
    #[inline(always)]
    pub(super) fn new(simd: S, ball: &'a Ball, ray: &Vectors<S>, size: f64) -> Self {
        /// More than normals are off by, over (1 + |c| / r) and the cosine of the angle of incidence at the middle,
        /// which is less than twice that elsewhere in the pixel. In roundoffs, the center in the camera's frame is
        /// off by 10 |c|, the place on the retina by 4, and Q by 16 A r (r + |c|): together 44.
        const ROUNDINGS: f64 = 256.0 * UNIT_ROUNDOFF;
        if ball.is_parallel() {
            return Self::of_parallel_rays(simd, ball, ray, size, ROUNDINGS);
        }
        let (c, r, k) = (ball.center, ball.radius, ball.outside);
        let far = c.length();
        let ray_sq = ray.length_squared();
        let discriminant = Discriminant::new(ray, ray_sq, ball);
        let Discriminant { value, along, .. } = discriminant;
        let [by_u, by_v] = discriminant.half_slopes;
        let is_sound = value.simd_gt(ray_sq * (r * (r + far) * SOUND));
        let root = value.sqrt();

        // The root of S h² + G h = κ Q₀, or b = B₀ / 2.
        let slope = (by_u.abs() + by_v.abs()) * 2.0;
        let aside = c.x.abs() + c.y.abs();
        let most = value * KAPPA;
        let steep = slope + (slope * slope + most * (4.0 * bend(ball))).sqrt();
        let reach = (most * 2.0 / steep).min(along * (0.5 / aside));
        let mut is_known = is_sound & along.simd_gt(0.0);
        if !ball.is_apart() {
            // B and c are off by 10 roundoffs of |c|, so that G = 2 Σ |B cⱼ − dⱼ K| is off by 80 of |c|² √A, and S by 44
            // of |c|².
            let length = ray_sq.sqrt();
            let terms = reach * (length * 80.0 + reach * 44.0);
            let is_steady = value.simd_gt(terms * (far * far * (UNIT_ROUNDOFF / OF_TERMS)));
            is_known &= is_steady & along.simd_gt((length + reach) * (far * LEAST_ALONG));
        }

        let sum = along + root;
        let slack = reach * aside;
        let loss = slack + root * CHANGE_OF_ROOT;
        // t₀ / (r (W − w)), t₀ and 1 / √Q₀, by one division.
        let rest = (sum - loss) * r;
        let inverse = f64x8::splat(simd, 1.0) / (root * sum * rest);
        let scale = root * inverse * k;
        let t = scale * rest;
        let inverse = sum * rest * inverse;
        Self {
            ball,
            ray: *ray,
            ray_sq,
            is_known,
            share: f64x8::splat(simd, 0.5 * size) / reach,
            reach,
            along,
            slack,
            t,
            root,
            half_slopes: [by_u, by_v],
            factors: [sum * reach * scale, loss * scale],
            // A is its root or more.
            rounding: ray_sq * inverse * ((r + far) * ROUNDINGS),
            normal: *ray,
        }
    }

    /// The same for parallel rays; normals are off by `roundings`, as they have it.
    #[inline(always)]
    fn of_parallel_rays(
        simd: S,
        ball: &'a Ball,
        ray: &Vectors<S>,
        size: f64,
        roundings: f64,
    ) -> Self {
        let (c, r) = (ball.center, ball.radius);
        let zero = f64x8::splat(simd, 0.0);
        let one = f64x8::splat(simd, 1.0);
        let discriminant = Discriminant::new(ray, one, ball);
        let value = discriminant.value;
        let [by_u, by_v] = discriminant.half_slopes;
        // The center and the ray are off by roundings of these.
        let far = ray.x.abs() + ray.y.abs() + (c.length() + r);
        let is_sound = value.simd_gt(far * (r * SOUND));
        let root = value.sqrt();
        let slope = (by_u.abs() + by_v.abs()) * 2.0;
        let most = value * KAPPA;
        let steep = slope + (slope * slope + most * (4.0 * bend(ball))).sqrt();
        let reach = most * 2.0 / steep;
        let by_radius = 1.0 / r;
        Self {
            ball,
            ray: Vectors::splat(simd, DVec3::Z),
            ray_sq: one,
            is_known: is_sound,
            share: f64x8::splat(simd, 0.5 * size) / reach,
            reach,
            along: zero,
            slack: zero,
            t: root * -1.0 + c.z,
            root,
            half_slopes: [by_u, by_v],
            factors: [reach * by_radius, root * (CHANGE_OF_ROOT * by_radius)],
            rounding: far / root * roundings,
            normal: Vectors {
                x: (ray.x - c.x) * by_radius,
                y: (ray.y - c.y) * by_radius,
                z: root * -by_radius,
            },
        }
    }

    /// n·l.
    #[inline(always)]
    pub(super) fn cosine(&self, toward: DVec3) -> Change<S> {
        if self.ball.is_parallel() {
            let aside = toward.x.abs() + toward.y.abs();
            return Change {
                value: self.normal.dot_one(toward),
                change: self.factors[0] * aside + self.factors[1] * toward.z.abs(),
                limit: None,
                rounding: self.rounding,
            };
        }
        let along = self.ray.dot_one(toward);
        let aside = toward.x.abs() + toward.y.abs();
        let center = self.ball.center.dot(toward);
        Change {
            value: (self.t * along - center) * (1.0 / self.ball.radius),
            change: self.factors[0] * aside + self.factors[1] * along.abs(),
            limit: None,
            rounding: self.rounding,
        }
    }

    /// The functions that light depends on, whatever the light.
    ///
    /// Where A changes by half of A₀ at most, 1 / √A changes by 0.83 of that, relatively, and n·v = √Q / (r √A).
    #[inline(always)]
    pub(super) fn toward_eye(&self) -> TowardEye<S> {
        if self.ball.is_parallel() {
            let one = self.reach * 0.0 + 1.0;
            let cosine = self.root * (1.0 / self.ball.radius);
            return TowardEye {
                inverse: one,
                stretch: one * 0.0,
                cosine,
                change: cosine * CHANGE_OF_ROOT,
            };
        }
        let reach = self.reach;
        let inverse_sq = 1.0 / self.ray_sq;
        let inverse = inverse_sq.sqrt();
        let stretch = (self.ray.x.abs() + self.ray.y.abs() + reach) * reach * inverse_sq * 2.0;
        let cosine = self.root * inverse * (1.0 / self.ball.radius);
        TowardEye {
            inverse,
            stretch,
            cosine,
            change: cosine * (stretch * OF_ROOT + CHANGE_OF_ROOT * ROOT_OF_TWO),
        }
    }

    /// A bound of what n·l differs by from a polynomial of degree 3, anywhere in the domain.
    #[inline(always)]
    pub(super) fn bend(&self, toward: DVec3, eye: &TowardEye<S>) -> f64x8<S> {
        if self.ball.is_parallel() {
            return self.root * (toward.z.abs() * BEND_OF_ROOT / self.ball.radius);
        }
        let aside = self.reach * (toward.x.abs() + toward.y.abs());
        self.bend_of(self.ray.dot_one(toward).abs(), aside, eye)
    }

    /// Bounds of the change of n·l, and of what it differs by from a polynomial of degree 3, for all unit vectors l:
    /// |l_x| + |l_y| is √2 at most.
    #[inline(always)]
    pub(super) fn of_any_light(&self, eye: &TowardEye<S>) -> [f64x8<S>; 2] {
        if self.ball.is_parallel() {
            let change = self.factors[0] * ROOT_OF_TWO + self.factors[1];
            return [change, self.root * (BEND_OF_ROOT / self.ball.radius)];
        }
        let length = self.ray_sq.sqrt();
        let change = self.factors[0] * ROOT_OF_TWO + self.factors[1] * length;
        [change, self.bend_of(length, self.reach * ROOT_OF_TWO, eye)]
    }

    /// The bend of n·l, with |d₀·l| and h (|l_x| + |l_y|).
    #[inline(always)]
    fn bend_of(&self, along: f64x8<S>, aside: f64x8<S>, eye: &TowardEye<S>) -> f64x8<S> {
        let reach = self.reach;
        let most = along + aside;
        // 1 / (1 − a) ≤ 1 + 2 a ≤ 2.
        let a = eye.stretch;
        let by_root =
            (a * 2.0 + 1.0) * BEND_OF_ROOT + a * HALF_KAPPA + a * a * (2.0 * (1.0 + HALF_KAPPA));
        let by_along = (self.along + self.slack) * most * a * a * 2.0;
        let inverse_sq = eye.inverse * eye.inverse;
        let mixed = self.slack * aside * reach * reach * inverse_sq * 2.0;
        let bend = (self.root * most * by_root + by_along + mixed) * inverse_sq;
        let bend = bend * (1.0 / self.ball.radius);
        a.simd_le(0.5).select(bend, bend * 0.0 + f64::INFINITY)
    }

    /// n·h, from n·l.
    ///
    /// With v = −d / √A it is (n·l + n·v) / √(2 + 2 l·v). Where 1 + l·v changes by half of itself at most, the
    /// divisor changes by 0.83 of that, relatively, and with it the bounds multiply.
    #[inline(always)]
    pub(super) fn half_cosine(
        &self,
        toward: DVec3,
        cosine: &Change<S>,
        eye: &TowardEye<S>,
    ) -> Change<S> {
        let along = self.ray.dot_one(toward);
        let aside = toward.x.abs() + toward.y.abs();
        // 1 + l·v, and its change, relatively.
        let rest = 1.0 - along * eye.inverse;
        let inverse_rest = 1.0 / rest;
        let mut turn = self.reach * (aside * ROOT_OF_TWO) + along.abs() * eye.stretch * OF_ROOT;
        if self.ball.is_parallel() {
            turn *= 0.0;
        }
        let turn = turn * eye.inverse * inverse_rest;
        let sum = cosine.value + eye.cosine;
        let of_sum = (cosine.change + eye.change) * ROOT_OF_TWO + sum * turn * OF_ROOT;
        let scale = (inverse_rest * 0.5).sqrt();
        let rounding = (cosine.rounding * 2.0 + scale * (64.0 * UNIT_ROUNDOFF)) * scale;
        Change {
            value: sum * scale,
            change: of_sum * scale,
            limit: Some(eye.stretch.max(turn)),
            rounding,
        }
    }
}
