//! What the pixels of a row see at first glance.

use fearless_simd::f64x8;
use fearless_simd::prelude::*;

use super::Exact;
use super::contents::Patch;
use crate::edges::cell::{Ball, Cell};
use crate::edges::silhouette::silhouette;
use crate::picture::tile::Tile;

/// How eight pixels of a row see a sphere.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Glimpse {
    pub(crate) sphere: usize,
    pub(crate) ball: Ball,
    /// Bit by bit, pixels in which the sphere may be seen.
    pub(crate) touched: u64,
    /// Pixels that the sphere fills, but for what is in front of it.
    pub(crate) covered: u64,
    /// Where it begins and, in pixels that it fills, ends; in multiples of the rays.
    pub(crate) nearest: [f64; 8],
    pub(crate) farthest: [f64; 8],
}

impl Exact<'_> {
    /// Looks at the spheres in up to eight pixels of a row.
    ///
    /// In a pixel Q and B differ from their values in the middle by less than their spread; what is
    /// seen of a sphere begins at K / (B⁺ + √Q⁺) and ends at K / (B⁻ + √Q⁻).
    #[inline(always)]
    pub(crate) fn glimpse<S: Simd>(
        &self,
        simd: S,
        start: Tile,
        width: u32,
        candidates: &[usize],
        balls: &[Ball],
        glimpses: &mut Vec<Glimpse>,
    ) {
        let zero = f64x8::splat(simd, 0.0);
        let one = f64x8::splat(simd, 1.0);
        let (ray, size) = self.context.rays(simd, start);
        let (u, v) = (ray.x, ray.y);
        let ray_sq = u * u + v * v + 1.0;
        let all = (1_u64 << width) - 1;
        let mut end = one * f64::INFINITY;
        for (&sphere, ball) in candidates.iter().zip(balls) {
            let (c, r, k) = (ball.center, ball.radius, ball.outside);
            let along = u * c.x + v * c.y + c.z;
            let along_spread = 0.5 * size * (c.x.abs() + c.y.abs());
            let (q, by_u, by_v);
            if ball.is_apart() {
                let across = [v * c.z - c.y, c.x - u * c.z, u * c.y - v * c.x];
                q = ray_sq * (r * r)
                    - (across[0] * across[0] + across[1] * across[1] + across[2] * across[2]);
                by_u = u * (r * r) + across[1] * c.z - across[2] * c.y;
                by_v = v * (r * r) - across[0] * c.z + across[2] * c.x;
            } else {
                q = along * along - ray_sq * k;
                by_u = along * c.x - u * k;
                by_v = along * c.y - v * k;
            }
            let square = size * size;
            let second = 0.25
                * square
                * ((c.x * c.x - k).abs() + (c.y * c.y - k).abs() + 2.0 * (c.x * c.y).abs());
            // Half of the derivatives, which are twice these.
            let spread = (by_u.abs() + by_v.abs()) * size + second;
            let slack = (spread + q.abs()) * 1e-12;
            let highest = q + spread + slack;
            let lowest = q - spread - slack;
            let (touched, covered, nearest, farthest);
            if k > 0.0 {
                let in_front = along + along_spread;
                touched = highest.simd_ge(0.0) & in_front.simd_gt(0.0);
                covered = lowest.simd_gt(0.0) & along.simd_gt(along_spread);
                nearest = one * (k * (1.0 - 1e-12)) / (in_front + highest.max(zero).sqrt());
                farthest =
                    one * (k * (1.0 + 1e-12)) / (along - along_spread + lowest.max(zero).sqrt());
            } else {
                // From the inside: t = (B + √Q) / A.
                let half = (u.abs() + v.abs()) * size + 0.5 * square;
                touched = zero.simd_eq(zero);
                covered = touched;
                nearest = (along - along_spread + lowest.max(zero).sqrt()).max(zero)
                    / (ray_sq + half)
                    * (1.0 - 1e-12);
                farthest = (along + along_spread + highest.max(zero).sqrt())
                    / (ray_sq - half).max(one)
                    * (1.0 + 1e-12);
            }
            let touched = touched.to_bitmask() & all;
            if touched == 0 {
                continue;
            }
            end = covered.select(end.min(farthest), end);
            glimpses.push(Glimpse {
                sphere,
                ball: *ball,
                touched,
                covered: covered.to_bitmask() & all,
                nearest: nearest.into(),
                farthest: farthest.into(),
            });
        }
        let end: [f64; 8] = end.into();
        for glimpse in &mut *glimpses {
            for (lane, &end) in end.iter().enumerate() {
                if glimpse.nearest[lane] > end {
                    glimpse.touched &= !(1 << lane);
                    glimpse.covered &= !(1 << lane);
                }
            }
        }
        glimpses.retain(|glimpse| glimpse.touched != 0);
    }

    /// The spheres of a pixel that are not hidden by one that fills it.
    ///
    /// A point p of sphere i lies outside of sphere j where p · w > m, with w = cᵢ − cⱼ and
    /// m = (Kᵢ − Kⱼ) / 2: there a ray meets j wholly before or wholly behind p. Which of the two
    /// does not change where that holds all over the pixel; and the middle of j's chord, at B / A,
    /// tells.
    pub(crate) fn visible(
        &self,
        cell: &Cell,
        lane: usize,
        glimpses: &[Glimpse],
        spheres: &mut Vec<(usize, Ball)>,
    ) {
        let here = |glimpse: &&Glimpse| glimpse.touched >> lane & 1 == 1;
        spheres.extend(
            glimpses
                .iter()
                .filter(here)
                .map(|glimpse| (glimpse.sphere, glimpse.ball)),
        );
        let contains = |spheres: &[(usize, Ball)], glimpse: &Glimpse| {
            spheres.iter().any(|&(sphere, _)| sphere == glimpse.sphere)
        };
        for one in glimpses.iter().filter(here) {
            let ball = &one.ball;
            if one.covered >> lane & 1 == 0 || ball.outside <= 0.0 || !contains(spheres, one) {
                continue;
            }
            let patch = Patch::new(cell, ball, &silhouette(cell, ball), &cell.dot(ball.center));
            for other in glimpses.iter().filter(here) {
                if other.sphere == one.sphere || !contains(spheres, other) {
                    continue;
                }
                let other_ball = &other.ball;
                match side(&patch, ball, other_ball) {
                    Some(Side::Outside) => {
                        let along = cell.dot(other_ball.center);
                        let ray_sq = cell.ray_sq();
                        let middle = (along.one - 0.5 * (along.x.abs() + along.y.abs()))
                            / (ray_sq.one + ray_sq.spread());
                        if other_ball.outside > 0.0 && middle > one.farthest[lane] {
                            spheres.retain(|&(sphere, _)| sphere != other.sphere);
                        }
                    }
                    Some(Side::Inside)
                        if other.covered >> lane & 1 == 1 && other_ball.outside > 0.0 =>
                    {
                        spheres.retain(|&(sphere, _)| sphere != one.sphere);
                        break;
                    }
                    Some(Side::Inside) | None => {}
                }
            }
        }
    }
}

/// On which side of another sphere's surface all of a patch lies.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
enum Side {
    Inside,
    Outside,
}

fn side(patch: &Patch, ball: &Ball, other: &Ball) -> Option<Side> {
    let w = ball.center - other.center;
    let m = 0.5 * (ball.outside - other.outside);
    let places = patch.ends.map(|point| point.dot(w) - m);
    let slack = 1e-12 * (ball.outside.abs() + other.outside.abs());
    let around = patch.around * w.length() + slack;
    if places[0].min(places[1]) > around {
        Some(Side::Outside)
    } else if places[0].max(places[1]) < -around {
        Some(Side::Inside)
    } else {
        None
    }
}
