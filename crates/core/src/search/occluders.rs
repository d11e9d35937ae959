//! The spheres that may keep a light from a point: its occluders.
//!
//! Seen from a directional light every sphere is a disc. What may lie in some discs is asked of the
//! hierarchy of all spheres, whose boxes are seen along the light as well: it serves all lights.

use std::sync::Arc;
use std::sync::atomic::{AtomicU32, Ordering};

use fearless_simd::{Level, Simd, dispatch};
use glam::{DVec2, DVec3};

use super::disc_grid::{HighDisc, Square};
use super::hierarchy::boxes::{Boxes, doubles};
use super::hierarchy::groups::Group;
use super::hierarchy::order::WIDTH;
use super::hierarchy::{BoxTest, Hierarchy, is_sphere};
use crate::model::sphere::Sphere;
use crate::numeric::bits::set_bits;
use crate::numeric::lanes::{f64x8, mask64x8};
use crate::numeric::pair::three;
use crate::numeric::rounding::UNIT_ROUNDOFF;

/// The spheres as discs of a plane, asked which of them a point may lie in.
#[derive(Clone, Debug)]
pub(super) struct Occluders<'world> {
    spheres: &'world [Sphere],
    hierarchy: Arc<Hierarchy>,
    /// A number that no other occluders have but copies of these.
    name: u32,
    /// The coordinates of the plane.
    right: DVec3,
    up: DVec3,
    /// Unit vector toward the light.
    toward: DVec3,
    /// A height that no top of [`Occluders::find_high`] exceeds.
    highest: f64,
    /// The instructions that the processor has.
    level: Level,
}

/// A box across a light, that begins somewhere and has no end toward the light.
#[derive(Clone, Copy, Debug)]
struct Shaft {
    low: DVec2,
    high: DVec2,
    lowest: f64,
}

impl<'world> Occluders<'world> {
    /// The discs of spheres across a light in the unit direction `toward`.
    pub(super) fn new(spheres: &'world [Sphere], hierarchy: Arc<Hierarchy>, toward: DVec3) -> Self {
        static NEXT_NAME: AtomicU32 = AtomicU32::new(0);
        let (right, up) = toward.any_orthonormal_pair();
        Self {
            spheres,
            name: NEXT_NAME.fetch_add(1, Ordering::Relaxed),
            highest: highest(&hierarchy, toward),
            hierarchy,
            right,
            up,
            toward,
            level: Level::new(),
        }
    }

    /// A number that no other occluders have but copies of these, up to 2³² of them.
    pub(super) fn name(&self) -> u32 {
        self.name
    }

    /// Says whether something holds for any sphere in whose disc a point may lie that is known up to
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

    /// Says whether something holds for any sphere whose disc may reach into the box of some points,
    /// made larger by `around`, and which may lie toward the light from the height `lowest`; each is
    /// asked once.
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

