//! The parts of boxes that shadows leave.

use fearless_simd::Simd;

use super::half_plane::HalfPlane;
use super::projected::Projected;
use super::region::Region;
use super::surroundings::Surroundings;
use crate::edges::shadow::Caster;
use crate::exact::scene::Light;
use crate::numeric::lanes::{f64x8, mask64x8};

/// The part of a region that casters leave to a light.
#[derive(Clone, Copy, Debug)]
pub(super) struct Left<S: Simd> {
    pub(super) region: Region<S>,
    /// The error of its share because edges of shadows are no lines.
    pub(super) doubt: f64x8<S>,
    /// The boxes that no shadow touches.
    pub(super) is_free: mask64x8<S>,
}

impl<S: Simd> Surroundings<S> {
    /// The part of a region that casters leave to a light.
    #[inline(always)]
    pub(super) fn left_by(
        &self,
        simd: S,
        light: &Light,
        casters: &[Caster],
        region: &Region<S>,
    ) -> Left<S> {
        let zero = f64x8::splat(simd, 0.0);
        let one = f64x8::splat(simd, 1.0);
        let whole = HalfPlane::whole(simd);
        let mut left = Left {
            region: *region,
            doubt: zero,
            is_free: one.simd_gt(zero),
        };
        if casters.is_empty() {
            return left;
        }
        let seen = Projected::new(simd, self, light);
        let deepest = f64x8::splat(simd, DEEPEST);
        for caster in casters {
            let (middle, across, bends) = seen.depth_in(light, caster);
            let bend = (seen.more * caster.radius + seen.moved_sq) * seen.further;
            let foot = foot(simd, middle, across);
            // The caster is above the points, or above those at the edge where these are outside of its disc.
            let [x, y] = seen.height_across;
            let at_foot = seen.height + x * foot[0] + y * foot[1];
            let is_inside = middle.simd_gt(zero);
            let top = caster.center.dot(light.toward);
            let above = is_inside.select(seen.height, at_foot).simd_lt(top);
            // What is above elsewhere in the box may be dark.
            let may_be = (seen.height - seen.of_box).simd_lt(top);
            if (above | may_be).to_bitmask() == 0 {
                continue;
            }
            let width = across[0].abs() + across[1].abs();
            let rest = seen.rest * (2.0 * caster.radius);
            let most = width * 0.5 + (bend * 2.0).max(bend + rest);
            if middle.abs().simd_lt(most).to_bitmask() == 0 {
                // No edge is near.
                let is_dark = above & is_inside;
                left.region.darken(simd, is_dark);
                left.is_free &= !is_dark;
                continue;
            }
            let part = HalfPlane::of_second_degree(
                simd,
                middle,
                across,
                &bends,
                Some(bend * seen.third * CAUTION),
            );
            let hidden = above.select(zero, part.share);
            // An edge that second derivatives do not see in the box may cross it beside the silhouette.
            let is_one = part.share.simd_le(zero) | part.share.simd_ge(one);
            let within = (most - middle.abs()).max(zero) / (seen.depth * (2.0 * caster.radius));
            let within = within.min(deepest);
            let beside = is_one.select(within * within * 0.5, zero);
            let doubt = may_be.select(part.doubt.max(beside) + hidden, zero);
            let mut remaining = whole.or(above, &part.other_side(simd));
            remaining.doubt = doubt;
            left.is_free &= remaining.share.simd_ge(one) & doubt.simd_le(zero);
            left.doubt += doubt;
            left.region.cut(simd, &remaining);
        }
        left.doubt = left.doubt.min(left.region.most);
        left
    }
}

/// The factor on the third derivatives of shadows' edges, of which corners of boxes tell little: one in thousands
/// was off by three times as much.
const CAUTION: f64 = 4.0;

/// The share of a root at its end that second derivatives leave: its value in the middle is 1.
const DEEPEST: f64 = 0.375;

/// The way in sides of a box from its middle along the gradient to where a linear function vanishes, as far as that
/// lies in the box.
#[inline(always)]
fn foot<S: Simd>(simd: S, value: f64x8<S>, across: [f64x8<S>; 2]) -> [f64x8<S>; 2] {
    let tiny = f64x8::splat(simd, f64::MIN_POSITIVE);
    let half = f64x8::splat(simd, 0.5);
    let steep = across[0] * across[0] + across[1] * across[1];
    // Where it has no gradient it does not vanish.
    let step = steep
        .simd_gt(tiny)
        .select(value * -1.0 / steep, f64x8::splat(simd, 0.0));
    [
        (across[0] * step).max(-half).min(half),
        (across[1] * step).max(-half).min(half),
    ]
}
