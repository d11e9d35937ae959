//! Spheres that nearer ones together hide from a cell.

use fearless_simd::{Level, Simd, dispatch};

use super::active::Active;
use super::mask;
use crate::numeric::lanes::f64x8;
use crate::numeric::order::sort_by_number;
use crate::numeric::polynomial::Quadratic;
use crate::numeric::rounding::GEOMETRY_SLACK;

/// The memory that is worked in to find hidden spheres.
#[derive(Clone, Debug, Default)]
pub(super) struct HiddenSpheres {
    /// The least distances from the eye at which spheres may be seen, and their positions.
    begins: Vec<(f64, usize)>,
    /// The distances behind which spheres hide what they cover, and their positions.
    ends: Vec<(f64, usize)>,
    hidden: Vec<bool>,
}

/// The fewest spheres of which one may be hidden by two others together.
const FEWEST: usize = 3;

impl HiddenSpheres {
    /// Removes the spheres of which nothing is seen in the cell.
    ///
    /// The cell is seen as squares. A sphere hides those whose corners it covers, as what an eye in
    /// front of it sees of it is convex, from all that lies farther away than √K, where rays touch
    /// it.
    pub(super) fn remove(&mut self, level: Level, active: &mut Vec<Active>) {
        if active.len() < FEWEST {
            return;
        }
        self.begins.clear();
        self.ends.clear();
        for (position, active) in active.iter().enumerate() {
            let ball = &active.ball;
            if ball.outside > 0.0 && ball.is_parallel() {
                // Rays touch it at the center's distance.
                let (distance, slack) = (ball.center.z, GEOMETRY_SLACK * ball.center.length());
                self.begins.push((distance - ball.radius - slack, position));
                self.ends.push((distance + slack, position));
            } else if ball.outside > 0.0 {
                let distance = ball.center.length();
                let begin = distance - ball.radius - GEOMETRY_SLACK * distance;
                self.begins.push((begin, position));
                if ball.center.z > ball.radius {
                    let end = ball.outside.sqrt() * (1.0 + GEOMETRY_SLACK);
                    self.ends.push((end, position));
                }
            }
        }
        sort_by_number(&mut self.begins);
        sort_by_number(&mut self.ends);
        self.hidden.clear();
        self.hidden.resize(active.len(), false);
        let mut covered = 0;
        let mut ends = self.ends.iter().peekable();
        for &(begin, position) in &self.begins {
            while let Some((_, nearer)) = ends.next_if(|(end, _)| *end < begin) {
                if covered != mask::ALL && !self.hidden[*nearer] {
                    covered |= covers(level, &active[*nearer].discriminant);
                }
            }
            let is_hidden = covered == mask::ALL
                || covered != 0 && touches(level, &active[position].discriminant) & !covered == 0;
            self.hidden[position] = is_hidden;
        }
        if self.hidden.contains(&true) {
            let mut hidden = self.hidden.iter();
            active.retain(|_| !hidden.next().is_some_and(|&hidden| hidden));
        }
    }
}

/// The places of the corners of squares along a side.
const CORNERS: [f64; 8] = [
    -0.5,
    1.0 / 7.0 - 0.5,
    2.0 / 7.0 - 0.5,
    3.0 / 7.0 - 0.5,
    4.0 / 7.0 - 0.5,
    5.0 / 7.0 - 0.5,
    6.0 / 7.0 - 0.5,
    0.5,
];
/// Half the side of a square.
const HALF: f64 = 0.5 / mask::SIDE as f64;

/// A bound of what rounding changes a discriminant by.
fn slack(q: &Quadratic) -> f64 {
    GEOMETRY_SLACK * (q.spread() + q.one.abs())
}

/// The squares on which a discriminant is positive.
fn covers(level: Level, q: &Quadratic) -> u64 {
    dispatch!(level, simd => covers_lanes(simd, q))
}

#[inline(always)]
fn covers_lanes<S: Simd>(simd: S, q: &Quadratic) -> u64 {
    let x: f64x8<S> = f64x8::from_array(simd, CORNERS);
    let (constant, slope) = ((x * q.xx + q.x) * x + q.one, x * q.xy + q.y);
    let least = slack(q);
    let mut corners = 0;
    for (row, y) in CORNERS.into_iter().enumerate() {
        let value = (slope + q.yy * y) * y + constant;
        corners |= value.simd_gt(least).to_bitmask() << (8 * row);
    }
    mask::between(corners)
}

/// The squares on which a discriminant may be positive.
fn touches(level: Level, q: &Quadratic) -> u64 {
    dispatch!(level, simd => touches_lanes(simd, q))
}

#[inline(always)]
fn touches_lanes<S: Simd>(simd: S, q: &Quadratic) -> u64 {
    let x: f64x8<S> = f64x8::from_array(simd, CORNERS);
    let x = x + HALF;
    let (constant, slope) = ((x * q.xx + q.x) * x + q.one, x * q.xy + q.y);
    let rise = x * (2.0 * q.xx) + q.x;
    let bend = HALF * HALF * (q.xx.max(0.0) + q.xy.abs() + q.yy.max(0.0));
    let least = -slack(q) - bend;
    let mut touched = 0;
    for (row, y) in CORNERS.into_iter().enumerate() {
        let y = y + HALF;
        let value = (slope + q.yy * y) * y + constant;
        let steep = (rise + q.xy * y).abs() + (slope + 2.0 * q.yy * y).abs();
        let most = steep * HALF + value;
        // What is not a number may be anything.
        touched |= (!most.simd_lt(least)).to_bitmask() << (8 * row);
    }
    touched & mask::ALL
}
