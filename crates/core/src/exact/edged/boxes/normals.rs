//! The normals that light is computed with, in boxes.

use fearless_simd::Simd;

use super::contours::Visible;
use super::surroundings::{OF_SECOND, Surroundings};
use crate::exact::scene::InCamera;
use crate::exact::surface::Finish;
use crate::model::roughness::noise::NoiseCells;
use crate::numeric::lanes::{f64x8, mask64x8};
use crate::numeric::vectors::Vectors;

/// Shading normals, and how they change across boxes.
#[derive(Clone, Copy, Debug)]
pub(super) struct Normals<S: Simd> {
    pub(super) normal: Vectors<S>,
    pub(super) across: [Vectors<S>; 2],
    /// The second derivatives along both axes.
    pub(super) seconds: [Vectors<S>; 2],
    /// The square of the angle by which they turn across a box.
    pub(super) turn_sq: f64x8<S>,
    /// The error of taking one normal for the average, and what is left of it when second derivatives are integrated.
    pub(super) second: f64x8<S>,
    pub(super) third: f64x8<S>,
    /// The difference of the normals of bumps in a box from linear functions; and those of smooth spheres near
    /// silhouettes, where that matters.
    pub(super) bow: f64x8<S>,
    /// Whether second derivatives say more than the error without them.
    pub(super) is_bent: mask64x8<S>,
    pub(super) is_rough: bool,
    /// The points of each box whose normals were computed.
    pub(super) samples: u64,
}

/// The difference of cosines from linear functions near a silhouette, over the square of the turn of normals and the
/// cosine toward the eye: twice what boxes need that touch it.
const OF_BEND: f64 = 0.75;

/// Samples of the normals of rough surfaces in a box.
const SAMPLES: usize = 5;

/// The places of samples along an axis, in sides of what is seen: those of Gauss's rule with three points.
const OUTER: f64 = 0.387_298_334_620_741_7;

/// The difference of a quadratic function from a linear one over its second derivative: that of the middle of an interval
/// from its ends.
const OF_BOW: f64 = 0.125;

/// Half of the most cells of the noise across a box in which five samples know bumps.
const MOST_CELLS: f64 = 0.55;

/// The error of second derivatives of bumps that samples tell, as a share: where cells of the noise meet, they jump.
/// And as a share of what they are on average, which they may be less than by chance. Not tuned finely.
const OF_BUMPS: f64 = 0.3;
const BY_CHANCE: f64 = 0.2;

/// The turn of bumps where a silhouette cuts them, over their largest turn: twice the root of the mean
/// square.
const OF_SPHERE: f64 = 0.5;

impl<S: Simd> Normals<S> {
    #[inline(always)]
    pub(super) fn new(
        simd: S,
        scene: &InCamera<'_>,
        finish: &Finish,
        (around, visible): (&Surroundings<S>, &Visible<S>),
        noise: &mut Option<Box<NoiseCells>>,
    ) -> Self {
        let of_sphere = Self::of_sphere(simd, around);
        if !finish.is_rough() {
            return of_sphere;
        }
        of_sphere.perturbed(simd, scene, finish, around, visible, noise)
    }

    /// Those of the sphere.
    #[inline(always)]
    fn of_sphere(simd: S, around: &Surroundings<S>) -> Self {
        let by_radius = f64x8::splat(simd, 1.0 / around.radius);
        let [x, y] = &around.across;
        let [xx, _, yy] = &around.seconds;
        Self {
            normal: around.points.normal,
            across: [x.times(by_radius), y.times(by_radius)],
            seconds: [xx.times(by_radius), yy.times(by_radius)],
            turn_sq: around.turn_sq,
            second: around.second,
            third: around.third,
            bow: (around.turn_sq / around.grazing * OF_BEND).min(around.grazing),
            is_bent: !around.is_cut,
            is_rough: false,
            samples: 1,
        }
    }

    /// Those of a rough surface on the sphere, by five samples.
    #[inline(always)]
    fn perturbed(
        &self,
        simd: S,
        scene: &InCamera<'_>,
        finish: &Finish,
        around: &Surroundings<S>,
        visible: &Visible<S>,
        noise: &mut Option<Box<NoiseCells>>,
    ) -> Self {
        let one = f64x8::splat(simd, 1.0);
        let least = f64x8::splat(simd, LEAST_EXTENT);
        let mut normals = [self.normal; SAMPLES];
        let mut steps = [one; 2];
        for axis in 0..2 {
            let extent = (one - visible.middle[axis].abs() * 2.0).max(least);
            let step = extent * OUTER;
            let bent = self.seconds[axis].times(step * step * 0.5);
            let moved = self.across[axis].times(step);
            let middle = self.normal.plus(&bent);
            normals[2 * axis + 1] = unit(&middle.minus(&moved));
            normals[2 * axis + 2] = unit(&middle.plus(&moved));
            steps[axis] = step;
        }
        normals[0] = unit(&normals[0]);
        finish.perturb(simd, scene, &mut normals, noise);
        let [middle, left, right, above, below] = normals;
        let mut across = self.across;
        let mut seconds = self.seconds;
        for (axis, [before, after]) in [[left, right], [above, below]].iter().enumerate() {
            let by_step = one / steps[axis];
            across[axis] = after.minus(before).times(by_step * 0.5);
            let sides = after.plus(before).minus(&middle.times(one * 2.0));
            seconds[axis] = sides.times(by_step * by_step);
        }
        let bends = seconds[0].length_squared().sqrt() + seconds[1].length_squared().sqrt();
        let turn_sq = across[0].length_squared() + across[1].length_squared();
        let slope = finish.usual_slope();
        let cells = finish.shading_normal.cells();
        let usual = around.turn_sq * (slope * cells);
        let unknown = bends * OF_BUMPS + usual * BY_CHANCE;
        // What the sphere bends near its silhouette, its bumps turn with.
        let of_sphere = slope * OF_SPHERE;
        let turn = around.turn_sq.sqrt();
        let is_seen = (turn * (0.5 * cells)).simd_lt(MOST_CELLS);
        let most = one * 2.0;
        let known = |error: f64x8<S>| is_seen.select(error.min(most), most);
        Self {
            normal: middle,
            across,
            seconds,
            turn_sq: turn_sq + bends * bends * 0.25,
            second: known(bends * OF_SECOND + of_sphere * around.second),
            third: known(unknown * OF_SECOND + of_sphere * around.third),
            bow: bends * OF_BOW,
            is_bent: is_seen & !around.is_cut,
            is_rough: true,
            samples: SAMPLES as u64,
        }
    }
}

/// The least extent of what is seen over which samples are taken.
const LEAST_EXTENT: f64 = 0.05;

/// Unit vectors in the directions of vectors that are about as long.
#[inline(always)]
fn unit<S: Simd>(vectors: &Vectors<S>) -> Vectors<S> {
    let length = vectors.length_squared().sqrt();
    vectors.times(f64x8::splat(length.simd(), 1.0) / length)
}
