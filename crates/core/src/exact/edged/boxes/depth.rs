//! Functions on boxes, and the distances of spheres among them.

use fearless_simd::Simd;

use super::bent::Bends;
use super::eight_boxes::{Eight, EightBoxes};
use super::half_plane::HalfPlane;
use crate::exact::classify::active::Active;
use crate::numeric::lanes::{f64x8, mask64x8};
use crate::numeric::polynomial::Quadratic;

/// A polynomial of degree 2 on boxes: its values in their middles, its changes across them there, and its terms of the
/// second degree.
#[derive(Clone, Copy, Debug)]
pub(super) struct Function<S: Simd> {
    pub(super) value: f64x8<S>,
    pub(super) across: [f64x8<S>; 2],
    pub(super) bends: Bends<S>,
}

impl<S: Simd> Function<S> {
    #[inline(always)]
    pub(super) fn new(simd: S, boxes: &EightBoxes<S>, q: &Quadratic) -> Self {
        let [width, height] = boxes.size;
        let (x, y) = (boxes.x, boxes.y);
        let slope_x = x * (2.0 * q.xx) + y * q.xy + q.x;
        let slope_y = y * (2.0 * q.yy) + x * q.xy + q.y;
        Self {
            value: (x * q.xx + y * q.xy + q.x) * x + (y * q.yy + q.y) * y + q.one,
            across: [slope_x * width, slope_y * height],
            bends: Bends {
                xx: f64x8::splat(simd, q.xx * width * width),
                xy: f64x8::splat(simd, q.xy * width * height),
                yy: f64x8::splat(simd, q.yy * height * height),
            },
        }
    }

    /// The step along the gradient, in sides, from the middle of a part of each box to where the function is this share
    /// of its average over the part.
    #[inline(always)]
    pub(super) fn toward_mean(&self, middle: [f64x8<S>; 2], share: f64) -> [f64x8<S>; 2] {
        let one = f64x8::splat(middle[0].simd(), 1.0);
        let [x, y] = self.across;
        let there = self.value + x * middle[0] + y * middle[1];
        let (at_middle, on_average) = (self.bends.at(middle), self.bends.on_average(middle));
        let [turned_x, turned_y] = self.bends.slopes(middle);
        let gradient = [x + turned_x, y + turned_y];
        let size_sq = gradient[0] * gradient[0] + gradient[1] * gradient[1];
        let rise = (there + on_average) * share - (there + at_middle);
        let step = rise / size_sq.max(one * f64::MIN_POSITIVE);
        [gradient[0] * step, gradient[1] * step]
    }
}

/// The reciprocals of the distances of a sphere along rays, in multiples of these, on boxes: those of a plane are linear.
/// For parallel rays they are the distances themselves, with the other sign.
#[derive(Clone, Copy, Debug)]
pub(super) struct Depth {
    middle: Eight,
    across: [Eight; 2],
    bends: [Eight; 3],
    /// Their difference from a polynomial of the second degree.
    rest: Eight,
    /// The least and the largest in the boxes.
    range: [Eight; 2],
}

impl Depth {
    /// 1 / t = (B + √Q) / K, where rays miss as if they grazed; −t for parallel rays.
    #[inline(always)]
    pub(super) fn new<S: Simd>(
        simd: S,
        boxes: &EightBoxes<S>,
        active: &Active,
        &Function {
            value: discriminant,
            across: [x, y],
            bends,
        }: &Function<S>,
    ) -> Self {
        let [width, height] = boxes.size;
        let along = &active.along;
        // Nearer to the silhouette than this the depth of a box is no polynomial.
        let wide = (x.abs() + y.abs()) * 0.5;
        let least = (wide * 0.25).max(f64x8::splat(simd, f64::MIN_POSITIVE));
        let inside = discriminant.max(least);
        let root = inside.sqrt();
        let by_root = f64x8::splat(simd, 0.5) / root;
        // For parallel rays √Q − c_z is what rises toward the eye.
        let is_parallel = active.ball.is_parallel();
        let by_outside = if is_parallel {
            1.0
        } else {
            1.0 / active.ball.outside
        };
        let sign = if is_parallel { -1.0 } else { 1.0 };
        let zero = f64x8::splat(simd, 0.0);
        let foot = boxes.x * along.x + boxes.y * along.y + along.one * sign;
        let turned = 0.5 * ((along.x * width).abs() + (along.y * height).abs());
        let most = wide + bends.most();
        // √(Q + q) is no more than √Q + q / 2√Q, and √(Q − q) no less than √Q − q / √Q.
        let nearest = foot + turned + root + most * by_root;
        let farthest = foot - turned + (root - most * by_root * 2.0).max(zero);
        let sum = foot + root;
        // √(Q + q) = √Q (1 + q/2Q − q²/8Q² + q³/16Q³ …).
        let eighth = by_root * by_root * by_root;
        let squares = Bends {
            xx: bends.xx * by_root - x * x * eighth,
            xy: bends.xy * by_root - x * y * eighth * 2.0,
            yy: bends.yy * by_root - y * y * eighth,
        };
        let lowest = (discriminant - wide).max(least);
        let by_lowest = f64x8::splat(simd, 1.0) / lowest;
        let third = wide * by_lowest * (wide * wide * 0.0625 + bends.most() * lowest * 0.25);
        let rest = third * by_lowest * by_lowest * root;
        Self {
            middle: (sum * by_outside).into(),
            across: [
                ((x * by_root + along.x * width) * by_outside).into(),
                ((y * by_root + along.y * height) * by_outside).into(),
            ],
            bends: [
                (squares.xx * by_outside).into(),
                (squares.xy * by_outside).into(),
                (squares.yy * by_outside).into(),
            ],
            rest: (rest * by_outside).into(),
            range: [
                (farthest * by_outside).into(),
                (nearest * by_outside).into(),
            ],
        }
    }

    /// The parts of boxes in which this lies behind another; where neither or one alone is seen, any.
    #[inline(always)]
    pub(super) fn behind<S: Simd>(
        &self,
        simd: S,
        other: &Self,
        are_seen: mask64x8<S>,
    ) -> HalfPlane<S> {
        let is_behind = difference(simd, &other.range[0], &self.range[1]).simd_gt(0.0);
        let is_before = difference(simd, &self.range[0], &other.range[1]).simd_gt(0.0);
        let whole = HalfPlane::whole(simd);
        let decided = whole.or(is_before, &whole.other_side(simd));
        let is_open = are_seen & !(is_behind | is_before);
        if is_open.to_bitmask() == 0 {
            return decided;
        }
        let value = difference(simd, &other.middle, &self.middle);
        let across = [
            difference(simd, &other.across[0], &self.across[0]),
            difference(simd, &other.across[1], &self.across[1]),
        ];
        let bends = Bends {
            xx: difference(simd, &other.bends[0], &self.bends[0]),
            xy: difference(simd, &other.bends[1], &self.bends[1]),
            yy: difference(simd, &other.bends[2], &self.bends[2]),
        };
        let rest: f64x8<S> = f64x8::from_array(simd, self.rest);
        let more: f64x8<S> = f64x8::from_array(simd, other.rest);
        let part = HalfPlane::of_second_degree(simd, value, across, &bends, Some(rest + more));
        decided.or(is_open, &part)
    }
}

#[inline(always)]
fn difference<S: Simd>(simd: S, one: &Eight, other: &Eight) -> f64x8<S> {
    let one: f64x8<S> = f64x8::from_array(simd, *one);
    let other: f64x8<S> = f64x8::from_array(simd, *other);
    one - other
}
