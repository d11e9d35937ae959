//! Points of spheres, eight at a time.

use fearless_simd::Simd;
use glam::DVec3;

use crate::edges::cell::Ball;
use crate::numeric::lanes::f64x8;
use crate::numeric::vectors::Vectors;

/// Points of a sphere that the eye sees from outside.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Points<S: Simd> {
    /// The directions of the rays.
    pub(crate) ray: Vectors<S>,
    pub(crate) ray_sq: f64x8<S>,
    /// In multiples of the ray.
    pub(crate) t: f64x8<S>,
    /// Unit outward normals.
    pub(crate) normal: Vectors<S>,
    /// The center and the radius of the sphere, where rays are parallel: places follow from normals there.
    parallel: Option<(DVec3, f64)>,
}

impl<S: Simd> Points<S> {
    /// A value to fill arrays with.
    #[inline(always)]
    pub(crate) fn nowhere(simd: S) -> Self {
        let zero = f64x8::splat(simd, 0.0);
        let nothing = Vectors {
            x: zero,
            y: zero,
            z: zero,
        };
        Self {
            ray: nothing,
            ray_sq: zero,
            t: zero,
            normal: nothing,
            parallel: None,
        }
    }

    /// The points on the rays of a cell; a ray that misses counts as grazing.
    #[inline(always)]
    pub(crate) fn new(simd: S, ball: &Ball, ray: Vectors<S>) -> Self {
        let zero = f64x8::splat(simd, 0.0);
        let one = f64x8::splat(simd, 1.0);
        if ball.is_parallel() {
            let (a, b) = (ray.x - ball.center.x, ray.y - ball.center.y);
            let discriminant = (a * a + b * b) * -1.0 + ball.radius * ball.radius;
            let root = discriminant.max(zero).sqrt();
            let from_center = Vectors {
                x: a,
                y: b,
                z: -root,
            };
            return Self {
                ray: Vectors::splat(simd, DVec3::Z),
                ray_sq: one,
                t: root * -1.0 + ball.center.z,
                normal: from_center.times(one * (1.0 / ball.radius)),
                parallel: Some((ball.center, ball.radius)),
            };
        }
        let ray_sq = ray.length_squared();
        let along = ray.dot_one(ball.center);
        if ball.is_apart() {
            let across = ray.cross(&Vectors::splat(simd, ball.center));
            let discriminant = ray_sq * (ball.radius * ball.radius) - across.length_squared();
            let root = discriminant.max(zero).sqrt();
            let t = one * ball.outside / (along + root);
            // From the center to the foot of the perpendicular, times d·d, and back to the eye.
            let foot = ray.cross(&across);
            let normal = foot
                .minus(&ray.times(root))
                .times(one / (ray_sq * ball.radius));
            Self {
                ray,
                ray_sq,
                t,
                normal,
                parallel: None,
            }
        } else {
            let discriminant = along * along - ray_sq * ball.outside;
            let root = discriminant.max(zero).sqrt();
            let t = one * ball.outside / (along + root);
            let from_center = ray.times(t).minus(&Vectors::splat(simd, ball.center));
            Self {
                ray,
                ray_sq,
                t,
                normal: from_center.times(one * (1.0 / ball.radius)),
                parallel: None,
            }
        }
    }

    /// The points, in the camera's frame.
    #[inline(always)]
    pub(crate) fn place(&self) -> Vectors<S> {
        match self.parallel {
            Some((center, radius)) => {
                let from_center = self.normal.times(self.t * 0.0 + radius);
                Vectors::splat(self.t.simd(), center).plus(&from_center)
            }
            None => self.ray.times(self.t),
        }
    }
}
