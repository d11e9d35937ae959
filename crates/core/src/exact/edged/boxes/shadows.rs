//! The parts of boxes that shadows leave.

use fearless_simd::prelude::*;
use fearless_simd::{f64x8, mask64x8};

use super::bent::Bends;
use super::half_plane::HalfPlane;
use super::region::Region;
use super::surroundings::Surroundings;
use crate::edges::shadow::Caster;
use crate::exact::scene::Light;

/// The least of 1 − slide: boxes that see a plane up to its horizon are all in doubt.
const LEAST_REST: f64 = 1e-6;

/// What casters leave to a light of a region.
#[derive(Clone, Copy, Debug)]
pub(super) struct Left<S: Simd> {
    pub(super) region: Region<S>,
    /// How much its share may be off because edges of shadows are no lines.
    pub(super) doubt: f64x8<S>,
    /// The boxes that no shadow touches.
    pub(super) is_free: mask64x8<S>,
}

impl<S: Simd> Surroundings<S> {
    /// What casters leave to a light of a region.
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
        let half = f64x8::splat(simd, 0.5);
        let whole = HalfPlane::whole(simd);
        let mut left = Left {
            region: *region,
            doubt: zero,
            is_free: one.simd_gt(zero),
        };
        if casters.is_empty() {
            return left;
        }
        let right = self.place.dot_one(light.right);
        let up = self.place.dot_one(light.up);
        let height = self.place.dot_one(light.toward);
        let right_across = [
            self.across[0].dot_one(light.right),
            self.across[1].dot_one(light.right),
        ];
        let up_across = [
            self.across[0].dot_one(light.up),
            self.across[1].dot_one(light.up),
        ];
        let height_across = [
            self.across[0].dot_one(light.toward),
            self.across[1].dot_one(light.toward),
        ];
        // From the middle of a box to its corner a point moves by P', and by half of P'' more, which is |P'|² over the
        // radius and the cosine for the sphere, and twice the slide for the perspective.
        let moved_sq = self.turn_sq * (0.5 * self.radius * self.radius);
        // A plane is seen at t / (1 − slide) there: the series that ends with P'' converges as fast as that.
        let rest = (one - self.slide).max(f64x8::splat(simd, LEAST_REST));
        let further = one / (rest * rest);
        let more = moved_sq / (self.grazing * self.radius) + moved_sq.sqrt() * self.slide * 2.0;
        // Heights in a box differ by no more from that in its middle.
        let of_box = (height_across[0].abs() + height_across[1].abs()) * further * 0.5;
        let [xx, xy, yy] = &self.seconds;
        let right_bends = [
            xx.dot_one(light.right),
            xy.dot_one(light.right),
            yy.dot_one(light.right),
        ];
        let up_bends = [
            xx.dot_one(light.up),
            xy.dot_one(light.up),
            yy.dot_one(light.up),
        ];
        // How far P'' is from that of the middle of the box in its corners, over itself.
        let turned = self.turn_sq.sqrt() / self.grazing;
        let third = (turned * 0.5 + self.slide).min(half);
        for caster in casters {
            let center = caster.center;
            let u = right - center.dot(light.right);
            let v = up - center.dot(light.up);
            let inside = (u * u + v * v) * -1.0 + caster.radius * caster.radius;
            let across = [
                (u * right_across[0] + v * up_across[0]) * -2.0,
                (u * right_across[1] + v * up_across[1]) * -2.0,
            ];
            let bend = (more * caster.radius + moved_sq) * further;
            let bends = Bends {
                xx: -(right_across[0] * right_across[0] + up_across[0] * up_across[0])
                    - (u * right_bends[0] + v * up_bends[0]),
                xy: (right_across[0] * right_across[1] + up_across[0] * up_across[1]) * -2.0
                    - (u * right_bends[1] + v * up_bends[1]),
                yy: -(right_across[1] * right_across[1] + up_across[1] * up_across[1])
                    - (u * right_bends[2] + v * up_bends[2]),
            };
            let (middle, across) = bends.moved(inside, across, self.offset);
            let foot = foot(simd, middle, across);
            // The caster is above the points, or above those at the edge where these are outside of its disc.
            let at_foot = height + height_across[0] * foot[0] + height_across[1] * foot[1];
            let is_inside = middle.simd_gt(zero);
            let top = center.dot(light.toward);
            let above = is_inside.select(height, at_foot).simd_lt(top);
            let width = across[0].abs() + across[1].abs();
            if (middle.abs() - bend * 2.0)
                .simd_lt(width * 0.5)
                .to_bitmask()
                == 0
            {
                // No edge is near.
                let is_dark = above & is_inside;
                left.region.darken(simd, is_dark);
                left.is_free &= !is_dark;
                continue;
            }
            let part =
                HalfPlane::of_second_degree(simd, middle, across, &bends, Some(bend * third));
            // What is above elsewhere in the box may be dark.
            let hidden = above.select(zero, part.share);
            let may_be = (height - of_box).simd_lt(top);
            let doubt = may_be.select(part.doubt + hidden, zero);
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

/// The way in sides of a box from its middle along the gradient to where a linear function vanishes, as far as that
/// lies in the box.
#[inline(always)]
fn foot<S: Simd>(simd: S, value: f64x8<S>, across: [f64x8<S>; 2]) -> [f64x8<S>; 2] {
    let tiny = f64x8::splat(simd, f64::MIN_POSITIVE);
    let half = f64x8::splat(simd, 0.5);
    let steep = (across[0] * across[0] + across[1] * across[1]).max(tiny);
    let step = value * -1.0 / steep;
    [
        (across[0] * step).max(-half).min(half),
        (across[1] * step).max(-half).min(half),
    ]
}
