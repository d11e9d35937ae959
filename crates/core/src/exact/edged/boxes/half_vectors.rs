//! The half vectors between lights and the eye in boxes: they turn as rays do, also where normals do not.
//!
//! With v = −d / |d| and L = |l + v|, n·h = (n·l + n·v) / L. Where the ray d moves by e, v moves by
//! v' = (v (v·e) − e) / |d|, and L by l·v' / L. The half vector turns by |v'| / L at most.

use fearless_simd::Simd;
use glam::DVec3;

use super::normals::Normals;
use super::surroundings::{OF_SECOND, Surroundings};
use crate::light::reflection::ViewedPoints;
use crate::numeric::lanes::f64x8;
use crate::numeric::vectors::Vectors;

/// The directions toward the eye in boxes, which turn with rays: the same for all lights.
#[derive(Clone, Copy, Debug)]
pub(super) struct Views<S: Simd> {
    view: Vectors<S>,
    across: [Vectors<S>; 2],
    /// n·v, and how it changes across boxes.
    cosine: f64x8<S>,
    cosine_across: [f64x8<S>; 2],
    /// The angle by which they turn across a box, and the diagonal of a box over the length of its ray.
    turn: f64x8<S>,
    diagonal: f64x8<S>,
}

/// n·h of a light in boxes.
#[derive(Clone, Copy, Debug)]
pub(super) struct HalfCosines<S: Simd> {
    /// In the middles of what is lit, and how they change across.
    pub(super) cosine: f64x8<S>,
    pub(super) across: [f64x8<S>; 2],
    /// The angle by which normals and half vectors turn toward each other across a box.
    pub(super) turn: f64x8<S>,
    /// The change of the average by second derivatives.
    pub(super) second: f64x8<S>,
}

/// The least |l + v| that is divided by. Where it is less, the eye looks along the light, which reaches contours alone.
const LEAST_LENGTH: f64 = 1e-3;

/// The factor on |h'|² for what it adds to |h''|, where |l + v| changes with it.
const OF_LENGTH: f64 = 1.5;

impl<S: Simd> Views<S> {
    #[inline(always)]
    pub(super) fn new(simd: S, around: &Surroundings<S>, normals: &Normals<S>) -> Self {
        let one = f64x8::splat(simd, 1.0);
        let [width, height] = around.sides;
        let by_length = one / around.points.ray_sq.sqrt();
        let view = around.points.ray.times(-by_length);
        let [by_x, by_y] = [by_length * width, by_length * height];
        let mut x = view.times(view.x * by_x);
        x.x -= by_x;
        let mut y = view.times(view.y * by_y);
        y.y -= by_y;
        let normal = &normals.normal;
        let cosine_across = [
            normals.across[0].dot(&view) + normal.dot(&x),
            normals.across[1].dot(&view) + normal.dot(&y),
        ];
        Self {
            cosine: normal.dot(&view),
            cosine_across,
            turn: (x.length_squared() + y.length_squared()).sqrt(),
            diagonal: by_length * (width * width + height * height).sqrt(),
            across: [x, y],
            view,
        }
    }
}

impl<S: Simd> HalfCosines<S> {
    /// The cosines of no highlight.
    #[inline(always)]
    pub(super) fn nothing(simd: S) -> Self {
        let zero = f64x8::splat(simd, 0.0);
        Self {
            cosine: zero,
            across: [zero; 2],
            turn: zero,
            second: zero,
        }
    }

    /// The cosines of a light that surfaces face by `cosine`, where directions toward the eye count as still; `aside` leads from the
    /// points to the middles of what is lit, in sides.
    #[inline(always)]
    pub(super) fn of_still_views(
        (viewed, normals): (&ViewedPoints<'_, S>, &Normals<S>),
        toward: DVec3,
        cosine: f64x8<S>,
        aside: [f64x8<S>; 2],
    ) -> Self {
        let mut half_cosine = viewed.half_cosine(toward, cosine);
        let mut across = [half_cosine; 2];
        for axis in 0..2 {
            across[axis] = viewed.change_of_half_cosine(toward, &normals.across[axis]);
            half_cosine += across[axis] * aside[axis];
        }
        Self {
            cosine: half_cosine,
            across,
            turn: normals.turn_sq.sqrt(),
            second: normals.second,
        }
    }

    /// The same where they turn.
    ///
    /// # Accuracy
    /// Second derivatives are bounded by |n''| + 2 |n'| |h'| + |h''|, with |v''| ≤ 2 |v'| |e| / |d|. What could fool that
    /// is a box across which normals and half vectors turn so far that terms of higher degree count: the highlight's
    /// highest value limits its error there.
    #[inline(always)]
    pub(super) fn of_views(
        simd: S,
        (views, normals): (&Views<S>, &Normals<S>),
        toward: DVec3,
        cosine: f64x8<S>,
        aside: [f64x8<S>; 2],
    ) -> Self {
        let least = f64x8::splat(simd, LEAST_LENGTH * LEAST_LENGTH);
        let length_sq = (views.view.dot_one(toward) * 2.0 + 2.0).max(least);
        let by_length = f64x8::splat(simd, 1.0) / length_sq.sqrt();
        let mut half_cosine = (cosine + views.cosine) * by_length;
        let at_point = half_cosine * by_length;
        let mut across = [half_cosine; 2];
        for axis in 0..2 {
            let of_sum = normals.across[axis].dot_one(toward) + views.cosine_across[axis];
            let of_length = views.across[axis].dot_one(toward);
            across[axis] = (of_sum - at_point * of_length) * by_length;
            half_cosine += across[axis] * aside[axis];
        }
        let turn = normals.turn_sq.sqrt();
        let of_half = views.turn * by_length;
        let bent = (turn + views.diagonal) * 2.0 + of_half * OF_LENGTH;
        Self {
            cosine: half_cosine,
            across,
            turn: turn + of_half,
            second: normals.second + of_half * bent * OF_SECOND,
        }
    }
}
