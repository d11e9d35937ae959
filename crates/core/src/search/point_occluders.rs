//! The spheres that may keep a point light from a point.
//!
//! A sphere around the light hides it from all that is outside of it, and no other sphere does so by more than the
//! cone that it fills, seen from the light.

use std::sync::Arc;

use glam::DVec3;

use super::hierarchy::boxes::Boxes;
use super::hierarchy::order::WIDTH;
use super::hierarchy::{BoxTest, Hierarchy, is_sphere};
use crate::model::ray::Ray;
use crate::model::sphere::Sphere;

/// The spheres as a point light sees them.
#[derive(Clone, Debug)]
pub(crate) struct PointOccluders<'world> {
    spheres: &'world [Sphere],
    hierarchy: Arc<Hierarchy>,
    position: DVec3,
    /// The spheres that the light is inside of, or on whose surface it lies.
    enclosing: Arc<[usize]>,
}

/// All that lies between a point and a ball.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Beam {
    apex: DVec3,
    /// The unit vector toward the ball's center, and its distance.
    axis: DVec3,
    length: f64,
    around: f64,
    /// Of half the angle at the apex; a ball around the apex has none.
    sine: f64,
    cosine: f64,
}

/// Of lengths, by far more than what rounding moves them.
const SLACK: f64 = 1e-11;

impl Beam {
    /// What lies between `apex` and the ball around a point.
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
    ) -> Self {
        Self {
            enclosing: enclosing(spheres, position).into(),
            spheres,
            hierarchy,
            position,
        }
    }

    /// The spheres that the light is inside of, or on whose surface it lies, in the order of their indices.
    pub(crate) fn enclosing(&self) -> &[usize] {
        &self.enclosing
    }

    /// Says whether something holds for any sphere that may reach into a beam from the light, but for those around the
    /// light; each is asked once.
    pub(crate) fn any_in(&self, beam: &Beam, mut holds: impl FnMut(usize) -> bool) -> bool {
        self.hierarchy.any(
            |boxes| reaching_boxes(boxes, beam),
            |group| {
                let mut indices = self.hierarchy.indices(group).iter();
                indices.any(|&index| {
                    if !is_sphere(index) {
                        return false;
                    }
                    let index = index as usize;
                    let sphere = &self.spheres[index];
                    beam.is_reached_by(sphere.center(), sphere.radius())
                        && !self.enclosing.contains(&index)
                        && holds(index)
                })
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
fn reaching_boxes(boxes: &Boxes, beam: &Beam) -> BoxTest {
    let mut tested = BoxTest {
        may: 0,
        keys: [0.0; WIDTH],
    };
    for place in 0..WIDTH {
        let corner = |side: &[[f32; WIDTH]; 3]| {
            DVec3::from_array([0, 1, 2].map(|axis| f64::from(side[axis][place])))
        };
        let (low, high) = (corner(&boxes.low), corner(&boxes.high));
        let (center, half) = (0.5 * (low + high), 0.5 * (high - low));
        tested.may |= u8::from(beam.is_reached_by(center, half.length())) << place;
        tested.keys[place] = (center - beam.apex).dot(beam.axis) - half.length();
    }
    tested
}

#[cfg(test)]
mod tests;
