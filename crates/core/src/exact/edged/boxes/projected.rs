//! Points of a sphere as a light sees them.

use fearless_simd::Simd;

use super::bent::Bends;
use super::surroundings::Surroundings;
use crate::edges::shadow::Caster;
use crate::exact::scene::Light;
use crate::numeric::lanes::f64x8;

/// The least of 1 − slide: boxes that see a plane up to its horizon are all in doubt.
const LEAST_REST: f64 = 1e-6;

/// Points in the coordinates of a light, two across it and the height toward it, and how they move across boxes.
#[derive(Clone, Copy, Debug)]
pub(super) struct Projected<S: Simd> {
    right: f64x8<S>,
    up: f64x8<S>,
    pub(super) height: f64x8<S>,
    right_across: [f64x8<S>; 2],
    up_across: [f64x8<S>; 2],
    pub(super) height_across: [f64x8<S>; 2],
    /// The second derivatives, by x twice, by x and y, twice, and by y twice.
    right_bends: [f64x8<S>; 3],
    up_bends: [f64x8<S>; 3],
    /// From the middles of boxes to the points, in sides.
    offset: [f64x8<S>; 2],
    /// The square of half of what points move across a box, and what second derivatives add to it.
    pub(super) moved_sq: f64x8<S>,
    pub(super) more: f64x8<S>,
    /// The ratio of the rest of the series to its terms of the second degree.
    pub(super) further: f64x8<S>,
    /// The distance of points from where second derivatives put them, where a box comes near the silhouette.
    pub(super) rest: f64x8<S>,
    /// The distance of the silhouette behind the points, along the view: R g.
    pub(super) depth: f64x8<S>,
    /// The relative change of second derivatives from the middle of the box to its corners.
    pub(super) third: f64x8<S>,
    /// Heights in a box differ by no more from that in its middle.
    pub(super) of_box: f64x8<S>,
}

impl<S: Simd> Projected<S> {
    #[inline(always)]
    pub(super) fn new(simd: S, around: &Surroundings<S>, light: &Light) -> Self {
        let one = f64x8::splat(simd, 1.0);
        let half = f64x8::splat(simd, 0.5);
        let (place, [x, y]) = (&around.place, &around.across);
        // From the middle of a box to its corner a point moves by P', and by half of P'' more, which is |P'|² over the
        // radius and the cosine for the sphere, and twice the slide for the perspective.
        let moved_sq = around.turn_sq * (0.5 * around.radius * around.radius);
        let more =
            moved_sq / (around.grazing * around.radius) + moved_sq.sqrt() * around.slide * 2.0;
        // A plane is seen at t / (1 − slide) there: the series that ends with P'' converges as fast as that.
        let rest = (one - around.slide).max(f64x8::splat(simd, LEAST_REST));
        let further = one / (rest * rest);
        // Toward the silhouette a sphere lies at R g √(1 − x), with the part x of the way there and the cosine g toward
        // the eye: its first derivatives take 1 − x/2 for the root, the second ones x²/8 less.
        let depth = around.grazing * around.radius;
        let part = (moved_sq.sqrt() * 2.0 / depth).min(one);
        let root = (one - part).sqrt();
        let unknown = one - part * 0.5 - part * part * 0.125 - root;
        let height_across = [x.dot_one(light.toward), y.dot_one(light.toward)];
        let [xx, xy, yy] = &around.seconds;
        let turned = around.turn_sq.sqrt() / around.grazing;
        Self {
            right: place.dot_one(light.right),
            up: place.dot_one(light.up),
            height: place.dot_one(light.toward),
            right_across: [x.dot_one(light.right), y.dot_one(light.right)],
            up_across: [x.dot_one(light.up), y.dot_one(light.up)],
            height_across,
            right_bends: [
                xx.dot_one(light.right),
                xy.dot_one(light.right),
                yy.dot_one(light.right),
            ],
            up_bends: [
                xx.dot_one(light.up),
                xy.dot_one(light.up),
                yy.dot_one(light.up),
            ],
            offset: around.offset,
            moved_sq,
            more,
            rest: depth * unknown,
            depth,
            further,
            third: (turned * 0.5 + around.slide).min(half),
            of_box: (height_across[0].abs() + height_across[1].abs()) * further * 0.5,
        }
    }

    /// The depth of points inside of the disc of a caster: the square of its radius minus that of their distance from its
    /// axis, in the middles of boxes, its changes there, and its terms of the second degree.
    #[inline(always)]
    pub(super) fn depth_in(
        &self,
        light: &Light,
        caster: &Caster,
    ) -> (f64x8<S>, [f64x8<S>; 2], Bends<S>) {
        let u = self.right - caster.center.dot(light.right);
        let v = self.up - caster.center.dot(light.up);
        let inside = (u * u + v * v) * -1.0 + caster.radius * caster.radius;
        let ([right_x, right_y], [up_x, up_y]) = (self.right_across, self.up_across);
        let across = [
            (u * right_x + v * up_x) * -2.0,
            (u * right_y + v * up_y) * -2.0,
        ];
        let ([right_xx, right_xy, right_yy], [up_xx, up_xy, up_yy]) =
            (self.right_bends, self.up_bends);
        let bends = Bends {
            xx: -(right_x * right_x + up_x * up_x) - (u * right_xx + v * up_xx),
            xy: (right_x * right_y + up_x * up_y) * -2.0 - (u * right_xy + v * up_xy),
            yy: -(right_y * right_y + up_y * up_y) - (u * right_yy + v * up_yy),
        };
        let (middle, across) = bends.moved(inside, across, self.offset);
        (middle, across, bends)
    }
}
