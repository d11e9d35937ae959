//! The discriminants of rays, eight at a time.

use fearless_simd::Simd;

use crate::edges::cell::Ball;
use crate::numeric::lanes::f64x8;
use crate::numeric::vectors::Vectors;

/// The discriminant Q = B² − A K = r² A − |d × c|² of rays d, with B = d · c and A = d · d, which is positive
/// where they meet a ball.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Discriminant<S: Simd> {
    pub(crate) value: f64x8<S>,
    /// B.
    pub(crate) along: f64x8<S>,
    /// Half of its derivatives along both axes of the retina at distance 1.
    pub(crate) half_slopes: [f64x8<S>; 2],
}

impl<S: Simd> Discriminant<S> {
    /// The discriminant for rays whose third component is 1, and whose squared lengths are these.
    #[inline(always)]
    pub(crate) fn new(ray: &Vectors<S>, ray_sq: f64x8<S>, ball: &Ball) -> Self {
        let (u, v) = (ray.x, ray.y);
        let (c, r, k) = (ball.center, ball.radius, ball.outside);
        if ball.is_parallel() {
            let (a, b) = (u - c.x, v - c.y);
            let value = if ball.is_apart() {
                (a * a + b * b) * -1.0 + r * r
            } else {
                (u * (a - c.x) + v * (b - c.y)) * -1.0 + (c.z * c.z - ball.power)
            };
            return Self {
                value,
                along: u * 0.0 + c.z,
                half_slopes: [-a, -b],
            };
        }
        let along = u * c.x + v * c.y + c.z;
        if ball.is_apart() {
            let across = [v * c.z - c.y, c.x - u * c.z, u * c.y - v * c.x];
            let across_sq = across[0] * across[0] + across[1] * across[1] + across[2] * across[2];
            Self {
                value: ray_sq * (r * r) - across_sq,
                along,
                half_slopes: [
                    u * (r * r) + across[1] * c.z - across[2] * c.y,
                    v * (r * r) - across[0] * c.z + across[2] * c.x,
                ],
            }
        } else {
            Self {
                value: along * along - ray_sq * k,
                along,
                half_slopes: [along * c.x - u * k, along * c.y - v * k],
            }
        }
    }
}

/// The sum of the sizes of the coefficients of second degree of Q, along the retina at distance 1.
#[inline(always)]
pub(crate) fn bend(ball: &Ball) -> f64 {
    if ball.is_parallel() {
        return 2.0;
    }
    let (c, k) = (ball.center, ball.outside);
    (c.x * c.x - k).abs() + (c.y * c.y - k).abs() + 2.0 * (c.x * c.y).abs()
}
