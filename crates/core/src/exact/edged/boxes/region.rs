//! The parts of boxes inside of several half-planes.

use fearless_simd::Simd;

use super::half_plane::HalfPlane;
use super::wedge::intersection;
use crate::numeric::lanes::{f64x8, mask64x8};

/// Half-planes that leave less of a box, or take less from it, do not cut it.
const LEAST_AMBIGUITY: f64 = 1e-9;

/// The share of what edges may hide of each other that counts, as a part of the contrast: what one region gains another
/// loses.
pub(super) const OF_AMBIGUITY: f64 = 0.5;

/// The intersection of several half-planes. The two that cut a box most evenly are known by their lines, so that their
/// intersection is; the shares of the others are multiplied.
#[derive(Clone, Copy, Debug)]
pub(super) struct Region<S: Simd> {
    first: HalfPlane<S>,
    second: HalfPlane<S>,
    /// The smaller of what is on both sides of the two lines; 0 without a line.
    ambiguities: [f64x8<S>; 2],
    /// The share that the others leave, as if they were independent of each other and of the lines; no more than the
    /// least of their shares, and all without what they take away together.
    rest: f64x8<S>,
    least: f64x8<S>,
    taken: f64x8<S>,
    /// The largest share that it may have, if edges are no lines.
    pub(super) most: f64x8<S>,
}

/// A share of a box, and the integrals over it of the coordinates from the middle of the box, in sides.
#[derive(Clone, Copy, Debug)]
pub(super) struct Share<S: Simd> {
    pub(super) area: f64x8<S>,
    pub(super) moments: [f64x8<S>; 2],
    /// The error of the area because shares were multiplied: a bound, if edges are lines.
    pub(super) ambiguity: f64x8<S>,
}

impl<S: Simd> Region<S> {
    /// Whole boxes.
    #[inline(always)]
    pub(super) fn whole(simd: S) -> Self {
        let zero = f64x8::splat(simd, 0.0);
        let one = f64x8::splat(simd, 1.0);
        let whole = HalfPlane::whole(simd);
        Self {
            first: whole,
            second: whole,
            ambiguities: [zero; 2],
            rest: one,
            least: one,
            taken: zero,
            most: one,
        }
    }

    /// Leaves only what is inside of a half-plane, too.
    #[inline(always)]
    pub(super) fn cut(&mut self, simd: S, part: &HalfPlane<S>) {
        self.most = self.most.min(part.share + part.doubt);
        let ambiguity = part.ambiguity(simd);
        let is_cut = ambiguity.simd_gt(LEAST_AMBIGUITY);
        if is_cut.to_bitmask() == 0 {
            self.leave(simd, part.share);
            return;
        }
        let [first, second] = self.ambiguities;
        let lesser = first.min(second);
        let is_first = first.simd_le(second);
        let is_new = is_cut & ambiguity.simd_gt(lesser);
        let of_lesser = is_first.select(self.first.share, self.second.share);
        // What was known by its line is multiplied from now on, or what is new is.
        self.leave(simd, is_new.select(of_lesser, part.share));
        let is_second = is_new & !is_first;
        let is_first = is_new & is_first;
        self.first = self.first.or(is_first, part);
        self.second = self.second.or(is_second, part);
        self.ambiguities = [
            is_first.select(ambiguity, first),
            is_second.select(ambiguity, second),
        ];
    }

    /// Leaves this share of what is left.
    #[inline(always)]
    fn leave(&mut self, simd: S, share: f64x8<S>) {
        self.rest *= share;
        self.least = self.least.min(share);
        self.taken += f64x8::splat(simd, 1.0) - share;
    }

