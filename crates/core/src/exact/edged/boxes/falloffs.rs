//! The averages of powers of cosines over boxes.

use fearless_simd::Simd;
use glam::DVec3;

use super::half_plane::{HalfPlane, ramp};
use super::half_vectors::HalfCosines;
use super::normals::Normals;
use super::surroundings::OF_SECOND;
use crate::exact::surface::Finish;
use crate::numeric::lanes::{f64x8, mask64x8};

/// The cosines toward a light in boxes: in the middles of what is lit, and how they change across.
#[derive(Clone, Copy, Debug)]
pub(super) struct Faced<S: Simd> {
    pub(super) cosine: f64x8<S>,
    pub(super) across: [f64x8<S>; 2],
    /// Half of the most that they change.
    pub(super) width: f64x8<S>,
    /// The contribution of their second derivatives to their average over what is lit, and the error of the average with it.
    pub(super) bend: f64x8<S>,
    pub(super) error: f64x8<S>,
}

/// A power of cosines, over boxes.
#[derive(Clone, Copy, Debug)]
pub(super) struct Power<S: Simd> {
    /// The average, about the highest value, and the error of the average.
    pub(super) value: f64x8<S>,
    pub(super) most: f64x8<S>,
    pub(super) doubt: f64x8<S>,
    /// The largest difference from the average next to an edge.
    pub(super) spread: f64x8<S>,
    /// The light that may be hidden or seen together, where the light ends in the box.
    pub(super) ambiguity: f64x8<S>,
}

impl<S: Simd> Faced<S> {
    /// The cosines of these at points and their changes across boxes, where the middles of what is lit are known; and
    /// the ways from the points to those, in sides. `offset` leads from the middles of boxes to the points, `inward` from
    /// the middles of what is lit to where the average is.
    #[inline(always)]
    pub(super) fn new(
        simd: S,
        normals: &Normals<S>,
        toward: DVec3,
        (cosine, across): (f64x8<S>, [f64x8<S>; 2]),
        [offset, middle, inward]: [[f64x8<S>; 2]; 3],
    ) -> (Self, [f64x8<S>; 2]) {
        let zero = f64x8::splat(simd, 0.0);
        let one = f64x8::splat(simd, 1.0);
        let half = f64x8::splat(simd, 0.5);
        let mut aside = [zero; 2];
        // A slab with its middle so far from that of the box has this share of the variance of the box.
        let mut variances = [zero; 2];
        for axis in 0..2 {
            let extent = one - middle[axis].abs() * 2.0;
            variances[axis] = extent * extent;
            let place = (middle[axis] + inward[axis]).max(-half).min(half);
            aside[axis] = place - offset[axis];
        }
        let [xx, yy] = &normals.seconds;
        let bend =
            (xx.dot_one(toward) * variances[0] + yy.dot_one(toward) * variances[1]) * OF_SECOND;
        let third = normals.third * variances[0].max(variances[1]);
        let mut width = (across[0].abs() + across[1].abs()) * 0.5;
        if normals.is_rough {
            width += normals.bow;
        }
        let faced = Self {
            cosine: cosine + across[0] * aside[0] + across[1] * aside[1],
            across,
            width,
            bend: normals.is_bent.select(bend, zero),
            error: normals.is_bent.select(third, normals.second),
        };
        (faced, aside)
    }

    /// The boxes in which the surface turns from the light.
    #[inline(always)]
    fn is_cut(&self) -> mask64x8<S> {
        self.cosine.abs().simd_lt(self.width)
    }

    /// The diffuse falloff.
    #[inline(always)]
    pub(super) fn diffuse(&self, simd: S, finish: &Finish, normals: &Normals<S>) -> Power<S> {
        let zero = f64x8::splat(simd, 0.0);
        let one = f64x8::splat(simd, 1.0);
        let falloff = &finish.reflectance.diffuse;
        let exponent = falloff.exponent;
        let is_cut = self.is_cut();
        let highest = is_cut.select(self.cosine + self.width, self.cosine);
        if exponent == 1.0 {
            let mut value = (self.cosine + self.bend).max(zero);
            if is_cut.to_bitmask() != 0 {
                value = is_cut.select(ramp(simd, self.cosine, self.across), value);
            }
            // Normals of rays that miss may be longer than 1.
            let highest = highest + normals.second * OF_HIGHEST;
            let most = highest.max(zero).min(one);
            return Power {
                value: value.min(one),
                most,
                doubt: is_cut.select(normals.second, self.error).min(one),
                spread: self.width.min(one),
                ambiguity: is_cut.select((value - self.cosine.max(zero)) * OF_RAMP, zero),
            };
        }
        // e cᵉ⁻¹ c'' + e (e − 1) cᵉ⁻² c'²: where c is least for e below 1, where it is highest above.
        let tiny = f64x8::splat(simd, f64::MIN_POSITIVE);
        let width = if exponent < 1.0 {
            // Steep where it begins, which is to be known well: near silhouettes cosines are no linear functions.
            self.width + normals.bow
        } else {
            self.width
        };
        let is_cut = self.cosine.abs().simd_lt(width);
        let half = width * 0.5;
        let least = (self.cosine - half).max(half).max(tiny);
        let by_least = one / least;
        let bends = normals.second * by_least
            + normals.turn_sq * by_least * by_least * ((exponent - 1.0).abs() * OF_SECOND);
        let most = falloff.of(self.cosine + self.width + normals.bow);
        let power = if exponent < 1.0 {
            falloff.of(least)
        } else {
            most
        };
        let smooth = (power * bends * exponent).min(most);
        let value = falloff.of(self.cosine);
        Power {
            value,
            most,
            spread: most - value,
            doubt: is_cut.select(most, smooth),
            ambiguity: is_cut.select(most, zero),
        }
    }

