//! The balls that matter in a tile.

use std::f64::consts::PI;

use fearless_simd::Simd;

use super::bundle::{Bundle, Cone, Lines};
use crate::hit::ball::Ball;
use crate::model::camera::Projection;
use crate::numeric::bits::set_bits;
use crate::numeric::lanes::{LANES, f64x8};
use crate::numeric::vectors::Vectors;
use crate::search::frustum::CLEAR;

/// A ball as the rays of a tile see it.
#[derive(Clone, Copy, Debug)]
pub(super) struct TileBall {
    pub(super) ball: Ball,
    /// No ray of the tile meets the ball at a B ± √Q below this.
    pub(super) begin: f64,
    pub(super) radius_sq: f64,
    pub(super) inverse_radius: f64,
    /// Distance and normal are computed side by side where Q is at least this times A.
    pub(super) rim: f64,
    /// −1 where rays meet the outer side, at the near root; 1 where they start inside.
    pub(super) root_sign: f64,
    /// True if the ball covers more than some [`FEW_SAMPLES`], if nothing is in front of it.
    pub(super) has_many_samples: bool,
    /// The rows and columns of the tile that the ball may be seen in, as bits.
    pub(super) rows: u8,
    pub(super) columns: u8,
    /// Its place in the list.
    pub(super) place: u32,
}

/// The cosine of the incidence, squared, below which distance and normal are computed alone: 1/64, from
/// which [`DISTANCE_ERROR`](super::trace::DISTANCE_ERROR) is derived. Not tuned: with less the bound
/// grows, with more it is more rays.
const RIM: f64 = 1.0 / 4096.0;

/// For so few samples on a sphere it does not pay to find out what may darken it. Not tuned: finding
/// out takes about as long as asking for a few dozen points.
const FEW_SAMPLES: f64 = 32.0;

impl TileBall {
    /// The index of the sphere in the world.
    #[inline(always)]
    pub(super) fn index(&self) -> usize {
        self.ball.index as usize
    }

    /// `cells` is how many samples lie side by side on a length of 1 at the distance of 1, or through a parallel lens
    /// on a unit of the balls' lengths at any.
    #[inline(always)]
    fn new(
        ball: &Ball,
        bundle: &Bundle,
        cells: f64,
        ([rows, columns], place): ([u8; 2], usize),
    ) -> Self {
        let radius_sq = ball.radius * ball.radius;
        let length = if ball.nearest > 0.0 {
            bundle.shortest
        } else {
            bundle.longest
        };
        let distance_sq = match bundle.projection {
            Projection::Central => ball.outside.abs(),
            Projection::Parallel => 1.0,
        };
        Self {
            ball: *ball,
            begin: length * ball.nearest,
            radius_sq,
            inverse_radius: 1.0 / ball.radius,
            rim: if ball.is_odd() {
                f64::INFINITY
            } else {
                RIM * radius_sq
            },
            root_sign: if ball.outside < 0.0 { 1.0 } else { -1.0 },
            has_many_samples: PI * (cells * cells) * radius_sq > FEW_SAMPLES * distance_sq,
            rows,
            columns,
            place: place as u32,
        }
    }
}

/// The balls that may be seen in a tile, those that come nearest first.
#[derive(Debug, Default)]
pub(super) struct TileBalls {
    pub(super) list: Vec<TileBall>,
    /// The largest error of a B ± √Q.
    pub(super) blur: f64,
}

/// More than rounding moves anything below, relative to distance and radius: some ten thousand units
/// in the last place, where a dozen operations cost some ten.
const MARGIN: f64 = 1e-12;

impl TileBalls {
    /// Leaves out what a cone around the rays misses, and what is behind a ball that fills it; finds out the columns of
    /// balls, too, if somebody wants them.
    #[inline(always)]
    pub(super) fn gather<'a, S: Simd>(
        &mut self,
        simd: S,
        (cells, with_columns): (f64, bool),
        bundle: &Bundle,
        mut balls: impl Iterator<Item = &'a Ball>,
    ) {
        self.list.clear();
        // No ray of the tile sees anything that is farther away.
        let mut farthest = f64::INFINITY;
        let mut blur = 0.0_f64;
        while let Some(first) = balls.next() {
            if first.nearest > farthest {
                break;
            }
            let mut group = [first; LANES];
            let mut count = 1;
            while count < LANES {
                let Some(ball) = balls.next() else { break };
                group[count] = ball;
                count += 1;
            }
            let mut kept: u64 = (1 << count) - 1;
            let mut lines = [[u8::MAX; LANES]; 2];
            if let Some(cone) = &bundle.cone {
                let group = BallGroup::new(simd, &group);
                let (missed, far) = group.classify(simd, cone);
                kept &= !missed;
                farthest = farthest.min(far);
                // Of few balls each fills more rows than it is worth to find out.
                if count == LANES {
                    let wanted = if with_columns { 2 } else { 1 };
                    let of_tile = [&bundle.rows, &bundle.columns];
                    for (found, lines) in lines.iter_mut().zip(&of_tile[..wanted]) {
                        *found = group.lines(simd, lines);
                    }
                }
            }
            for lane in set_bits(kept) {
                let (ball, rows, columns) = (group[lane], lines[0][lane], lines[1][lane]);
                if ball.nearest <= farthest && rows != 0 && columns != 0 {
                    let of_list = ([rows, columns], self.list.len());
                    self.list.push(TileBall::new(ball, bundle, cells, of_list));
                    blur = blur.max(ball.blur);
                }
            }
        }
        let is_hidden = |last: &TileBall| last.ball.nearest > farthest;
        while self.list.last().is_some_and(is_hidden) {
            self.list.pop();
        }
        self.blur = blur * bundle.longest;
    }
}

