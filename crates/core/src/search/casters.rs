//! The spheres that may keep a light from a point.
//!
//! Seen from a directional light every sphere is a disc. What may lie in some discs is asked of the
//! hierarchy of all spheres, whose boxes are seen along the light as well: it serves all lights.

use std::sync::Arc;

use fearless_simd::prelude::*;
use fearless_simd::{Level, Simd, dispatch, f64x8, mask64x8};
use glam::{DVec2, DVec3};

use super::eight::doubles;
use super::hierarchy::boxes::{Boxes, Group};
use super::hierarchy::{Hierarchy, Look, is_sphere};
use crate::model::sphere::Sphere;
use crate::numeric::bits::set_bits;
use crate::numeric::rounding::UNIT_ROUNDOFF;

/// Which discs a point of the plane may lie in.
#[derive(Clone, Debug)]
pub(super) struct Casters<'world> {
    spheres: &'world [Sphere],
    hierarchy: Arc<Hierarchy>,
    /// The coordinates of the plane.
    right: DVec3,
    up: DVec3,
    /// Unit vector toward the light.
    toward: DVec3,
    /// What the processor can do.
    level: Level,
}

/// A box across a light, that begins somewhere and has no end toward the light.
#[derive(Clone, Copy, Debug)]
struct Shaft {
    low: DVec2,
    high: DVec2,
    lowest: f64,
}

impl<'world> Casters<'world> {
    /// The discs of spheres across a light in the unit direction `toward`.
    pub(super) fn new(spheres: &'world [Sphere], hierarchy: Arc<Hierarchy>, toward: DVec3) -> Self {
        let (right, up) = toward.any_orthonormal_pair();
        Self {
            spheres,
            hierarchy,
            right,
            up,
            toward,
            level: Level::new(),
        }
    }

    /// Whether something holds for any sphere in whose disc a point may lie that is known up to
    /// a distance of `error`; it is asked for some other spheres too.
    pub(super) fn any(
        &self,
        point: DVec3,
        error: f64,
        mut holds: impl FnMut(usize) -> bool,
    ) -> bool {
        let center = self.project(point);
        let around = error + slack(point, 0.0);
        let shaft = Shaft {
            low: center - around,
            high: center + around,
            lowest: self.height(point) - around,
        };
        self.any_in(&shaft, &mut holds)
    }

    /// Appends the indices of all spheres that [`Self::any_within`] asks, in their order.
    pub(super) fn within(
        &self,
        points: &[DVec3],
        around: f64,
        lowest: f64,
        indices: &mut Vec<usize>,
    ) {
        let first = indices.len();
        self.any_within(points, around, lowest, |index| {
            indices.push(index);
            false
        });
        indices[first..].sort_unstable();
    }

    /// Whether something holds for any sphere whose disc may reach into the box of some points, made
    /// larger by `around`, and which may lie toward the light from the height `lowest`; each is asked
    /// once.
    pub(super) fn any_within(
        &self,
        points: &[DVec3],
        around: f64,
        lowest: f64,
        mut holds: impl FnMut(usize) -> bool,
    ) -> bool {
        let (mut low, mut high) = (DVec2::INFINITY, DVec2::NEG_INFINITY);
        let mut most = 0.0_f64;
        for &point in points {
            let slack = slack(point, 0.0);
            let (center, around) = (self.project(point), around + slack);
            (low, high) = (low.min(center - around), high.max(center + around));
            most = most.max(slack);
        }
        let mut shaft = Shaft {
            low,
            high,
            lowest: lowest - most,
        };
        if !points.iter().all(|point| point.is_finite()) {
            // Nothing is known.
            (shaft.low, shaft.high) = (DVec2::NEG_INFINITY, DVec2::INFINITY);
            shaft.lowest = f64::NEG_INFINITY;
        }
        self.any_in(&shaft, &mut holds)
    }