    /// Says whether something holds for any sphere that may reach into a shaft.
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
            |boxes| self.reaching_boxes(simd, boxes, shaft),
            |number| {
                let reaching =
                    self.reaching_spheres(simd, &self.hierarchy.group(number, self.spheres), shaft);
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

    /// The spheres of a group that may reach into a shaft, as bits; places without a sphere may seem
    /// to.
    #[inline(always)]
    fn reaching_spheres<S: Simd>(&self, simd: S, group: &Group, shaft: &Shaft) -> u8 {
        let ([x, y, z], radius) = self.along_light(simd, group);
        !(beyond(shaft, [x, y, z], [radius; 3]).to_bitmask() as u8)
    }

    /// The centers of the spheres of a group across and along the light, and their radii, larger by
    /// more than rounding moves anything of them.
    #[inline(always)]
    fn along_light<S: Simd>(&self, simd: S, group: &Group) -> ([f64x8<S>; 3], f64x8<S>) {
        let zero = f64x8::splat(simd, 0.0);
        let (mut x, mut y, mut z) = (zero, zero, zero);
        let radius = f64x8::from_array(simd, group.radius);
        let mut size = radius;
        for axis in 0..3 {
            let center = f64x8::from_array(simd, group.center[axis]);
            x += center * self.right[axis];
            y += center * self.up[axis];
            z += center * self.toward[axis];
            size += center.abs();
        }
        ([x, y, z], radius + (size * SLACK + f64::MIN_POSITIVE))
    }

    /// Finds the discs of the spheres that may reach into a square across the light, and whose tops lie in
    /// a section of its length, above its begin and up to its end; `None` if they are more than `most`.
    ///
    /// The discs contain the true ones; returns how much smaller they have to be, with centers that much
    /// lower, to be contained in them. What single precision does not hold is in all sections.
    pub(super) fn find_high(
        &self,
        square: &Square,
        section: (f64, f64),
        most: usize,
        discs: &mut Vec<HighDisc>,
    ) -> Option<f64> {
        let (lowest, end) = section;
        let shaft = Shaft {
            low: square.low - square.margin,
            high: square.low + (square.side + square.margin),
            lowest,
        };
        discs.clear();
        dispatch!(self.level, simd => self.find_high_lanes(simd, &shaft, end, most, discs))
    }

    #[inline(always)]
    fn find_high_lanes<S: Simd>(
        &self,
        simd: S,
        shaft: &Shaft,
        end: f64,
        most: usize,
        discs: &mut Vec<HighDisc>,
    ) -> Option<f64> {
        let mut excess = 0.0_f64;
        let lowest = f64x8::splat(simd, shaft.lowest);
        let is_crowded = self.hierarchy.any(
            |boxes| {
                let mut tested = self.reaching_boxes(simd, boxes, shaft);
                // A sphere's top lies above the bottom of any box around it.
                let bottoms = f64x8::from_array(simd, tested.keys);
                tested.may &= !(bottoms.simd_gt(end).to_bitmask() as u8);
                tested
            },
            |number| {
                let group = &self.hierarchy.group(number, self.spheres);
                let ([x, y, z], radius) = self.along_light(simd, group);
                let top = z + radius;
                let is_outside =
                    beyond(shaft, [x, y, z], [radius; 3]) | top.simd_gt(end) | top.simd_le(lowest);
                let inside = !(is_outside.to_bitmask() as u8);
                let indices = self.hierarchy.indices(number);
                for place in set_bits(inside) {
                    if is_sphere(indices[place]) {
                        // What is no number leaves nothing for certain. Radii were made larger by more than
                        // rounding moves centers, and tops.
                        let larger = radius[place] - group.radius[place];
                        let more = group.excess(place) + 4.0 * larger + radius[place] * SLACK;
                        if more > excess || more.is_nan() {
                            excess = more;
                        }
                        discs.push(HighDisc {
                            center: DVec2::new(x[place], y[place]),
                            radius: radius[place],
                            top: top[place],
                            sphere: indices[place],
                        });
                    }
                }
                discs.len() > most
            },
        );
        (!is_crowded).then_some(excess)
    }

    /// A height that no top of [`Occluders::find_high`] exceeds.
    pub(super) fn highest(&self) -> f64 {
        self.highest
    }

    /// The boxes that may reach into a shaft; those first that begin lowest.
    #[inline(always)]
    fn reaching_boxes<S: Simd>(&self, simd: S, boxes: &Boxes, shaft: &Shaft) -> BoxTest {
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
        BoxTest {
            may: !(is_beyond.to_bitmask() as u8),
            keys: (z - deep).into(),
        }
    }

    /// True where a sphere may reach into a shaft.
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

    /// The spheres, by their indices.
    pub(super) fn spheres(&self) -> &'world [Sphere] {
        self.spheres
    }

    /// The instructions that the processor has.
    pub(super) fn level(&self) -> Level {
        self.level
    }

    /// The axes of the plane.
    pub(super) fn axes(&self) -> (DVec3, DVec3) {
        (self.right, self.up)
    }

    /// The unit direction toward the light.
    pub(super) fn toward(&self) -> DVec3 {
        self.toward
    }

    /// The place of a point along the light.
    pub(super) fn height(&self, point: DVec3) -> f64 {
        point.dot(self.toward)
    }

    /// The place of a point across the light.
    pub(super) fn project(&self, point: DVec3) -> DVec2 {
        DVec2::new(point.dot(self.right), point.dot(self.up))
    }
}

/// The height of the highest sphere, rounded up by far more than single precision makes spheres larger.
fn highest(hierarchy: &Hierarchy, toward: DVec3) -> f64 {
    /// Relatively.
    const WIDER: f64 = 1e-5;
    let Some(root) = hierarchy.root() else {
        return f64::NEG_INFINITY;
    };
    let boxes = hierarchy.boxes(root);
    let mut highest = f64::NEG_INFINITY;
    for place in set_bits(boxes.filled()) {
        let corner = |side: &[[f32; WIDTH]; 3]| {
            DVec3::from_array(three([0, 1, 2], |axis| f64::from(side[axis][place])))
        };
        let (low, high) = (corner(&boxes.low), corner(&boxes.high));
        let (center, half) = ((low + high) * 0.5, (high - low) * 0.5);
        let size = center.abs().element_sum() + half.element_sum();
        let top = center.dot(toward) + half.dot(toward.abs());
        let top = top + size * WIDER + f64::from(f32::MIN_POSITIVE);
        highest = if top.is_nan() {
            f64::INFINITY
        } else {
            highest.max(top)
        };
    }
    highest
}

/// Four times what rounding moves spheres by: also the projections of a box around them.
const SLACK: f64 = 4.0 * 32.0 * UNIT_ROUNDOFF;

/// The things that lie outside of a shaft: across it or too low, by the middles and what they reach to either
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
mod tests;
