//! The first of many spheres on a ray.

use std::cmp::Ordering;

use super::outcome::Hit;
use crate::model::ray::Ray;
use crate::model::sphere::Sphere;
use crate::model::world::World;

impl World {
    /// The index of the first sphere on a ray, and where the ray hits it; `None` if the ray meets no sphere.
    ///
    /// Where surfaces coincide, the sphere with the lowest index is the first. This compares the ray with every sphere. For
    /// the rays of a whole picture, [`Renderer::geometry`](crate::Renderer::geometry) is much faster.
    ///
    /// # Accuracy
    /// The decision which sphere is the first is exact, even if the distances round to the same number. For the hit,
    /// [`Sphere::hit`] gives the bounds.
    ///
    /// # Example
    /// ```
    /// use marbles_core::glam::DVec3;
    /// use marbles_core::{Material, Ray, Sphere, World};
    ///
    /// let mut world = World::new();
    /// let white = world.add_material(Material::default());
    /// world.add_sphere(Sphere::new(DVec3::new(0.0, 0.0, 9.0), 1.0)?, white);
    /// world.add_sphere(Sphere::new(DVec3::new(0.0, 0.0, 6.0), 1.0)?, white);
    /// let ray = Ray { origin: DVec3::ZERO, direction: DVec3::Z };
    /// let (index, hit) = world.hit(&ray).ok_or("a miss")?;
    /// assert_eq!((index, hit.t, hit.normal), (1, 5.0, -DVec3::Z));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn hit(&self, ray: &Ray) -> Option<(usize, Hit)> {
        nearest(self.spheres(), ray)
    }
}

/// The first sphere on a ray: what [`World::hit`] returns.
pub(crate) fn nearest(spheres: &[Sphere], ray: &Ray) -> Option<(usize, Hit)> {
    let mut nearest: Option<(usize, Hit)> = None;
    for (index, sphere) in spheres.iter().enumerate() {
        let Some(hit) = sphere.hit(ray) else { continue };
        let is_nearer = nearest.as_ref().is_none_or(|(other, other_hit)| {
            sphere.compare(&hit, &spheres[*other], other_hit, ray) == Ordering::Less
        });
        if is_nearer {
            nearest = Some((index, hit));
        }
    }
    nearest
}

#[cfg(test)]
mod tests {
    use glam::DVec3;

    use super::*;

    const RAY: Ray = Ray {
        origin: DVec3::ZERO,
        direction: DVec3::Z,
    };

    fn ball(z: f64, radius: f64) -> Sphere {
        Sphere::new(DVec3::new(0.0, 0.0, z), radius).unwrap()
    }

    /// The distances of both balls are 9 in doubles.
    #[test]
    fn equal_distances_are_told_apart() {
        let [small, large] = [1.0, 1.0_f64.next_up()].map(|radius| ball(10.0, radius));
        for (spheres, first) in [([small, large], 1), ([large, small], 0)] {
            let (index, hit) = nearest(&spheres, &RAY).unwrap();
            assert_eq!((index, hit.t), (first, 9.0));
        }
    }

    #[test]
    fn of_coincident_surfaces_the_lowest_index_is_first() {
        let found = nearest(&[ball(20.0, 1.0), ball(10.0, 1.0), ball(10.0, 1.0)], &RAY);
        assert_eq!(found.map(|(index, _)| index), Some(1));
        assert_eq!(nearest(&[ball(-10.0, 1.0)], &RAY), None);
    }
}
