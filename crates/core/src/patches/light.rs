//! The light of a sky at a node.

use glam::{DVec2, DVec3};

use crate::model::sphere::Sphere;

/// The parts of the light from the lower and from the upper half of a sky that reach a point. Of a sky of one radiance the
/// first one is that of all of it, and the second one 0.
pub(crate) type Shares = DVec2;

/// Spheres of which a node knows how its light changes with them. Not tuned.
pub(crate) const NEAREST: usize = 6;

/// How light changes with the cosine of the angle under which a sphere is seen.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Slope {
    /// None: infinitely far.
    pub(crate) sphere: Option<u32>,
    /// How high the node is above the sphere. Negative inside of it.
    pub(crate) height: f32,
    pub(crate) by_cosine: Shares,
}

/// The light at a node.
#[derive(Clone, Copy, Debug)]
pub(crate) struct NodeLight {
    pub(crate) shares: Shares,
    /// Those of the nearest spheres that something is seen beside, the nearest one first.
    pub(crate) slopes: [Slope; NEAREST],
}

impl Default for NodeLight {
    fn default() -> Self {
        let far = Slope {
            sphere: None,
            height: f32::INFINITY,
            by_cosine: Shares::ZERO,
        };
        Self {
            shares: Shares::ZERO,
            slopes: [far; NEAREST],
        }
    }
}

impl NodeLight {
    /// Adds the slope of a sphere, which takes the place of a farther one if there are many.
    pub(crate) fn add(&mut self, slope: Slope) {
        let mut slope = slope;
        for known in &mut self.slopes {
            if slope.height < known.height {
                std::mem::swap(known, &mut slope);
            }
        }
    }

    /// How light changes with a sphere at some height; not known of spheres that are farther than those of a full list.
    pub(crate) fn slope(&self, sphere: u32, height: f64) -> Option<Shares> {
        let known = self
            .slopes
            .iter()
            .find(|known| known.sphere == Some(sphere));
        match known {
            Some(known) => Some(known.by_cosine),
            // It would be in the list if something were seen beside it.
            None => (height < self.slopes[NEAREST - 1].height.into()).then_some(Shares::ZERO),
        }
    }
}

/// How high a place is above a sphere, and the cosine of the angle under which the sphere is seen from there: 0 inside of it.
pub(crate) fn height_and_cosine(sphere: &Sphere, place: DVec3) -> (f64, f64) {
    // A node may be its center.
    let distance = (sphere.center() - place).length().max(f64::MIN_POSITIVE);
    let height = distance - sphere.radius();
    let square = height.max(0.0) * (distance + sphere.radius());
    (height, square.sqrt() / distance)
}