    /// Takes away what is inside of both of two half-planes whose lines cut a box; of others this is a half-plane: see
    /// [`HalfPlane::left_by_both`].
    #[inline(always)]
    pub(super) fn leave_of_both(&mut self, simd: S, one: &HalfPlane<S>, other: &HalfPlane<S>) {
        let is_cut_twice = one.is_cut(simd) & other.is_cut(simd);
        if is_cut_twice.to_bitmask() == 0 {
            return;
        }
        let full = f64x8::splat(simd, 1.0);
        let zero = f64x8::splat(simd, 0.0);
        let left = full - one.share * other.share;
        self.rest *= is_cut_twice.select(left, full);
        // They have no less in common than what makes them more than the box, and no more than the smaller of them.
        let common = (one.share + other.share - full).max(zero);
        let least = is_cut_twice.select(full - common, full);
        self.least = self.least.min(least);
        self.taken += is_cut_twice.select(one.share.min(other.share), zero);
    }

    /// Leaves nothing of some boxes.
    #[inline(always)]
    pub(super) fn darken(&mut self, simd: S, boxes: mask64x8<S>) {
        let zero = f64x8::splat(simd, 0.0);
        self.rest = boxes.select(zero, self.rest);
        self.least = boxes.select(zero, self.least);
        self.most = boxes.select(zero, self.most);
    }

    /// The boxes that two lines cut.
    #[inline(always)]
    fn has_both(&self) -> mask64x8<S> {
        let [first, second] = self.ambiguities;
        first.min(second).simd_gt(0.0)
    }

    /// Its share of the boxes.
    #[inline(always)]
    pub(super) fn share(&self, simd: S) -> Share<S> {
        let mut area = self.first.share * self.second.share;
        let mut moments = [
            self.first.moments[0] + self.second.moments[0],
            self.first.moments[1] + self.second.moments[1],
        ];
        let has_both = self.has_both();
        if has_both.to_bitmask() != 0 {
            let (both, of_both) = intersection(simd, &self.first, &self.second);
            let least = self.first.share.min(self.second.share);
            let both = both.min(least).max(f64x8::splat(simd, 0.0));
            area = has_both.select(both, area);
            for (moment, of_both) in moments.iter_mut().zip(of_both) {
                *moment = has_both.select(of_both, *moment);
            }
        }
        // What is left lies between what all leave at least and the smallest of them.
        let product = area * self.rest;
        let zero = f64x8::splat(simd, 0.0);
        let above = area.min(self.least) - product;
        let below = product - (area - self.taken).max(zero);
        Share {
            area: product,
            moments: [moments[0] * self.rest, moments[1] * self.rest],
            ambiguity: above.max(below).max(zero),
        }
    }
}

impl<S: Simd> HalfPlane<S> {
    /// The boxes that its line cuts.
    #[inline(always)]
    fn is_cut(&self, simd: S) -> mask64x8<S> {
        self.ambiguity(simd).simd_gt(LEAST_AMBIGUITY)
    }

    /// What is not inside of both of two half-planes, where one line cuts a box; all where both do.
    #[inline(always)]
    pub(super) fn left_by_both(&self, simd: S, other: &Self) -> Self {
        let is_filled = self.share.simd_gt(0.5) & !self.is_cut(simd);
        let is_filled_too = other.share.simd_gt(0.5) & !other.is_cut(simd);
        let mut left = Self::whole(simd)
            .or(is_filled_too, &self.other_side(simd))
            .or(is_filled, &other.other_side(simd));
        // One that seems to fill a box may not.
        left.doubt = self.doubt + other.doubt;
        left
    }
}

impl<S: Simd> Share<S> {
    /// The middle of what it is a share of, or of the box where that is next to nothing.
    #[inline(always)]
    pub(super) fn middle(&self, simd: S) -> [f64x8<S>; 2] {
        /// Shares below this have no place of their own.
        const LEAST_SHARE: f64 = 1e-6;
        let half = f64x8::splat(simd, 0.5);
        let by_area = f64x8::splat(simd, 1.0) / self.area.max(f64x8::splat(simd, LEAST_SHARE));
        [
            (self.moments[0] * by_area).max(-half).min(half),
            (self.moments[1] * by_area).max(-half).min(half),
        ]
    }
}

#[cfg(test)]
mod tests;