    /// Whether something holds for any sphere that may reach into a shaft.
    fn any_in(&self, shaft: &Shaft, holds: &mut dyn FnMut(usize) -> bool) -> bool {
        dispatch!(self.level, simd => self.any_lanes(simd, shaft, holds))
    }

    #[inline(always)]
    fn any_lanes<S: Simd>(
        &self,
        simd: S,
        shaft: &Shaft,
        holds: &mut dyn FnMut(usize) -> bool,
    ) -> bool {
        self.hierarchy.any(
            |boxes| self.reaching(simd, boxes, shaft),
            |number| {
                let reaching = self.reaching_of(simd, self.hierarchy.group(number), shaft);
                let indices = self.hierarchy.indices(number);
                for place in set_bits(reaching) {
                    let index = indices[place];
                    if is_sphere(index) && self.reaches(index, shaft) && holds(index as usize) {
                        return true;
                    }
                }
                false
            },
        )
    }

    /// Which spheres of a group may reach into a shaft; places without a sphere may seem to.
    #[inline(always)]
    fn reaching_of<S: Simd>(&self, simd: S, group: &Group, shaft: &Shaft) -> u8 {
        let zero = f64x8::splat(simd, 0.0);
        let (mut x, mut y, mut z) = (zero, zero, zero);
        let radius = doubles(simd, &group.radius);
        let mut size = radius;
        for axis in 0..3 {
            let center = doubles(simd, &group.center[axis]);
            x += center * self.right[axis];
            y += center * self.up[axis];
            z += center * self.toward[axis];
            size += center.abs();
        }
        let radius = radius + (size * SLACK + f64::MIN_POSITIVE);
        !(beyond(shaft, [x, y, z], [radius; 3]).to_bitmask() as u8)
    }

    /// Which boxes may reach into a shaft; those first that begin lowest.
    #[inline(always)]
    fn reaching<S: Simd>(&self, simd: S, boxes: &Boxes, shaft: &Shaft) -> Look {
        let zero = f64x8::splat(simd, 0.0);
        let (mut x, mut y, mut z) = (zero, zero, zero);
        let (mut wide, mut tall, mut deep) = (zero, zero, zero);
        let mut size = zero;
        for axis in 0..3 {
            let low = doubles(simd, &boxes.low[axis]);
            let high = doubles(simd, &boxes.high[axis]);
            let (center, half) = ((low + high) * 0.5, (high - low) * 0.5);
            let (right, up, toward) = (self.right[axis], self.up[axis], self.toward[axis]);
            x += center * right;
            y += center * up;
            z += center * toward;
            wide += half * right.abs();
            tall += half * up.abs();
            deep += half * toward.abs();
            size += center.abs() + half;
        }
        let slack = size * SLACK + f64::MIN_POSITIVE;
        let (wide, tall, deep) = (wide + slack, tall + slack, deep + slack);
        let is_beyond = beyond(shaft, [x, y, z], [wide, tall, deep]);
        Look {
            may: !(is_beyond.to_bitmask() as u8),
            keys: (z - deep).into(),
        }
    }

    /// Whether a sphere may reach into a shaft.
    fn reaches(&self, index: u32, shaft: &Shaft) -> bool {
        let sphere = &self.spheres[index as usize];
        let center = self.project(sphere.center());
        let radius = sphere.radius() + slack(sphere.center(), sphere.radius());
        let is_beyond = (center.x - radius > shaft.high.x)
            | (center.x + radius < shaft.low.x)
            | (center.y - radius > shaft.high.y)
            | (center.y + radius < shaft.low.y)
            | (self.height(sphere.center()) + radius < shaft.lowest);
        !is_beyond
    }

    /// The axes of the plane.
    pub(super) fn axes(&self) -> (DVec3, DVec3) {
        (self.right, self.up)
    }

    /// How far toward the light a point lies.
    pub(super) fn height(&self, point: DVec3) -> f64 {
        point.dot(self.toward)
    }

