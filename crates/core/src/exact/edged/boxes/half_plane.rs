//! The part of a box on one side of a line.

use fearless_simd::Simd;

use super::eight_boxes::Eight;
use crate::numeric::lanes::{f64x8, mask64x8};

/// The parts of eight boxes in which linear functions are positive.
#[derive(Clone, Copy, Debug)]
pub(super) struct HalfPlane<S: Simd> {
    /// The functions in the middles of the boxes, and their changes across the boxes, the larger of which is ±1.
    pub(super) value: f64x8<S>,
    pub(super) across: [f64x8<S>; 2],
    /// Their shares of the boxes.
    pub(super) share: f64x8<S>,
    /// The integrals over them of the coordinates from the middle of a box, in its sides.
    pub(super) moments: [f64x8<S>; 2],
    /// The error of the shares, for functions that are not quite linear.
    pub(super) doubt: f64x8<S>,
}

/// Half-planes in memory.
#[derive(Clone, Copy, Debug)]
pub(super) struct StoredHalfPlane {
    value: Eight,
    across: [Eight; 2],
    share: Eight,
    moments: [Eight; 2],
    pub(super) doubt: Eight,
}

impl StoredHalfPlane {
    #[inline(always)]
    pub(super) fn new<S: Simd>(part: &HalfPlane<S>) -> Self {
        Self {
            value: part.value.into(),
            across: [part.across[0].into(), part.across[1].into()],
            share: part.share.into(),
            moments: [part.moments[0].into(), part.moments[1].into()],
            doubt: part.doubt.into(),
        }
    }

    #[inline(always)]
    pub(super) fn load<S: Simd>(&self, simd: S) -> HalfPlane<S> {
        HalfPlane {
            value: f64x8::from_array(simd, self.value),
            across: [
                f64x8::from_array(simd, self.across[0]),
                f64x8::from_array(simd, self.across[1]),
            ],
            share: f64x8::from_array(simd, self.share),
            moments: [
                f64x8::from_array(simd, self.moments[0]),
                f64x8::from_array(simd, self.moments[1]),
            ],
            doubt: f64x8::from_array(simd, self.doubt),
        }
    }
}

/// The data that do not change along the lines: the larger and the smaller change of the function across the box,
/// and the reciprocals of both.
#[derive(Clone, Copy, Debug)]
pub(super) struct Slopes<S: Simd> {
    pub(super) large: f64x8<S>,
    pub(super) small: f64x8<S>,
    pub(super) by_large: f64x8<S>,
    pub(super) by_small: f64x8<S>,
    /// The reciprocal of the sum of the squares of both.
    pub(super) by_size_sq: f64x8<S>,
}

/// The smaller change across the box counts as no less than this share of the larger one, which moves the
/// share by less than that.
const LEAST_SLOPE: f64 = 1e-9;

/// The larger change counts as no less than this, so that products of four have reciprocals.
const LEAST_CHANGE: f64 = 1e-70;

/// The average along an edge, over the largest in the corners, of what makes a function differ from a linear one. A
/// parabola across the edge is two thirds of that on a line near the side of the box, and less elsewhere.
const ON_AVERAGE: f64 = 2.0 / 3.0;

impl<S: Simd> Slopes<S> {
    #[inline(always)]
    pub(super) fn new(simd: S, [x, y]: [f64x8<S>; 2]) -> Self {
        let one = f64x8::splat(simd, 1.0);
        let (x, y) = (x.abs(), y.abs());
        let large = x.max(y).max(f64x8::splat(simd, LEAST_CHANGE));
        let small = x.min(y).max(large * LEAST_SLOPE);
        let large_sq = large * large;
        let size_sq = large_sq + small * small;
        // One division for all.
        let by_all = one / (large * small * size_sq);
        let by_sides = by_all * size_sq;
        Self {
            large,
            small,
            by_large: by_sides * small,
            by_small: by_sides * large,
            by_size_sq: by_all * large * small,
        }
    }
}

impl<S: Simd> HalfPlane<S> {
    /// The half-plane of functions with these values in the middles and these changes across the boxes, which differ by no more
    /// than `bend` from functions that are not linear.
    ///
    /// # Source
    /// With D the size of the value and a ≥ c the sizes of the changes, the smaller part is a triangle with the
    /// share e² / (2 a c), e = (a + c) / 2 − D, or a trapezoid with the share ½ − D / a where D < (a − c) / 2. The
    /// moments are the derivatives of the integral of the function over the part, by a and by c.
    #[inline(always)]
    pub(super) fn new(simd: S, value: f64x8<S>, across: [f64x8<S>; 2], bend: f64x8<S>) -> Self {
        Self::of_slopes(simd, &Slopes::new(simd, across), value, across, bend)
    }

