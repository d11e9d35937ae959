//! The part of a box on the positive sides of two lines.

use fearless_simd::Simd;

use super::half_plane::HalfPlane;
use crate::numeric::lanes::{f64x8, mask64x8};

/// Lines whose directions differ by less than this, the sine squared, are parallel: where they cross is not known.
const PARALLEL: f64 = 1e-12;

/// The least divisor of changes along lines, for a largest change of 1.
const LEAST_CHANGE: f64 = 1e-30;

/// A line whose changes across the box are divided by.
struct Line<S: Simd> {
    value: f64x8<S>,
    across: [f64x8<S>; 2],
    by_across: [f64x8<S>; 2],
    is_rising: [mask64x8<S>; 2],
    /// The reciprocal of the sum of the squares of the changes.
    by_size_sq: f64x8<S>,
}

/// The contributions of parts of the rim of a figure to its area and to the integrals of the coordinates over it:
/// triangles with the middle of the box.
struct Triangles<S: Simd> {
    area: f64x8<S>,
    moments: [f64x8<S>; 2],
}

impl<S: Simd> Line<S> {
    #[inline(always)]
    fn new(simd: S, part: &HalfPlane<S>) -> Self {
        let one = f64x8::splat(simd, 1.0);
        let zero = f64x8::splat(simd, 0.0);
        let least = f64x8::splat(simd, LEAST_CHANGE);
        let is_rising = [part.across[0].simd_ge(zero), part.across[1].simd_ge(zero)];
        let x = part.across[0].abs().max(least);
        let y = part.across[1].abs().max(least);
        let size_sq = x * x + y * y;
        // One division for all.
        let by_all = one / (x * y * size_sq);
        let (by_x, by_y) = (by_all * size_sq * y, by_all * size_sq * x);
        let by_across = [
            is_rising[0].select(by_x, -by_x),
            is_rising[1].select(by_y, -by_y),
        ];
        Self {
            value: part.value,
            across: part.across,
            by_across,
            is_rising,
            by_size_sq: by_all * x * y,
        }
    }

    /// The part of an interval along a side of the box, on which the function has this value in the middle, where it is
    /// positive.
    #[inline(always)]
    fn clip(&self, axis: usize, value: f64x8<S>, [low, high]: [f64x8<S>; 2]) -> [f64x8<S>; 2] {
        let root = -value * self.by_across[axis];
        let is_rising = self.is_rising[axis];
        [
            is_rising.select(low.max(root), low),
            is_rising.select(high, high.min(root)),
        ]
    }

    /// The place on the line next to the middle of the box, and between which multiples of (−y, x) of its gradient,
    /// counted from there, it lies in the box.
    #[inline(always)]
    fn chord(&self, simd: S) -> ([f64x8<S>; 2], [f64x8<S>; 2]) {
        let half = f64x8::splat(simd, 0.5);
        let [x, y] = self.across;
        let step = -self.value * self.by_size_sq;
        let foot = [x * step, y * step];
        // |foot − along y| and |foot + along x| are no more than a half.
        let middle = foot[0] * self.by_across[1];
        let reach = (half * self.by_across[1]).abs();
        let middle_y = -foot[1] * self.by_across[0];
        let reach_y = (half * self.by_across[0]).abs();
        let low = (middle - reach).max(middle_y - reach_y);
        let high = (middle + reach).min(middle_y + reach_y);
        (foot, [low, high])
    }

    /// The part of an interval along the line on the positive side of another, whose function changes by `change` along
    /// it: its size has a reciprocal.
    #[inline(always)]
    fn beside(
        &self,
        simd: S,
        other: &Self,
        (foot, [low, high]): ([f64x8<S>; 2], [f64x8<S>; 2]),
        (change, by_change): (f64x8<S>, f64x8<S>),
    ) -> [f64x8<S>; 2] {
        let zero = f64x8::splat(simd, 0.0);
        let there = other.value + other.across[0] * foot[0] + other.across[1] * foot[1];
        let is_rising = change.simd_ge(zero);
        let root = there * by_change;
        [
            is_rising.select(low.max(-root), low),
            is_rising.select(high, high.min(root)),
        ]
    }
}