    pub(super) fn project(&self, point: DVec3) -> DVec2 {
        DVec2::new(point.dot(self.right), point.dot(self.up))
    }
}

/// Four times what rounding moves spheres by: also the projections of a box around them.
const SLACK: f64 = 4.0 * 32.0 * UNIT_ROUNDOFF;

/// What lies outside of a shaft: across it or too low, by the middles and what they reach to either
/// side. What is not a number, because single precision does not hold it, may reach anywhere.
#[inline(always)]
fn beyond<S: Simd>(
    shaft: &Shaft,
    [x, y, z]: [f64x8<S>; 3],
    [wide, tall, deep]: [f64x8<S>; 3],
) -> mask64x8<S> {
    (x - wide).simd_gt(shaft.high.x)
        | (x + wide).simd_lt(shaft.low.x)
        | (y - tall).simd_gt(shaft.high.y)
        | (y + tall).simd_lt(shaft.low.y)
        | (z + deep).simd_lt(shaft.lowest)
}

/// More than rounding can move the projection of a sphere's center, or of a point.
///
/// With u the unit roundoff and M = |c| + r: the projection is off by 4u √3 M; the light and the
/// axes are orthogonal up to 8u, over which the ray of light between a point and the sphere drifts
/// by 8u times the sum of both M.
pub(super) fn slack(center: DVec3, radius: f64) -> f64 {
    32.0 * UNIT_ROUNDOFF * (center.abs().element_sum() + radius) + f64::MIN_POSITIVE
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::search::tests::Random;

    fn casters(spheres: &[Sphere], toward: DVec3) -> Casters<'_> {
        Casters::new(spheres, Arc::new(Hierarchy::new(spheres)), toward)
    }

    fn asked(casters: &Casters<'_>, point: DVec3, error: f64) -> Vec<usize> {
        let mut asked = Vec::new();
        casters.any(point, error, |index| {
            asked.push(index);
            false
        });
        asked
    }

    /// Points at the very edge of discs of all sizes, and within their error of it.
    #[test]
    fn points_at_the_edge_of_a_disc_ask_its_sphere() {
        let mut random = Random(7);
        for _ in 0..300 {
            let toward = random.point().normalize();
            let spheres: Vec<Sphere> = (0..10)
                .map(|_| {
                    let radius = libm::exp10(-4.0 + 8.0 * random.number());
                    Sphere::new(random.point() * 3.0, radius).unwrap()
                })
                .collect();
            let casters = casters(&spheres, toward);
            for (index, sphere) in spheres.iter().enumerate() {
                let outward = random.point().reject_from_normalized(toward).normalize();
                let below = -20.0 * random.number() * toward;
                let point = sphere.center() + outward * sphere.radius() + below;
                assert!(asked(&casters, point, 0.0).contains(&index));
                for error in [1e-9, 0.1, 100.0] {
                    assert!(asked(&casters, point + outward * error, error).contains(&index));
                }
            }
        }
    }

    /// Counted work: neither a floor nor a stray sphere makes points ask more than a few.
    #[test]
    fn floors_and_outliers_do_not_matter() {
        let mut random = Random(8);
        let balls: Vec<Sphere> = (0..10_000)
            .map(|_| Sphere::new(random.point() * 100.0, 0.9).unwrap())
            .collect();
        let floor = Sphere::new(DVec3::new(0.0, -1e6, 0.0), 1e6).unwrap();
        let speck = Sphere::new(DVec3::splat(1e6), 0.01).unwrap();
        for extra in [vec![], vec![floor], vec![speck], vec![floor, speck]] {
            let spheres = [&balls[..], &extra[..]].concat();
            let casters = casters(&spheres, DVec3::new(0.6, 0.64, -0.48));
            let count: usize = balls
                .iter()
                .map(|ball| asked(&casters, ball.center(), 1e-13).len())
                .sum();
            assert!(count < 4 * balls.len(), "{} a point", count as f64 / 1e4);
        }
    }
}
