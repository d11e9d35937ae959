//! The light of a sky at a node.

use glam::{DVec2, DVec3};

use crate::model::sphere::Sphere;

/// The parts of the light from the lower and from the upper half of a sky that reach a point. Of a sky of one radiance the
/// first one is that of all of it, and the second one 0.
pub(crate) type Shares = DVec2;

/// Spheres of which a node knows how its light changes with them. Not tuned.
pub(crate) const NEAREST: usize = 4;

/// How light changes with the cosine of the angle under which a sphere is seen.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Slope {
    /// None: infinitely far.
    pub(crate) sphere: Option<u32>,
    /// How high the node is above the sphere. Negative inside of it.
    pub(crate) height: f32,
    /// The first and the second derivative.
    pub(crate) by_cosine: Shares,
    pub(crate) twice_by_cosine: Shares,
}

/// Stands for a sphere that is infinitely far, or of which nothing is seen.
pub(crate) const FAR: Slope = Slope {
    sphere: None,
    height: f32::INFINITY,
    by_cosine: Shares::ZERO,
    twice_by_cosine: Shares::ZERO,
};

/// The light at a node.
#[derive(Clone, Copy, Debug)]
pub(crate) struct NodeLight {
    pub(crate) shares: Shares,
    /// How both shares change with the normal, while the cosines of the spheres below stay what they are.
    pub(crate) by_normal: [DVec3; 2],
    /// The slopes of the nearest spheres that something is seen beside, the nearest one first.
    pub(crate) slopes: [Slope; NEAREST],
}

impl Default for NodeLight {
    fn default() -> Self {
        Self {
            shares: Shares::ZERO,
            by_normal: [DVec3::ZERO; 2],
            slopes: [FAR; NEAREST],
        }
    }
}

impl NodeLight {
    /// Adds how light at a node changes with the cosine of a sphere, and with the normal by the axis of its cap. The node lies at
    /// this place of a sphere with this radius. If there are too many slopes, the one of the farthest sphere becomes a part of
    /// how light changes with the normal.
    pub(crate) fn add(
        &mut self,
        slope: Slope,
        by_axis: [DVec3; 2],
        (place, radius): (DVec3, f64),
        spheres: &[Sphere],
    ) {
        for (sum, by_axis) in self.by_normal.iter_mut().zip(by_axis) {
            *sum += by_axis;
        }
        let mut slope = slope;
        for known in &mut self.slopes {
            if slope.height < known.height {
                std::mem::swap(known, &mut slope);
            }
        }
        if let Some(sphere) = slope.sphere {
            let by_normal = cosine_by_normal(radius, &spheres[sphere as usize], place);
            self.by_normal[0] += by_normal * slope.by_cosine.x;
            self.by_normal[1] += by_normal * slope.by_cosine.y;
        }
    }

    /// How light changes with a sphere at some height; not known of spheres that are farther than those of a full list.
    pub(crate) fn slope(&self, sphere: u32, height: f64) -> Option<Slope> {
        let known = self
            .slopes
            .iter()
            .find(|known| known.sphere == Some(sphere));
        match known {
            Some(known) => Some(*known),
            // It would be in the list if something were seen beside it.
            None => (height < self.slopes[NEAREST - 1].height.into()).then_some(FAR),
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

/// How that cosine changes with the normal of a point of a sphere with this radius; 0 where it is 0.
pub(crate) fn cosine_by_normal(radius: f64, sphere: &Sphere, place: DVec3) -> DVec3 {
    let (_, cosine) = height_and_cosine(sphere, place);
    if cosine == 0.0 {
        return DVec3::ZERO;
    }
    let away = place - sphere.center();
    let square = away.length_squared();
    let sine_squared = sphere.radius() * sphere.radius() / square;
    away * (radius * sine_squared / (square * cosine))
}
