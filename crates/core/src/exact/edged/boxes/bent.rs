//! The parts of boxes on one side of curves of the second degree.

use fearless_simd::Simd;

use super::half_plane::{HalfPlane, Slopes};
use crate::numeric::lanes::{f64x8, mask64x8};

/// The terms of second degree of functions on boxes, in sides from their middles: of x², x y and y².
#[derive(Clone, Copy, Debug)]
pub(super) struct Bends<S: Simd> {
    pub(super) xx: f64x8<S>,
    pub(super) xy: f64x8<S>,
    pub(super) yy: f64x8<S>,
}

/// The share of a parabola's height over its chord that is in doubt when the line is moved by the average height, as
/// the ends of the chord are not those of the parabola; and more of it, over the height in sides.
const OF_HEIGHT: f64 = 0.08;
const OF_HEIGHT_IN_SIDES: f64 = 2.5;

/// The share of a box that is in doubt if both sides of a narrow curve cross it.
const OF_NARROW: f64 = 0.35;

/// A little more than from the middle of a box to a corner.
const FARTHEST: f64 = 0.85;

/// The way from the middle of a box to a corner.
const FARTHEST_CORNER: f64 = std::f64::consts::FRAC_1_SQRT_2;

impl<S: Simd> Bends<S> {
    /// No less than their size anywhere in the box.
    #[inline(always)]
    pub(super) fn most(&self) -> f64x8<S> {
        (self.xx.abs() + self.xy.abs() + self.yy.abs()) * 0.25
    }

    /// The value and the changes of a function in the middles of boxes, of which these are known at a place.
    #[inline(always)]
    pub(super) fn moved(
        &self,
        value: f64x8<S>,
        [x, y]: [f64x8<S>; 2],
        place: [f64x8<S>; 2],
    ) -> (f64x8<S>, [f64x8<S>; 2]) {
        let [turned_x, turned_y] = self.slopes(place);
        let there = self.at(place);
        (
            value - x * place[0] - y * place[1] + there,
            [x - turned_x, y - turned_y],
        )
    }

    /// The boxes in which a function with these values and changes in the middles falls below 0 on both sides of the
    /// middle: a narrow strip may run through the box there, whose own gradient leads along it.
    #[inline(always)]
    fn fall_on_both_sides(&self, value: f64x8<S>, [x, y]: [f64x8<S>; 2]) -> mask64x8<S> {
        let sum = self.xx + self.yy;
        let along_sides = falls_aside(value, self.xx, x) | falls_aside(value, self.yy, y);
        let across_corners =
            falls_aside(value, sum + self.xy, x + y) | falls_aside(value, sum - self.xy, x - y);
        value.simd_ge(0.0) & (along_sides | across_corners)
    }

    /// Their average over a part of each box with this middle: about that over a rectangle as long and as high as fits
    /// around it.
    #[inline(always)]
    pub(super) fn on_average(&self, middle: [f64x8<S>; 2]) -> f64x8<S> {
        /// The average of squares from −½ to ½.
        const OF_SQUARES: f64 = 1.0 / 12.0;
        let (width, height) = (middle[0].abs() * -2.0 + 1.0, middle[1].abs() * -2.0 + 1.0);
        self.at(middle) + (self.xx * width * width + self.yy * height * height) * OF_SQUARES
    }

    /// The terms at a place.
    #[inline(always)]
    pub(super) fn at(&self, [x, y]: [f64x8<S>; 2]) -> f64x8<S> {
        (self.xx * x + self.xy * y) * x + self.yy * y * y
    }

    /// The changes of the terms at a place.
    #[inline(always)]
    pub(super) fn slopes(&self, [x, y]: [f64x8<S>; 2]) -> [f64x8<S>; 2] {
        [
            self.xx * x * 2.0 + self.xy * y,
            self.xy * x + self.yy * y * 2.0,
        ]
    }
}

/// The boxes in which a function with this value, change and term of the second degree along some direction is below 0 a
/// little more than half a side away, both ways.
#[inline(always)]
fn falls_aside<S: Simd>(value: f64x8<S>, term: f64x8<S>, change: f64x8<S>) -> mask64x8<S> {
    const FAR: f64 = 0.6;
    (value + term * (FAR * FAR) + change.abs() * FAR).simd_lt(0.0)
}

/// The chord of a tangent in a box.
struct Chord<S: Simd> {
    /// The average of the squares of the ways from the point where it touches to its points in the box, and the largest.
    mean_sq: f64x8<S>,
    most_sq: f64x8<S>,
    /// The depth of the line inside of the farthest corner, in values of the function.
    depth: f64x8<S>,
}