/// Eight balls side by side.
struct BallGroup<S: Simd> {
    center: Vectors<S>,
    radius: f64x8<S>,
    outside: f64x8<S>,
}

impl<S: Simd> BallGroup<S> {
    #[inline(always)]
    fn new(simd: S, group: &[&Ball; LANES]) -> Self {
        let mut parts = [[0.0; LANES]; 5];
        for (lane, ball) in group.iter().enumerate() {
            parts[0][lane] = ball.to_center.x;
            parts[1][lane] = ball.to_center.y;
            parts[2][lane] = ball.to_center.z;
            parts[3][lane] = ball.radius;
            parts[4][lane] = ball.outside;
        }
        Self {
            center: Vectors {
                x: f64x8::from_array(simd, parts[0]),
                y: f64x8::from_array(simd, parts[1]),
                z: f64x8::from_array(simd, parts[2]),
            },
            radius: f64x8::from_array(simd, parts[3]),
            outside: f64x8::from_array(simd, parts[4]),
        }
    }

    /// The balls that lie outside a cone, as bits, and the distance of the farthest point that any ray
    /// of the cone can see, if one of them fills it.
    ///
    /// With x and y the center's coordinates along and across the axis and w the cone's angle, the
    /// center lies y cos w − x sin w outside of a plane that touches the cone. The ray farthest from
    /// the center makes an angle with it whose sine and cosine are y' = y cos w + x sin w and
    /// x' = x cos w − y sin w over the distance; where it meets the ball (y' < r), all do, and it
    /// does so last, at x' − √(r² − y'²).
    #[inline(always)]
    fn classify(&self, simd: S, cone: &Cone) -> (u64, f64) {
        let (center, radius) = (self.center, self.radius);
        let axis = Vectors::splat(simd, cone.axis);
        let cross = center.cross(&axis);
        let (x, y) = (center.dot(&axis), cross.length_squared().sqrt());
        let margin = (x.abs() + y + radius) * MARGIN;
        let missed = (y * cone.cosine - x * cone.sine).simd_gt(radius + margin);

        let across = y * cone.cosine + x * cone.sine + margin;
        let along = x * cone.cosine - y * cone.sine;
        let zero = f64x8::splat(simd, 0.0);
        let fills = across.simd_lt(radius) & along.simd_gt(zero) & self.outside.simd_gt(zero);
        let mut farthest = f64::INFINITY;
        if fills.any_true() {
            let chord_sq = (radius - across) * (radius + across) - radius * radius * MARGIN;
            let chord = chord_sq.simd_gt(zero).select(chord_sq, zero).sqrt();
            let far = along - chord + margin;
            for lane in set_bits(fills.to_bitmask()) {
                farthest = farthest.min(far[lane]);
            }
        }
        (missed.to_bitmask(), farthest)
    }

    /// The rows or columns of a tile, as bits, whose samples may see each of the balls.
    ///
    /// With y and z the center's coordinates along the upward and the forward axis, a plane through
    /// the viewpoint and a row whose height at the distance of 1 is s touches the ball where
    /// (y − s z)² = r² (1 + s²): at s = (y z ± r √(y² + z² − r²)) / (z² − r²), if all of it is ahead.
    ///
    /// # Accuracy
    /// The radius is first made larger by [`MARGIN`] of all lengths, thousands of times what the
    /// axes, y and z are off by. Then s carries some units in the last place of |y z| + r √… over
    /// z² − r², whose factors do not cancel for z > 65/64 r; and so do the place and the samples' own
    /// places, of all that is added up in them: in rows less than the margin.
    #[inline(always)]
    fn lines(&self, simd: S, rows: &Lines) -> [u8; LANES] {
        let (zero, end) = (
            f64x8::splat(simd, 0.0),
            f64x8::splat(simd, f64::from(rows.count)),
        );
        let y = self.center.dot_one(rows.up);
        let z = self.center.dot_one(rows.forward);
        let size = self.center.x.abs() + self.center.y.abs() + self.center.z.abs();
        let radius = self.radius + (size + self.radius) * MARGIN;
        let product = (z - radius) * (z + radius);
        let scale = f64x8::splat(simd, rows.on_unit) / product;
        let middle = y * z * scale;
        let half = radius * (y * y + product).sqrt() * scale;
        let margin = (middle.abs() + half + rows.size) * MARGIN;
        let half = half + margin;
        // Row k is asked where its samples, from k + first to k + last, reach the silhouette. Cutting
        // off rounds the first row up: where it already is whole, the margin alone reaches it.
        let first = rows.origin - middle - half - rows.last + 1.0;
        let end_row = rows.origin - middle + half - rows.first + 1.0;
        let is_known = z.simd_gt(radius * CLEAR) & half.simd_lt(f64::INFINITY);
        let first = is_known.select(first.max(zero).min(end), zero);
        let end_row = is_known.select(end_row.max(zero).min(end), end);
        let (first, end_row): ([f64; LANES], [f64; LANES]) = (first.into(), end_row.into());
        let mut bits = [0; LANES];
        for lane in 0..LANES {
            let below = (1_u32 << first[lane] as u32) - 1;
            bits[lane] = (((1_u32 << end_row[lane] as u32) - 1) & !below) as u8;
        }
        bits
    }
}

#[cfg(test)]
mod tests;