    /// The falloff of the highlight, which ends where the surface turns from the light; for these cosines of the half
    /// vector.
    #[inline(always)]
    pub(super) fn shine(
        &self,
        simd: S,
        finish: &Finish,
        halves: &HalfCosines<S>,
        normals: &Normals<S>,
    ) -> Power<S> {
        let zero = f64x8::splat(simd, 0.0);
        let one = f64x8::splat(simd, 1.0);
        let nothing = Power {
            value: zero,
            most: zero,
            doubt: zero,
            spread: zero,
            ambiguity: zero,
        };
        let Some((_, falloff)) = &finish.reflectance.highlight else {
            return nothing;
        };
        let shininess = falloff.exponent;
        // The highest cosine in the box, by half of what normals and half vectors turn across it.
        let half_cosine = halves.cosine;
        let turn = halves.turn * HALF_TURN;
        let sine = (one - half_cosine * half_cosine).max(zero).sqrt();
        let nearest = (half_cosine + turn * sine + turn * turn).min(one);
        let most = falloff.of(nearest);
        // s cˢ⁻¹ c'' + s² cˢ⁻² c'², where c is highest, over cˢ.
        let mut turned = halves.turn * sine * shininess;
        let mut bent = halves.second * shininess;
        if shininess < NARROW {
            let by_cosine = one / nearest.max(f64x8::splat(simd, LEAST_COSINE));
            turned *= by_cosine;
            bent *= by_cosine;
        }
        let bends = bent + turned * turned * OF_SECOND;
        let doubt = (most * bends * CAUTION).min(most);
        let power = falloff.of(half_cosine);
        let is_cut = self.is_cut();
        if is_cut.to_bitmask() == 0 {
            let faces = self.cosine.simd_gt(zero);
            // Near a silhouette cosines go with a root, and may change their sign where linear functions do not.
            let may_turn = self.cosine.abs().simd_lt(self.width + normals.bow);
            let doubt = may_turn.select(most, doubt);
            let may_face = faces | may_turn;
            return Power {
                value: faces.select(power, zero),
                most: may_face.select(most, zero),
                spread: may_face.select(most - power, zero),
                doubt: may_face.select(doubt, zero),
                ambiguity: zero,
            };
        }
        // Half of the second derivative of normals, along half the diagonal.
        let bend = normals.second * (0.25 / OF_SECOND);
        let facing = HalfPlane::new(simd, self.cosine, self.across, bend);
        let is_faced = facing.share + facing.doubt;
        // That of the middle of the part that faces the light, which a highlight ends in unevenly.
        let by_share = one / facing.share.max(f64x8::splat(simd, LEAST_FACING));
        let [to_x, to_y] = facing.moments;
        let further = (halves.across[0] * to_x + halves.across[1] * to_y) * by_share;
        let power = falloff.of((half_cosine + further).min(one));
        Power {
            value: power * facing.share,
            most: is_faced.simd_gt(zero).select(most, zero),
            spread: zero,
            doubt: doubt * is_faced.min(one) + most * facing.doubt,
            ambiguity: facing.ambiguity(simd) * most,
        }
    }
}

/// The share of a ramp's addition to the light of its middle that may depend on the visible part of the box: all of it,
/// and as much again where the parts that are seen lie apart.
const OF_RAMP: f64 = 2.0;

/// The excess of a cosine over its linear function, over the error of the average: near silhouettes it is
/// the root of one.
const OF_HIGHEST: f64 = 4.0;

/// The least share of a box that its own middle is found of.
const LEAST_FACING: f64 = 1e-6;

/// The factor on the error of highlights: one pixel in millions was off by more without it.
const CAUTION: f64 = 1.5;

/// The shininess from which on highlights are nothing where cosines are not near 1.
const NARROW: f64 = 20.0;

/// The least cosine that a highlight's derivatives are divided by.
const LEAST_COSINE: f64 = 1e-3;

/// Half of the turn across a box, and a quarter more, as both axes may turn the same way.
const HALF_TURN: f64 = 0.625;