    /// The same, with what is known of the changes.
    #[inline(always)]
    pub(super) fn of_slopes(
        simd: S,
        &Slopes {
            large,
            small,
            by_large,
            by_small,
            ..
        }: &Slopes<S>,
        value: f64x8<S>,
        [x, y]: [f64x8<S>; 2],
        bend: f64x8<S>,
    ) -> Self {
        let zero = f64x8::splat(simd, 0.0);
        let one = f64x8::splat(simd, 1.0);
        let distance = value.abs();
        let rest = (large + small) * 0.5 - distance;
        let inside = rest.max(zero).min(small);
        let is_corner = rest.simd_lt(small);
        let corner = inside * inside * (by_large * by_small) * 0.5;
        let part = is_corner.select(corner, distance * by_large * -1.0 + 0.5);
        let share = value.simd_ge(zero).select(one - part, part);

        let ratio = distance * by_large;
        let thin = small * by_large;
        let along_large = is_corner.select(
            corner * 0.5 * (one - inside * by_large * (2.0 / 3.0)),
            ratio * ratio * -0.5 - thin * thin * (1.0 / 24.0) + 0.125,
        );
        let along_small = is_corner.select(
            corner * 0.5 * (one - inside * by_small * (2.0 / 3.0)),
            thin * (1.0 / 12.0),
        );
        let is_x_large = x.abs().simd_ge(y.abs());
        let moment_x = is_x_large.select(along_large, along_small);
        let moment_y = is_x_large.select(along_small, along_large);

        let reach = (rest + bend).max(zero);
        let density = (reach * by_small).min(one) * by_large;
        Self {
            value: value * by_large,
            across: [x * by_large, y * by_large],
            share,
            moments: [
                x.simd_lt(zero).select(-moment_x, moment_x),
                y.simd_lt(zero).select(-moment_y, moment_y),
            ],
            doubt: (density * bend * ON_AVERAGE).min(one),
        }
    }

    /// Whole boxes.
    #[inline(always)]
    pub(super) fn whole(simd: S) -> Self {
        let zero = f64x8::splat(simd, 0.0);
        let one = f64x8::splat(simd, 1.0);
        Self {
            value: one,
            across: [zero; 2],
            share: one,
            moments: [zero; 2],
            doubt: zero,
        }
    }

    /// The share of the smaller part.
    #[inline(always)]
    pub(super) fn ambiguity(&self, simd: S) -> f64x8<S> {
        let one = f64x8::splat(simd, 1.0);
        self.share.min(one - self.share)
    }

    /// The other side of the line.
    #[inline(always)]
    pub(super) fn other_side(&self, simd: S) -> Self {
        let one = f64x8::splat(simd, 1.0);
        Self {
            value: -self.value,
            across: [-self.across[0], -self.across[1]],
            share: one - self.share,
            moments: [-self.moments[0], -self.moments[1]],
            doubt: self.doubt,
        }
    }

    /// How far the line may be off along its larger change, in sides, to be in doubt as it is.
    #[inline(always)]
    pub(super) fn bend(&self, simd: S) -> f64x8<S> {
        let zero = f64x8::splat(simd, 0.0);
        let small = self.across[0].abs().min(self.across[1].abs());
        let rest = (small * 0.5 + 0.5 - self.value.abs()).max(zero);
        // The doubt is ON_AVERAGE · bend, times (rest + bend) / small where the line cuts off a corner.
        let whole = self.doubt * (1.0 / ON_AVERAGE);
        let corner = ((rest * rest + whole * small * 4.0).sqrt() - rest) * 0.5;
        whole.max(corner)
    }

    /// The line moved outward by this, in sides, or a little more; its share and moments are left as they are.
    #[inline(always)]
    pub(super) fn grown(&self, outward: f64x8<S>) -> Self {
        let [x, y] = self.across;
        Self {
            value: self.value + outward * (x.abs() + y.abs()),
            ..*self
        }
    }

    /// Another where the mask says so.
    #[inline(always)]
    pub(super) fn or(&self, mask: mask64x8<S>, other: &Self) -> Self {
        Self {
            value: mask.select(other.value, self.value),
            across: [
                mask.select(other.across[0], self.across[0]),
                mask.select(other.across[1], self.across[1]),
            ],
            share: mask.select(other.share, self.share),
            moments: [
                mask.select(other.moments[0], self.moments[0]),
                mask.select(other.moments[1], self.moments[1]),
            ],
            doubt: mask.select(other.doubt, self.doubt),
        }
    }
}

/// The averages over boxes of linear functions with these values in the middles and these changes across the
/// boxes, where they are positive, and of 0 elsewhere.
#[inline(always)]
pub(crate) fn ramp<S: Simd>(simd: S, value: f64x8<S>, across: [f64x8<S>; 2]) -> f64x8<S> {
    let zero = f64x8::splat(simd, 0.0);
    let Slopes {
        large,
        small,
        by_large,
        by_small,
        ..
    } = Slopes::new(simd, across);
    let distance = value.abs();
    let rest = (large + small) * 0.5 - distance;
    let inside = rest.max(zero).min(small);
    let corner = inside * inside * inside * (by_large * by_small) * (1.0 / 6.0);
    let middle = (distance * distance * 0.5 + small * small * (1.0 / 24.0)) * by_large
        + large * 0.125
        - distance * 0.5;
    rest.simd_lt(small).select(corner, middle) + value.max(zero)
}

#[cfg(test)]
mod tests;
