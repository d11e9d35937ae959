//! The spheres that may keep a point light from a point.
//!
//! A sphere around the light hides it from all that is outside of it, and no other sphere does so by more than the
//! cone that it fills, seen from the light.

use std::sync::Arc;

use fearless_simd::{Level, Simd, dispatch};
use glam::DVec3;

use super::hierarchy::boxes::{Boxes, doubles};
use super::hierarchy::groups::Group;
use super::hierarchy::{BoxTest, Hierarchy, is_sphere};
use crate::model::ray::Ray;
use crate::model::sphere::Sphere;
use crate::numeric::bits::set_bits;
use crate::numeric::lanes::f64x8;
use crate::numeric::pair::three;
use crate::numeric::vectors::Vectors;

/// The spheres as a point light sees them.
#[derive(Clone, Debug)]
pub(crate) struct PointOccluders<'world> {
    spheres: &'world [Sphere],
    hierarchy: Arc<Hierarchy>,
    position: DVec3,
    /// The least radius of all spheres.
    smallest_radius: f64,
    /// The spheres that the light is inside of, or on whose surface it lies.
    enclosing: Arc<[usize]>,
    /// The instructions that the processor has.
    level: Level,
}

/// All that lies between a point and a ball.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Beam {
    apex: DVec3,
    /// The unit vector toward the ball's center, and its distance.
    axis: DVec3,
    length: f64,
    around: f64,
    /// The sine of half the angle at the apex; a ball around the apex has none.
    sine: f64,
    cosine: f64,
}

/// What a light is sought for: points within a distance of the middle of a beam's end, seen by an eye.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Before {
    pub(crate) around: f64,
    pub(crate) eye: DVec3,
}

/// The relative slack of lengths: far more than rounding moves them.
const SLACK: f64 = 1e-11;

impl Beam {
    /// The space between `apex` and the ball around a point.
    pub(crate) fn new(apex: DVec3, middle: DVec3, around: f64) -> Self {
        let way = middle - apex;
        let length = way.length();
        let around = around + SLACK * (apex.abs().max_element() + length);
        // No direction and no angle: everything within the ball.
        let is_apart = around < length;
        let sine = if is_apart { around / length } else { 1.0 };
        Self {
            apex,
            axis: if is_apart { way / length } else { DVec3::ZERO },
            length,
            around,
            sine,
            cosine: ((1.0 - sine) * (1.0 + sine)).sqrt(),
        }
    }

    /// Returns whether a ball may reach into it; what is not a number does.
    #[inline(always)]
    pub(crate) fn is_reached_by(&self, center: DVec3, radius: f64) -> bool {
        let from_apex = center - self.apex;
        let along = from_apex.dot(self.axis);
        let aside = (from_apex - self.axis * along).length();
        let reach = radius + SLACK * (from_apex.abs().max_element() + radius);
        let is_beyond = (along > self.length + self.around + reach)
            | (along < -reach)
            | (from_apex.length() > self.length + self.around + reach)
            | (aside * self.cosine - along * self.sine > reach);
        !is_beyond
    }
}

impl<'world> PointOccluders<'world> {
    pub(super) fn new(
        spheres: &'world [Sphere],
        hierarchy: Arc<Hierarchy>,
        position: DVec3,
        smallest_radius: f64,
    ) -> Self {
        Self {
            enclosing: enclosing(spheres, position).into(),
            spheres,
            hierarchy,
            position,
            smallest_radius,
            level: Level::new(),
        }
    }

    /// The spheres that the light is inside of, or on whose surface it lies, in the order of their indices.
    pub(crate) fn enclosing(&self) -> &[usize] {
        &self.enclosing
    }

    /// Says whether something holds for any sphere that may reach into a beam from the light, but for those around the
    /// light; each is asked once.
    pub(crate) fn any_in(&self, beam: &Beam, mut holds: impl FnMut(usize) -> bool) -> bool {
        self.any_of(beam, None, &mut holds)
    }

    /// The same of spheres that may keep the light from points outside of them which lie no farther than `around` from the
    /// middle of the beam's end, and of those around the eye. It is asked for some others, too.
    pub(crate) fn any_before(
        &self,
        beam: &Beam,
        before: &Before,
        mut holds: impl FnMut(usize) -> bool,
    ) -> bool {
        self.any_of(beam, Some(before), &mut holds)
    }

    fn any_of(
        &self,
        beam: &Beam,
        before: Option<&Before>,
        holds: &mut dyn FnMut(usize) -> bool,
    ) -> bool {
        dispatch!(self.level, simd => self.any_lanes(simd, beam, before, holds))
    }

    #[inline(always)]
    fn any_lanes<S: Simd>(
        &self,
        simd: S,
        beam: &Beam,
        before: Option<&Before>,
        holds: &mut dyn FnMut(usize) -> bool,
    ) -> bool {
        self.hierarchy.any(
            |boxes| {
                let mut tested = reaching_boxes(simd, boxes, beam);
                if let Some(before) = before {
                    tested.may &= !behind(simd, boxes, beam, before, self.smallest_radius);
                }
                tested
            },
            |number| {
                let reaching =
                    reaching_spheres(simd, &self.hierarchy.group(number, self.spheres), beam);
                let indices = self.hierarchy.indices(number);
                for place in set_bits(reaching) {
                    let index = indices[place] as usize;
                    if is_sphere(indices[place]) && !self.enclosing.contains(&index) && holds(index)
                    {
                        return true;
                    }
                }
                false
            },
        )
    }

