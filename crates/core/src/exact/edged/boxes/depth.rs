//! Functions on boxes, and the distances of spheres among them.

use fearless_simd::f64x8;
use fearless_simd::prelude::*;

use super::eight_boxes::{Eight, EightBoxes};
use super::half_plane::HalfPlane;
use crate::exact::classify::active::Active;
use crate::numeric::polynomial::Quadratic;

/// A polynomial of degree 2 on boxes: its values in their middles, its changes across them, and how much it differs
/// from a linear function in their corners at most.
#[derive(Clone, Copy, Debug)]
pub(super) struct Function<S: Simd> {
    pub(super) value: f64x8<S>,
    pub(super) across: [f64x8<S>; 2],
    pub(super) bend: f64x8<S>,
}

impl<S: Simd> Function<S> {
    #[inline(always)]
    pub(super) fn new(simd: S, boxes: &EightBoxes<S>, q: &Quadratic) -> Self {
        let [width, height] = boxes.size;
        let (x, y) = (boxes.x, boxes.y);
        let slope_x = x * (2.0 * q.xx) + y * q.xy + q.x;
        let slope_y = y * (2.0 * q.yy) + x * q.xy + q.y;
        let bend = 0.25
            * (q.xx.abs() * width * width
                + q.xy.abs() * width * height
                + q.yy.abs() * height * height);
        Self {
            value: (x * q.xx + y * q.xy + q.x) * x + (y * q.yy + q.y) * y + q.one,
            across: [slope_x * width, slope_y * height],
            bend: f64x8::splat(simd, bend),
        }
    }

    /// What its second derivative adds where it vanishes, as if it were linear, straight along the gradient.
    #[inline(always)]
    pub(super) fn second(&self, simd: S, boxes: &EightBoxes<S>, q: &Quadratic) -> f64x8<S> {
        let [width, height] = boxes.size;
        let tiny = f64x8::splat(simd, f64::MIN_POSITIVE);
        let (x, y) = (
            self.across[0] * (1.0 / width),
            self.across[1] * (1.0 / height),
        );
        let by_steep = f64x8::splat(simd, 1.0) / (x * x + y * y).max(tiny);
        let step = self.value * by_steep;
        (x * x * q.xx + x * y * q.xy + y * y * q.yy) * (step * step)
    }
}

/// The reciprocals of the distances of a sphere along rays, in multiples of these, as linear functions on boxes. Those
/// of a plane are linear.
#[derive(Clone, Copy, Debug)]
pub(super) struct Depth {
    middle: Eight,
    across: [Eight; 2],
    bend: Eight,
}

impl Depth {
    pub(super) const NONE: Self = Self {
        middle: [0.0; 8],
        across: [[0.0; 8]; 2],
        bend: [0.0; 8],
    };

    /// 1 / t = (B + √Q) / K, where rays miss as if they grazed.
    #[inline(always)]
    pub(super) fn new<S: Simd>(
        simd: S,
        boxes: &EightBoxes<S>,
        active: &Active,
        &Function {
            value: discriminant,
            across,
            bend,
        }: &Function<S>,
    ) -> Self {
        let [width, height] = boxes.size;
        let along = &active.along;
        // Nearer to the silhouette than this the depth of a box is no linear function.
        let wide = (across[0].abs() + across[1].abs()) * 0.5;
        let least = (wide * 0.25).max(f64x8::splat(simd, f64::MIN_POSITIVE));
        let root = discriminant.max(least).sqrt();
        let by_root = f64x8::splat(simd, 0.5) / root;
        let by_outside = 1.0 / active.ball.outside;
        let sum = boxes.x * along.x + boxes.y * along.y + along.one + root;
        // Half of (√Q)'' = Q'' / (2 √Q) − Q'² / (4 √Q³), where the sphere recedes.
        let lowest = (discriminant - wide).max(least);
        let by_lowest = f64x8::splat(simd, 0.5) / lowest.sqrt();
        let bend = by_lowest * (bend + wide * wide * 0.25 / lowest);
        Self {
            middle: (sum * by_outside).into(),
            across: [
                ((across[0] * by_root + along.x * width) * by_outside).into(),
                ((across[1] * by_root + along.y * height) * by_outside).into(),
            ],
            bend: (bend * by_outside).into(),
        }
    }

    /// The parts of boxes in which this lies behind another.
    #[inline(always)]
    pub(super) fn behind<S: Simd>(&self, simd: S, other: &Self) -> HalfPlane<S> {
        let value = difference(simd, &other.middle, &self.middle);
        let across = [
            difference(simd, &other.across[0], &self.across[0]),
            difference(simd, &other.across[1], &self.across[1]),
        ];
        let bend: f64x8<S> = self.bend.simd_into(simd);
        let more: f64x8<S> = other.bend.simd_into(simd);
        HalfPlane::new(simd, value, across, bend + more)
    }
}

#[inline(always)]
fn difference<S: Simd>(simd: S, one: &Eight, other: &Eight) -> f64x8<S> {
    let one: f64x8<S> = (*one).simd_into(simd);
    let other: f64x8<S> = (*other).simd_into(simd);
    one - other
}
