//! Which sphere a ray meets.

use crate::{Hit, Ray, Sphere, World};

/// Answers which sphere a ray meets first, and whether it meets any.
///
/// Searches all spheres; a hierarchy over them can fill the same two questions.
#[derive(Clone, Copy, Debug)]
pub struct Visibility<'world> {
    spheres: &'world [Sphere],
}

impl<'world> Visibility<'world> {
    /// Prepares the search in a world.
    pub fn new(world: &'world World) -> Self {
        Self {
            spheres: world.spheres(),
        }
    }

    /// The first sphere along the ray, by index, and where it is hit; of coincident surfaces the
    /// sphere with the lower index.
    pub fn nearest(&self, ray: &Ray) -> Option<(usize, Hit)> {
        let mut nearest: Option<(usize, Hit)> = None;
        for (index, sphere) in self.spheres.iter().enumerate() {
            if let Some(hit) = sphere.hit(ray)
                && nearest.is_none_or(|(_, nearer)| hit.t < nearer.t)
            {
                nearest = Some((index, hit));
            }
        }
        nearest
    }

    /// Whether the ray meets any sphere but the one with the index `except`.
    pub fn is_blocked(&self, ray: &Ray, except: usize) -> bool {
        self.spheres
            .iter()
            .enumerate()
            .any(|(index, sphere)| index != except && sphere.hit(ray).is_some())
    }
}
