//! The shares of boxes in which spheres are seen.

use fearless_simd::prelude::*;
use fearless_simd::{f64x8, mask64x8};

use super::depth::{Depth, Function};
use super::edges::Edges;
use super::eight_boxes::{Eight, EightBoxes};
use super::half_plane::HalfPlane;
use super::orders::{Order, Orders};
use crate::exact::classify::active::Active;

/// A sphere as eight boxes see it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Outline {
    /// Its position among the active spheres.
    pub(super) position: usize,
    /// The share of each box inside its silhouette, and the integrals over it of the coordinates from the middle of
    /// the box, in sides of the box.
    share: Eight,
    moments: [Eight; 2],
    /// How far the silhouette is from deciding the whole box.
    ambiguity: Eight,
    /// How much the share may be off because the silhouette is no line.
    doubt: Eight,
    /// How far a point must be moved along both axes, in sides, from the middle of what is seen to where the root of
    /// the discriminant is the average.
    inward: [Eight; 2],
    depth: Depth,
}

/// What is seen of a sphere in eight boxes.
#[derive(Clone, Copy, Debug)]
pub(super) struct Visible<S: Simd> {
    pub(super) position: usize,
    /// Its share of each box.
    pub(super) share: f64x8<S>,
    /// The point, in sides from the middle of a box, whose light is about the average.
    pub(super) place: [f64x8<S>; 2],
    /// The boxes that the silhouette cuts, and those in which some of the sphere may be seen.
    pub(super) is_cut: mask64x8<S>,
    pub(super) is_possible: mask64x8<S>,
}

/// The share of a depth from an edge at which a root of it is its average: (2/3)², over a half.
const OF_ROOT: f64 = 8.0 / 9.0;

impl Outline {
    /// A sphere that fills all boxes.
    #[inline(always)]
    pub(super) fn filling<S: Simd>(
        simd: S,
        boxes: &EightBoxes<S>,
        (position, active): (usize, &Active),
        has_depth: bool,
    ) -> Self {
        let none = [0.0; 8];
        let depth = if has_depth {
            let function = Function::new(simd, boxes, &active.discriminant);
            Depth::new(simd, boxes, active, &function)
        } else {
            Depth::NONE
        };
        Self {
            position,
            share: [1.0; 8],
            moments: [none; 2],
            ambiguity: none,
            doubt: none,
            inward: [none; 2],
            depth,
        }
    }

    /// The sphere, if any of the boxes see it.
    #[inline(always)]
    pub(super) fn new<S: Simd>(
        simd: S,
        boxes: &EightBoxes<S>,
        (position, active): (usize, &Active),
        has_depth: bool,
    ) -> Option<Self> {
        let zero = f64x8::splat(simd, 0.0);
        let one = f64x8::splat(simd, 1.0);
        let function = Function::new(simd, boxes, &active.discriminant);
        let Function {
            value,
            across,
            bend,
        } = function;
        let second = function.second(simd, boxes, &active.discriminant);
        let part = HalfPlane::of_second_degree(simd, value, across, (second, bend));
        if part.share.simd_gt(zero).to_bitmask() == 0 && part.doubt.simd_gt(zero).to_bitmask() == 0
        {
            return None;
        }
        let inner = part.share * value + part.moments[0] * across[0] + part.moments[1] * across[1];
        let mean = inner / part.share.max(f64x8::splat(simd, f64::MIN_POSITIVE));
        let is_cut = part.share.simd_lt(one) & part.share.simd_gt(zero);
        let steepness = (across[0] * across[0] + across[1] * across[1])
            .max(f64x8::splat(simd, f64::MIN_POSITIVE));
        let back = is_cut.select(mean * (OF_ROOT - 1.0) / steepness, zero);
        let inward = [back * across[0], back * across[1]];
        let depth = if has_depth {
            Depth::new(simd, boxes, active, &function)
        } else {
            Depth::NONE
        };
        Some(Self {
            position,
            share: part.share.into(),
            moments: [part.moments[0].into(), part.moments[1].into()],
            ambiguity: part.ambiguity(simd).into(),
            doubt: part.doubt.into(),
            inward: [inward[0].into(), inward[1].into()],
            depth,
        })
    }

    /// What is seen of it behind others, whose edges are added to `edges` with its own.
    #[inline(always)]
    pub(super) fn visible<S: Simd>(
        &self,
        simd: S,
        all: &[Self],
        orders: &Orders,
        edges: &mut Edges<S>,
    ) -> Visible<S> {
        let zero = f64x8::splat(simd, 0.0);
        let one = f64x8::splat(simd, 1.0);
        let share: f64x8<S> = self.share.simd_into(simd);
        // What is not hidden by spheres in front, of all, and of those that do not intersect it.
        let mut open = one;
        let mut unhidden = one;
        let mut hidden = [zero; 2];
        let mut seams = Edges::none(simd);
        let mut in_doubt = zero;
        for other in all {
            if other.position == self.position {
                continue;
            }
            let order = orders.of(self.position, other.position);
            if order == Order::Front {
                continue;
            }
            let theirs: f64x8<S> = other.share.simd_into(simd);
            let mut front = theirs;
            if order == Order::ByDepth {
                let before = self.depth.behind(simd, &other.depth);
                front = theirs * before.share;
                let both = share * theirs;
                in_doubt += before.doubt * both;
                // Both meet this edge; it counts once.
                if self.position < other.position {
                    seams.add(before.ambiguity(simd) * both, before.doubt * both);
                }
                for (hidden, moment) in hidden.iter_mut().zip(before.moments) {
                    *hidden += moment * theirs;
                }
            }
            for (axis, hidden) in hidden.iter_mut().enumerate() {
                let moment: f64x8<S> = other.moments[axis].simd_into(simd);
                let is_front = front.simd_ge(theirs);
                *hidden += is_front.select(moment, zero);
            }
            open *= one - front;
            if order == Order::Behind {
                unhidden *= one - front;
            }
        }
        let ambiguity: f64x8<S> = self.ambiguity.simd_into(simd);
        let doubt: f64x8<S> = self.doubt.simd_into(simd);
        // However little is open of a box, edges may all lie in it.
        let is_open = open.simd_gt(zero);
        edges.add(is_open.select(ambiguity, zero), doubt * open);
        let is_unhidden = unhidden.simd_gt(zero);
        edges.sum += is_unhidden.select(seams.sum, zero);
        edges.most = edges.most.max(is_unhidden.select(seams.most, zero));
        edges.doubt += seams.doubt * unhidden;
        let seen = share * open;
        let by_seen = one / seen.max(f64x8::splat(simd, LEAST_SHARE));
        let half = f64x8::splat(simd, 0.5);
        let mut place = [zero; 2];
        for (axis, place) in place.iter_mut().enumerate() {
            let moment: f64x8<S> = self.moments[axis].simd_into(simd);
            let inward: f64x8<S> = self.inward[axis].simd_into(simd);
            let middle = (moment * open - hidden[axis] * share) * by_seen + inward;
            *place = middle.max(-half).min(half);
        }
        Visible {
            position: self.position,
            share: seen,
            place,
            is_cut: share.simd_lt(one),
            is_possible: (seen + doubt * open + in_doubt * unhidden).simd_gt(zero),
        }
    }

    /// The shares of boxes outside of the sphere.
    #[inline(always)]
    pub(super) fn outside<S: Simd>(&self, simd: S) -> f64x8<S> {
        let share: f64x8<S> = self.share.simd_into(simd);
        f64x8::splat(simd, 1.0) - share
    }
}

/// Shares below this have no place of their own.
const LEAST_SHARE: f64 = 1e-6;
