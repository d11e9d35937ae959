//! Which sphere a ray meets.

use glam::DVec3;

use crate::sphere::Relative;
use crate::{Hit, Ray, Sphere, World};

/// Answers which sphere is seen from a viewpoint, and whether any stands in the way of a ray.
///
/// Searches all spheres; a hierarchy over them can fill the same two questions. Every answer is
/// exact for the given doubles.
#[derive(Clone, Debug)]
pub struct Visibility<'world> {
    spheres: &'world [Sphere],
    viewpoint: DVec3,
    /// The spheres as seen from the viewpoint, which all rays of a camera share.
    from_viewpoint: Vec<Relative>,
}

impl<'world> Visibility<'world> {
    /// Prepares the search in a world, as seen from a viewpoint.
    pub fn new(world: &'world World, viewpoint: DVec3) -> Self {
        let spheres = world.spheres();
        let from_viewpoint = spheres
            .iter()
            .map(|sphere| sphere.relative_to(viewpoint))
            .collect();
        Self {
            spheres,
            viewpoint,
            from_viewpoint,
        }
    }

    /// The first sphere in a direction from the viewpoint, by index, and where it is hit; of
    /// coincident surfaces the sphere with the lower index.
    pub fn nearest(&self, direction: DVec3) -> Option<(usize, Hit)> {
        let ray = Ray {
            origin: self.viewpoint,
            direction,
        };
        let direction_sq = direction.length_squared();
        let mut nearest: Option<(usize, Hit)> = None;
        for (index, (sphere, relative)) in self.spheres.iter().zip(&self.from_viewpoint).enumerate()
        {
            let Some(hit) = sphere.hit_from_viewpoint(relative, &ray, direction_sq) else {
                continue;
            };
            let is_nearer = nearest.as_ref().is_none_or(|(other, other_hit)| {
                sphere.is_nearer(&hit, &self.spheres[*other], other_hit, &ray)
            });
            if is_nearer {
                nearest = Some((index, hit));
            }
        }
        nearest
    }

    /// Whether any sphere but the one with the index `except` stands between a point of that
    /// one's surface, known up to a distance of `point_error`, and a light.
    ///
    /// Another sphere whose surface passes through the point within that error hides the light if
    /// it lies toward it: coincident spheres do not darken each other, touching ones do not leak.
    pub fn is_blocked(&self, to_light: &Ray, point_error: f64, except: usize) -> bool {
        let mut spheres = self.spheres.iter().enumerate();
        spheres.any(|(index, sphere)| index != except && sphere.is_met(to_light, point_error))
    }
}
