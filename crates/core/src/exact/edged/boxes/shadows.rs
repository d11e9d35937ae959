//! The shares of boxes that shadows leave.

use fearless_simd::f64x8;
use fearless_simd::prelude::*;

use super::edges::Edges;
use super::half_plane::HalfPlane;
use super::surroundings::Surroundings;
use crate::edges::shadow::Caster;
use crate::exact::scene::Light;
use crate::numeric::vectors::Vectors;

/// The least of 1 − slide: boxes that see a plane up to its horizon are all in doubt.
const LEAST_REST: f64 = 1e-6;

impl<S: Simd> Surroundings<S> {
    /// The share of each box that casters leave to a light, and the integrals of the coordinates over what they take.
    #[inline(always)]
    pub(super) fn left_by(
        &self,
        simd: S,
        light: &Light,
        casters: &[Caster],
        edges: &mut Edges<S>,
    ) -> (f64x8<S>, [f64x8<S>; 2]) {
        let zero = f64x8::splat(simd, 0.0);
        let one = f64x8::splat(simd, 1.0);
        let mut left = one;
        let mut dark = [zero; 2];
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
            let middle = inside - across[0] * self.offset[0] - across[1] * self.offset[1];
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
                left = (above & is_inside).select(zero, left);
                continue;
            }
            let second = self.second_of(light, foot, (u, v));
            let part = HalfPlane::of_second_degree(simd, middle, across, (second, bend));
            let share = above.select(part.share, zero);
            // What is above elsewhere in the box may be dark.
            let hidden = above.select(zero, part.share);
            let (ambiguity, doubt) = (part.ambiguity(simd) + hidden, part.doubt + hidden);
            let may_be = (height - of_box).simd_lt(top);
            edges.add(may_be.select(ambiguity, zero), may_be.select(doubt, zero));
            for (dark, moment) in dark.iter_mut().zip(part.moments) {
                *dark += above.select(moment, zero);
            }
            left *= one - share;
        }
        (left, dark)
    }

    /// What the second derivative of a caster's function adds to it from a point to the edge, straight along its
    /// gradient.
    ///
    /// With the point P = t d of a sphere with the normal n moving by P' and d by d', t' is t times the slide, and
    /// P'' = d (|P'|² / (r (−n · d)) + 2 t'² / t) + 2 t' d'.
    #[inline(always)]
    fn second_of(
        &self,
        light: &Light,
        [x, y]: [f64x8<S>; 2],
        (u, v): (f64x8<S>, f64x8<S>),
    ) -> f64x8<S> {
        let place = self.across[0].times(x).plus(&self.across[1].times(y));
        let slide = self.slides[0] * x + self.slides[1] * y;
        let along = place.length_squared() * self.by_toward_eye * (1.0 / self.radius)
            + slide * slide * self.points.t * 2.0;
        let turn = slide * self.points.t * 2.0;
        let ray = &self.points.ray;
        let second = Vectors {
            x: ray.x * along + turn * x * self.sides[0],
            y: ray.y * along + turn * y * self.sides[1],
            z: ray.z * along,
        };
        let (right, up) = (place.dot_one(light.right), place.dot_one(light.up));
        let bent = u * second.dot_one(light.right) + v * second.dot_one(light.up);
        (right * right + up * up + bent) * -1.0
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