impl<S: Simd> Triangles<S> {
    /// Adds the part of a line that lies in the box and on the positive side of another, whose function changes by
    /// `change` along (−y, x) of the gradient of the first: its size has a reciprocal.
    #[inline(always)]
    fn add_line(
        &mut self,
        simd: S,
        line: &Line<S>,
        other: &Line<S>,
        (change, by_change): (f64x8<S>, f64x8<S>),
    ) {
        let zero = f64x8::splat(simd, 0.0);
        let [x, y] = line.across;
        let (foot, ends) = line.chord(simd);
        let [low, high] = line.beside(simd, other, (foot, ends), (change, by_change));
        let area = line.value * (high - low).max(zero) * 0.5;
        let along = low + high;
        self.area += area;
        self.moments[0] += area * (foot[0] * 2.0 - along * y) * (1.0 / 3.0);
        self.moments[1] += area * (foot[1] * 2.0 + along * x) * (1.0 / 3.0);
    }

    /// Adds the parts of two sides of the box, along an axis, on the positive sides of both lines.
    #[inline(always)]
    fn add_sides(&mut self, simd: S, lines: [&Line<S>; 2], along: usize) {
        let zero = f64x8::splat(simd, 0.0);
        let half = f64x8::splat(simd, 0.5);
        let aside = 1 - along;
        for side in [-0.5, 0.5] {
            let mut interval = [-half, half];
            for line in lines {
                let value = line.value + line.across[aside] * side;
                interval = line.clip(along, value, interval);
            }
            let [low, high] = interval;
            let area = (high - low).max(zero) * 0.25;
            self.area += area;
            self.moments[aside] += area * (side * 2.0 / 3.0);
            self.moments[along] += area * (low + high) * (1.0 / 3.0);
        }
    }
}

/// The part of a line's way through boxes on the positive side of another line; 1 where it does not cross them.
#[inline(always)]
pub(super) fn part_beside<S: Simd>(simd: S, part: &HalfPlane<S>, other: &HalfPlane<S>) -> f64x8<S> {
    let zero = f64x8::splat(simd, 0.0);
    let one = f64x8::splat(simd, 1.0);
    let least = f64x8::splat(simd, LEAST_CHANGE);
    let [line, beside] = [Line::new(simd, part), Line::new(simd, other)];
    let [[x, y], [u, v]] = [part.across, other.across];
    let turn = x * v - y * u;
    let by_turn = one / turn.abs().max(least);
    let (foot, ends) = line.chord(simd);
    let all = ends[1] - ends[0];
    let [low, high] = line.beside(simd, &beside, (foot, ends), (turn, by_turn));
    let share = ((high - low) / all.max(least)).max(zero).min(one);
    all.simd_gt(zero).select(share, one)
}

/// The shares of boxes in both of two half-planes whose lines cut the boxes, and the integrals over them of the
/// coordinates from the middles of the boxes, in sides.
///
/// # Source
/// Green's theorem: the area is that of the triangles between the middle of the box and each stretch of the rim.
#[inline(always)]
pub(super) fn intersection<S: Simd>(
    simd: S,
    one: &HalfPlane<S>,
    other: &HalfPlane<S>,
) -> (f64x8<S>, [f64x8<S>; 2]) {
    let zero = f64x8::splat(simd, 0.0);
    let lines = [Line::new(simd, one), Line::new(simd, other)];
    let [[x, y], [u, v]] = [one.across, other.across];
    let turn = x * v - y * u;
    let mut sum = Triangles {
        area: zero,
        moments: [zero; 2],
    };
    let least = f64x8::splat(simd, LEAST_CHANGE);
    let by_turn = f64x8::splat(simd, 1.0) / turn.abs().max(least);
    sum.add_line(simd, &lines[0], &lines[1], (turn, by_turn));
    sum.add_line(simd, &lines[1], &lines[0], (-turn, by_turn));
    sum.add_sides(simd, [&lines[0], &lines[1]], 0);
    sum.add_sides(simd, [&lines[0], &lines[1]], 1);

    let is_parallel = (turn * turn).simd_lt((x * x + y * y) * (u * u + v * v) * PARALLEL);
    if is_parallel.to_bitmask() == 0 {
        return (sum.area, sum.moments);
    }
    // One lies in the other, or they meet between the lines.
    let is_nested = (x * u + y * v).simd_gt(zero);
    let is_less = one.share.simd_lt(other.share);
    let between = (one.share + other.share - 1.0).max(zero);
    let area = is_nested.select(one.share.min(other.share), between);
    let is_between = between.simd_gt(zero);
    let mut moments = sum.moments;
    for (axis, moment) in moments.iter_mut().enumerate() {
        let both = is_between.select(one.moments[axis] + other.moments[axis], zero);
        let lesser = is_less.select(one.moments[axis], other.moments[axis]);
        *moment = is_parallel.select(is_nested.select(lesser, both), *moment);
    }
    (is_parallel.select(area, sum.area), moments)
}

#[cfg(test)]
mod tests;
