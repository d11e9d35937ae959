//! Points of surfaces, and the spheres that may hide light from them.

use glam::DVec3;

use super::cap::Cap;
use crate::model::sphere::Sphere;
use crate::search::beyond::Beyond;
use crate::search::hierarchy::Hierarchy;

/// A point of a sphere, seen from outside, in the world's frame.
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

/// The spheres that hide light from each other.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Occluders<'world> {
    pub(crate) spheres: &'world [Sphere],
    pub(crate) hierarchy: &'world Hierarchy,
}

impl Occluders<'_> {
    /// Calls `visit` with the caps of all spheres but the point's own that may lie in some directions. A sphere that
    /// coincides with the own one hides nothing.
    pub(crate) fn for_each(
        &self,
        point: &SurfacePoint,
        beyond: &Beyond,
        mut visit: impl FnMut(Cap),
    ) {
        let own = &self.spheres[point.sphere];
        self.hierarchy
            .for_each_beyond(self.spheres, beyond, |index| {
                let sphere = &self.spheres[index];
                if index != point.sphere && sphere != own {
                    visit(Cap::of_sphere(
                        sphere.center() - point.position,
                        sphere.radius(),
                    ));
                }
            });
    }
}