impl<S: Simd> Chord<S> {
    /// The chord of a tangent with this value in the middle of the box, that touches at `foot`.
    #[inline(always)]
    fn new(
        simd: S,
        slopes: &Slopes<S>,
        value: f64x8<S>,
        tangent: [f64x8<S>; 2],
        foot: [f64x8<S>; 2],
    ) -> Self {
        let zero = f64x8::splat(simd, 0.0);
        let one = f64x8::splat(simd, 1.0);
        let distance = value.abs();
        let depth = (slopes.large + slopes.small) * 0.5 - distance;
        let inside = depth.max(zero).min(slopes.small);
        let is_corner = depth.simd_lt(slopes.small);
        // In the corner between two sides, or from side to side; toward positive coordinates.
        let (x, y) = (inside * slopes.by_large, inside * slopes.by_small);
        let across = distance * slopes.by_large;
        let thin = slopes.small * slopes.by_large;
        let along_large = is_corner.select(x * -0.5 + 0.5, across);
        let along_small = is_corner.select(y * -0.5 + 0.5, zero);
        let length_sq = is_corner.select(x * x + y * y, thin * thin + one);
        // The line lies where the function falls to 0.
        let is_x_large = tangent[0].abs().simd_ge(tangent[1].abs());
        let toward_x = (value * tangent[0]).simd_lt(zero);
        let toward_y = (value * tangent[1]).simd_lt(zero);
        let middle_x = is_x_large.select(along_large, along_small);
        let middle_y = is_x_large.select(along_small, along_large);
        let aside_x = toward_x.select(middle_x, -middle_x) - foot[0];
        let aside_y = toward_y.select(middle_y, -middle_y) - foot[1];
        let from_foot = aside_x * aside_x + aside_y * aside_y;
        let mean_sq = from_foot + length_sq * (1.0 / 12.0);
        let is_inside = depth.simd_gt(zero);
        // Along the line from the point where it touches, past the foot of the middle, to what faces a corner.
        let foot_sq = foot[0] * foot[0] + foot[1] * foot[1] - value * value * slopes.by_size_sq;
        let farthest = foot_sq.max(zero).sqrt() + f64x8::splat(simd, FARTHEST_CORNER);
        let farthest = farthest * farthest;
        let most_sq = ((from_foot + length_sq * 0.25) * 2.0).min(farthest);
        Self {
            mean_sq: is_inside.select(mean_sq, zero),
            most_sq: is_inside.select(most_sq, farthest),
            depth,
        }
    }
}

impl<S: Simd> HalfPlane<S> {
    /// The half-plane of functions of the second degree, or no more than `rest` from those, with these values and these changes across
    /// the boxes in their middles.
    ///
    /// The line is tangent where the gradient from the middle meets the curve, and then moved to where it leaves the
    /// area that the parabola along it does.
    #[inline(always)]
    pub(super) fn of_second_degree(
        simd: S,
        value: f64x8<S>,
        across: [f64x8<S>; 2],
        bends: &Bends<S>,
        rest: Option<f64x8<S>>,
    ) -> Self {
        let zero = f64x8::splat(simd, 0.0);
        let one = f64x8::splat(simd, 1.0);
        let tiny = f64x8::splat(simd, f64::MIN_POSITIVE);
        let [x, y] = across;
        let size_sq = x * x + y * y;
        let by_steep = one / size_sq.max(tiny);
        // Along the gradient the function is g + g' s + a s²: its slope at the root is g' √(1 − 4 a g / g'²).
        let along = bends.at(across) * by_steep;
        let slope_sq = (one - value * by_steep * along * 4.0).max(tiny);
        let slope = slope_sq.sqrt();
        let step = value * by_steep * -2.0 / (slope + 1.0);
        let foot = [x * step, y * step];
        let turned = bends.slopes(foot);
        let tangent = [x + turned[0], y + turned[1]];
        let straight = -(tangent[0] * foot[0] + tangent[1] * foot[1]);

        let slopes = Slopes::new(simd, tangent);
        let aside = bends.at([-tangent[1], tangent[0]]) * slopes.by_size_sq;
        let chord = Chord::new(simd, &slopes, straight, tangent, foot);
        let moved = straight + aside * chord.mean_sq;
        // The parabola lies on one side of the line: a box on its other side is decided.
        let is_crossed = chord.depth.simd_gt(zero);
        let is_aside = (aside * straight).simd_ge(zero) & !is_crossed;
        let height = is_aside.select(zero, aside.abs() * chord.most_sq);
        let in_sides = height * slopes.by_large * OF_HEIGHT_IN_SIDES + OF_HEIGHT;
        // A line that is farther inside than the parabola is high has about its chord.
        let is_long = chord.depth.simd_gt(height);
        let left = height * is_long.select(in_sides.min(one), one);
        let left = match rest {
            Some(rest) => left + rest / slope.min(one),
            None => left,
        };
        let mut part = Self::of_slopes(simd, &slopes, moved, tangent, left);
        // The other root along the gradient lies so far from the first, on the side of what is positive.
        let may_be_narrow =
            (slope_sq * size_sq).simd_lt(along * along * (4.0 * FARTHEST * FARTHEST));
        if may_be_narrow.to_bitmask() != 0 {
            let size = size_sq.sqrt();
            let to_foot = (step * size).abs();
            let to_end = FARTHEST + value.simd_ge(zero).select(to_foot, -to_foot);
            let is_narrow = (slope * size).simd_lt(along.abs() * to_end);
            part.doubt = is_narrow.select(part.doubt.max(OF_NARROW), part.doubt);
        }
        let is_strip = bends.fall_on_both_sides(value, across);
        if is_strip.to_bitmask() != 0 {
            part.doubt = is_strip.select(part.doubt.max(OF_NARROW), part.doubt);
        }
        let bend = bends.most() + rest.unwrap_or(zero);
        // Without a root along the gradient, or without a gradient, there is no line: the function may have one sign in
        // all of the box.
        let is_lost = slope_sq.simd_le(tiny) | size_sq.simd_le(tiny);
        if is_lost.to_bitmask() != 0 {
            let mut linear = Self::new(simd, value, across, bend);
            let other_sign = value.simd_gt(zero).select(one - linear.share, linear.share);
            linear.doubt = linear.doubt.max(other_sign);
            part = part.or(is_lost, &linear);
        }
        let is_decided = value.abs().simd_gt((x.abs() + y.abs()) * 0.5 + bend);
        if is_decided.to_bitmask() != 0 {
            let mut whole = Self::whole(simd);
            whole.share = value.simd_gt(zero).select(one, zero);
            part = part.or(is_decided, &whole);
        }
        part
    }
}

#[cfg(test)]
mod tests;
