//! The part of a box on one side of a line.

use fearless_simd::f64x8;
use fearless_simd::prelude::*;

/// The parts of eight boxes in which linear functions are positive.
#[derive(Clone, Copy, Debug)]
pub(super) struct HalfPlane<S: Simd> {
    /// Their shares of the boxes.
    pub(super) share: f64x8<S>,
    /// The integrals over them of the coordinates from the middle of a box, in its sides.
    pub(super) moments: [f64x8<S>; 2],
    /// How much the shares of functions may differ that are not quite linear.
    pub(super) doubt: f64x8<S>,
}

/// What does not change along the lines: the larger and the smaller change of the function across the box,
/// and the reciprocals of both.
#[derive(Clone, Copy, Debug)]
struct Slopes<S: Simd> {
    large: f64x8<S>,
    small: f64x8<S>,
    by_large: f64x8<S>,
    by_small: f64x8<S>,
}

/// The smaller change across the box counts as no less than this share of the larger one, which moves the
/// share by less than that.
const LEAST_SLOPE: f64 = 1e-9;

/// The average along an edge, over the largest in the corners, of what makes a function differ from a linear one. A
/// parabola across the edge is two thirds of that on a line near the side of the box, and less elsewhere.
const ON_AVERAGE: f64 = 2.0 / 3.0;

impl<S: Simd> Slopes<S> {
    #[inline(always)]
    fn new(simd: S, [x, y]: [f64x8<S>; 2]) -> Self {
        let one = f64x8::splat(simd, 1.0);
        let (x, y) = (x.abs(), y.abs());
        let large = x.max(y).max(f64x8::splat(simd, f64::MIN_POSITIVE));
        let small = x.min(y).max(large * LEAST_SLOPE);
        Self {
            large,
            small,
            by_large: one / large,
            by_small: one / small,
        }
    }
}

impl<S: Simd> HalfPlane<S> {
    /// Of functions with these values in the middles and these changes across the boxes, which differ by no more
    /// than `bend` from functions that are not linear.
    ///
    /// # Source
    /// With D the size of the value and a ≥ c the sizes of the changes, the smaller part is a triangle with the
    /// share e² / (2 a c), e = (a + c) / 2 − D, or a trapezoid with the share ½ − D / a where D < (a − c) / 2. The
    /// moments are the derivatives of the integral of the function over the part, by a and by c.
    #[inline(always)]
    pub(super) fn new(simd: S, value: f64x8<S>, [x, y]: [f64x8<S>; 2], bend: f64x8<S>) -> Self {
        let zero = f64x8::splat(simd, 0.0);
        let one = f64x8::splat(simd, 1.0);
        let slopes = Slopes::new(simd, [x, y]);
        let Slopes {
            large,
            small,
            by_large,
            by_small,
        } = slopes;
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
            share,
            moments: [
                x.simd_lt(zero).select(-moment_x, moment_x),
                y.simd_lt(zero).select(-moment_y, moment_y),
            ],
            doubt: (density * bend * ON_AVERAGE).min(one),
        }
    }

    /// The same of functions that are not linear: `second` is what their second derivative adds where linear ones vanish,
    /// straight along their gradients.
    ///
    /// Along the gradient a function is g + g' s + a s², with a s² = `second` at s = −g / g'. Its root is known, and its
    /// slope there is g' √(1 − 4 a g / g'²). The edge bends to the sides alone, more where the slope is less.
    #[inline(always)]
    pub(super) fn of_second_degree(
        simd: S,
        value: f64x8<S>,
        across: [f64x8<S>; 2],
        (second, bend): (f64x8<S>, f64x8<S>),
    ) -> Self {
        /// What is left of the bend when the edge is followed along the gradient.
        const TO_THE_SIDES: f64 = 0.5;
        let one = f64x8::splat(simd, 1.0);
        let tiny = f64x8::splat(simd, f64::MIN_POSITIVE);
        let is_known = value.abs().simd_gt(tiny);
        let ratio = is_known.select(second / value, tiny);
        let slope = (one - ratio * 4.0).max(tiny).sqrt();
        let straight = value * 2.0 / (slope + 1.0);
        let bend = bend * TO_THE_SIDES / slope.min(one);
        Self::new(simd, straight, across, bend)
    }

    /// Where the edge is in doubt or divides the box: the share of the smaller part.
    #[inline(always)]
    pub(super) fn ambiguity(&self, simd: S) -> f64x8<S> {
        let one = f64x8::splat(simd, 1.0);
        self.share.min(one - self.share) + self.doubt
    }
}

/// The averages over boxes of linear functions with these values in the middles and these changes across the
/// boxes, where they are positive, and of 0 elsewhere.
#[inline(always)]
pub(super) fn ramp<S: Simd>(simd: S, value: f64x8<S>, across: [f64x8<S>; 2]) -> f64x8<S> {
    let zero = f64x8::splat(simd, 0.0);
    let Slopes {
        large,
        small,
        by_large,
        by_small,
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
