//! The derivatives of n·l in the middles of pixels.

use fearless_simd::Simd;
use glam::DVec3;

use super::Domain;
use crate::numeric::lanes::f64x8;

impl<S: Simd> Domain<'_, S> {
    /// The derivatives of n·l along both axes of the retina at distance 1, and a bound of what rounding makes wrong in
    /// them, relative to all of the slope.
    ///
    /// t = K / (B + √Q) changes by −t (B' + Q' / 2√Q) / (B + √Q). Rounding moves Q by 16 roundoffs of A r (r + |c|), as in
    /// [`Self::new`], which is a part of what normals are off by, over √Q / r.
    #[inline(always)]
    pub(in crate::exact::interior) fn slopes(&self, toward: DVec3) -> ([f64x8<S>; 2], f64x8<S>) {
        let radius = self.ball.radius;
        let by_root = 1.0 / self.root;
        let rounding = self.rounding * by_root * radius;
        let [by_u, by_v] = [self.half_slopes[0] * by_root, self.half_slopes[1] * by_root];
        if self.ball.is_parallel() {
            let slopes = [
                (by_u * -toward.z + toward.x) * (1.0 / radius),
                (by_v * -toward.z + toward.y) * (1.0 / radius),
            ];
            return (slopes, rounding);
        }
        let center = self.ball.center;
        let along = self.ray.dot_one(toward) / (self.along + self.root);
        let scale = self.t * (1.0 / radius);
        let slopes = [
            (along * (by_u + center.x) * -1.0 + toward.x) * scale,
            (along * (by_v + center.y) * -1.0 + toward.y) * scale,
        ];
        (slopes, rounding)
    }

    /// The second derivatives of n·l along both axes of the retina at distance 1: of x², x y and y².
    ///
    /// With W = B + √Q, that of t along the axes j and k is t (2 W_j W_k / W² − W_jk / W).
    #[inline(always)]
    pub(in crate::exact::interior) fn bends(&self, toward: DVec3) -> [f64x8<S>; 3] {
        let by_radius = 1.0 / self.ball.radius;
        let by_root = 1.0 / self.root;
        let [u, v] = [self.half_slopes[0] * by_root, self.half_slopes[1] * by_root];
        let c = self.ball.center;
        let k = if self.ball.is_parallel() {
            1.0
        } else {
            self.ball.outside
        };
        // Those of √Q, from half of those of Q.
        let (cx, cy) = match self.ball.is_parallel() {
            true => (0.0, 0.0),
            false => (c.x, c.y),
        };
        let roots = [
            (cx * cx - k - u * u) * by_root,
            (cx * cy - u * v) * by_root,
            (cy * cy - k - v * v) * by_root,
        ];
        if self.ball.is_parallel() {
            let scale = -toward.z * by_radius;
            return [roots[0] * scale, roots[1] * scale, roots[2] * scale];
        }
        let by_sum = 1.0 / (self.along + self.root);
        let (x, y) = ((u + c.x) * by_sum, (v + c.y) * by_sum);
        let along = self.ray.dot_one(toward);
        let scale = self.t * by_radius;
        let of_t = [
            x * x * 2.0 - roots[0] * by_sum,
            x * y * 2.0 - roots[1] * by_sum,
            y * y * 2.0 - roots[2] * by_sum,
        ];
        [
            (of_t[0] * along - x * (2.0 * toward.x)) * scale,
            (of_t[1] * along - (x * toward.y + y * toward.x)) * scale,
            (of_t[2] * along - y * (2.0 * toward.y)) * scale,
        ]
    }
}
