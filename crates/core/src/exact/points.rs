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
    /// The places where parallel rays begin, in the plane across them.
    begin: Option<[f64x8<S>; 2]>,
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
            begin: None,
        }
    }

    /// The points on the rays of a cell; a ray that misses counts as grazing.
    #[inline(always)]
    pub(crate) fn new(simd: S, ball: &Ball, ray: Vectors<S>) -> Self {
        let zero = f64x8::splat(simd, 0.0);
        let one = f64x8::splat(simd, 1.0);
        if ball.is_parallel() {
            let (a, b) = (ray.x - ball.center.x, ray.y - ball.center.y);
            let z = ball.center.z;
            let (root, t) = if ball.is_apart() {
                let discriminant = (a * a + b * b) * -1.0 + ball.radius * ball.radius;
                let root = discriminant.max(zero).sqrt();
                (root, root * -1.0 + z)
            } else {
                // K of where a ray begins.
                let power = ray.x * (a - ball.center.x) + ray.y * (b - ball.center.y) + ball.power;
                let root = (power * -1.0 + z * z).max(zero).sqrt();
                (root, power / (root + z))
            };
            let from_center = Vectors {
                x: a,
                y: b,
                z: -root,
            };
            return Self {
                ray: Vectors::splat(simd, DVec3::Z),
                ray_sq: one,
                t,
                normal: from_center.times(one * (1.0 / ball.radius)),
                begin: Some([ray.x, ray.y]),
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
                begin: None,
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
                begin: None,
            }
        }
    }

    /// The points, in the camera's frame.
    #[inline(always)]
    pub(crate) fn place(&self) -> Vectors<S> {
        match self.begin {
            Some([x, y]) => Vectors { x, y, z: self.t },
            None => self.ray.times(self.t),
        }
    }
}

/// The places where rays meet a ball, from the roots of their discriminants: those of negative ones lie on its far side.
/// Parallel rays are given by where they begin.
#[inline(always)]
pub(crate) fn places_of_roots<S: Simd>(
    ball: &Ball,
    ray: &Vectors<S>,
    root: f64x8<S>,
) -> Vectors<S> {
    let z = ball.center.z;
    if !ball.is_parallel() {
        let along = ray.dot_one(ball.center) + root;
        return ray.times((ray.z * 0.0 + ball.outside) / along);
    }
    let depth = if ball.is_apart() {
        root * -1.0 + z
    } else {
        let (x, y) = (ray.x - 2.0 * ball.center.x, ray.y - 2.0 * ball.center.y);
        (ray.x * x + ray.y * y + ball.power) / (root + z)
    };
    Vectors {
        x: ray.x,
        y: ray.y,
        z: depth,
    }
}
