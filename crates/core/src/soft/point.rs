//! Points of surfaces, and the spheres that may hide light from them.

use glam::DVec3;

use super::candidate::Candidate;
use super::cap::Cap;
use crate::model::camera::Projection;
use crate::model::sphere::Sphere;
use crate::search::beyond::Beyond;
use crate::search::hierarchy::Hierarchy;

/// A point of a sphere, seen from outside: in the world's frame, or in the camera's and the units of candidates.
#[derive(Clone, Copy, Debug)]
pub(crate) struct SurfacePoint {
    pub(crate) position: DVec3,
    /// The unit outward normal, and that with which light is computed.
    pub(crate) normal: DVec3,
    pub(crate) shading: DVec3,
    /// The unit vector toward the eye.
    pub(crate) to_eye: DVec3,
    pub(crate) sphere: usize,
}

impl SurfacePoint {
    /// The lesser sine of the angle of a direction above the surface and above the plane across the shading normal.
    pub(crate) fn least_height(&self, direction: DVec3) -> f64 {
        self.normal.dot(direction).min(self.shading.dot(direction))
    }

    /// Positive where a sun with this disc makes a highlight: its middle is above the plane across the shading normal, and some of
    /// it above the surface.
    pub(crate) fn highlight_height(&self, disc: &Cap) -> f64 {
        let above_surface = self.normal.dot(disc.axis) + disc.sine;
        self.shading.dot(disc.axis).min(above_surface)
    }
}

impl Candidate {
    /// Where the ray through (u, v) meets the sphere from outside, in the camera's frame. A ray that passes beside it counts
    /// as one that touches it.
    pub(crate) fn surface_point(&self, u: f64, v: f64, projection: Projection) -> SurfacePoint {
        let distance = self.nearest_distance(u, v, projection);
        let (position, to_eye) = match projection {
            Projection::Central => {
                let ray = DVec3::new(u, v, 1.0);
                (ray * distance, -ray.normalize())
            }
            Projection::Parallel => (DVec3::new(u, v, distance), DVec3::NEG_Z),
        };
        let normal = (position - self.center).normalize();
        SurfacePoint {
            position,
            normal,
            shading: normal,
            to_eye,
            sphere: self.sphere,
        }
    }
}

/// The spheres that hide light from each other.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Occluders<'world> {
    pub(crate) spheres: &'world [Sphere],
    pub(crate) hierarchy: &'world Hierarchy,
}

impl Occluders<'_> {
    /// Calls `visit` with all spheres that may lie in some directions and hide light from one of them: not with those inside
    /// of it, nor with those that coincide with it but for rounding.
    pub(crate) fn for_each_sphere(
        &self,
        but: usize,
        beyond: &Beyond,
        mut visit: impl FnMut(&Sphere),
    ) {
        self.hierarchy
            .for_each_beyond(self.spheres, beyond, &mut |index| {
                if self.may_hide(index, but) {
                    visit(&self.spheres[index]);
                }
            });
    }

    /// True if a sphere may hide light from another one.
    pub(crate) fn may_hide(&self, sphere: usize, from: usize) -> bool {
        sphere != from && !is_within(&self.spheres[sphere], &self.spheres[from])
    }
}

/// True if a sphere is inside another, or outside of it by no more than rounding.
fn is_within(sphere: &Sphere, other: &Sphere) -> bool {
    const ROUNDING: f64 = 1e-14;
    let apart = (sphere.center() - other.center()).length();
    apart <= other.radius() - sphere.radius() + ROUNDING * other.radius()
}