    /// Says whether any sphere but the one with the index `except` stands between the light and a point of that one's
    /// outer side, known up to a distance of `error`; all of that side is dark where the light is inside.
    ///
    /// A sphere whose surface passes through the point within that error counts as passing through it.
    pub(crate) fn is_blocked(&self, point: DVec3, error: f64, except: usize) -> bool {
        let hides = |&index: &usize| index == except || !self.is_inside(point, error, index);
        if self.enclosing.iter().any(hides) {
            return true;
        }
        let own = &self.spheres[except];
        let to_light = Ray {
            origin: point,
            direction: self.position - point,
        };
        let beam = Beam::new(self.position, point, error);
        self.any_in(&beam, |index| {
            let occluder = &self.spheres[index];
            // Beyond the light nothing hides it.
            index != except
                && (occluder.center() - self.position).dot(to_light.direction) < 0.0
                && occluder.is_met(&to_light, error)
                && occluder != own
        })
    }

    /// Returns whether a point that is known up to an error is inside a sphere for certain.
    fn is_inside(&self, point: DVec3, error: f64, sphere: usize) -> bool {
        let sphere = &self.spheres[sphere];
        sphere.outside(point) < -error * (2.0 * sphere.radius() + error)
    }
}

/// The spheres that a point is inside of, or on whose surface it lies.
pub(crate) fn enclosing(spheres: &[Sphere], point: DVec3) -> Vec<usize> {
    /// More than rounding.
    const WIDER: f64 = 1.0 + 1e-9;
    let is_around = |sphere: &Sphere| {
        let distance_sq = (sphere.center() - point).length_squared();
        let radius_sq = sphere.radius() * sphere.radius();
        let is_far = distance_sq > radius_sq * WIDER && radius_sq > 0.0;
        !is_far && sphere.outside(point) <= 0.0
    };
    let spheres = spheres.iter().enumerate();
    let around = spheres.filter(|(_, sphere)| is_around(sphere));
    around.map(|(index, _)| index).collect()
}

/// The boxes that may reach into a beam; those first that are nearest to the apex.
#[inline(always)]
fn reaching_boxes<S: Simd>(simd: S, boxes: &Boxes, beam: &Beam) -> BoxTest {
    let zero = f64x8::splat(simd, 0.0);
    let (mut center, mut half_sq) = ([zero; 3], zero);
    for (axis, center) in center.iter_mut().enumerate() {
        let low = doubles(simd, &boxes.low[axis]);
        let high = doubles(simd, &boxes.high[axis]);
        let half = (high - low) * 0.5;
        *center = (low + high) * 0.5;
        half_sq += half * half;
    }
    let (reaching, begin) = reached_lanes(simd, beam, center, half_sq.sqrt());
    BoxTest {
        may: reaching,
        keys: begin.into(),
    }
}

/// The boxes, as bits, all of whose spheres lie behind the points that a light is sought for, and not around the eye.
///
/// # Source
/// A sphere with the center c keeps a light at a from a point p outside of it only where (c − p) · (a − p) > 0. With m in
/// the middle of the points, d = a − m, and all p within r of m, that is at most (c − m) · d + r (|c − m| + |d|) + r².
#[inline(always)]
fn behind<S: Simd>(
    simd: S,
    boxes: &Boxes,
    beam: &Beam,
    before: &Before,
    smallest_radius: f64,
) -> u8 {
    if beam.axis == DVec3::ZERO {
        return 0;
    }
    let zero = f64x8::splat(simd, 0.0);
    let toward = beam.axis * -beam.length;
    let middle = beam.apex - toward;
    let (mut highest, mut distance_sq, mut half_sq) = (zero, zero, zero);
    let mut has_eye = 0xff;
    for axis in 0..3 {
        let low = doubles(simd, &boxes.low[axis]);
        let high = doubles(simd, &boxes.high[axis]);
        let half = (high - low) * 0.5;
        let center = (low + high) * 0.5 - middle[axis];
        let of_centers = (half - smallest_radius).max(zero);
        highest += center * toward[axis] + of_centers * toward[axis].abs();
        distance_sq += center * center;
        half_sq += half * half;
        let eye = before.eye[axis];
        has_eye &= (low.simd_le(eye) & high.simd_ge(eye)).to_bitmask() as u8;
    }
    let distance = distance_sq.sqrt() + half_sq.sqrt() + beam.length;
    let around = before.around + distance * SLACK;
    let highest = highest + around * (distance + around);
    highest.simd_lt(0.0).to_bitmask() as u8 & !has_eye
}

/// The spheres of a group that may reach into a beam, as bits; places without a sphere may seem to.
#[inline(always)]
fn reaching_spheres<S: Simd>(simd: S, group: &Group, beam: &Beam) -> u8 {
    let [x, y, z] = &group.center;
    let center = three([x, y, z], |axis| f64x8::from_array(simd, *axis));
    reached_lanes(simd, beam, center, f64x8::from_array(simd, group.radius)).0
}

/// The answers of [`Beam::is_reached_by`] for eight balls, as bits, and the places along the beam where they begin.
#[inline(always)]
fn reached_lanes<S: Simd>(
    simd: S,
    beam: &Beam,
    center: [f64x8<S>; 3],
    radius: f64x8<S>,
) -> (u8, f64x8<S>) {
    let from_apex = Vectors::from_array(center).minus(&Vectors::splat(simd, beam.apex));
    let along = from_apex.dot_one(beam.axis);
    let axis = Vectors::splat(simd, beam.axis);
    let aside_sq = from_apex.minus(&axis.times(along)).length_squared();
    let distance = from_apex.length_squared().sqrt();
    let reach = radius + (distance + radius) * SLACK;
    let end = reach + (beam.length + beam.around);
    let is_beyond = distance.simd_gt(end)
        | along.simd_lt(-reach)
        | (aside_sq.sqrt() * beam.cosine - along * beam.sine).simd_gt(reach);
    (!(is_beyond.to_bitmask() as u8), along - reach)
}

#[cfg(test)]
mod tests;
