//! Spheres that cast shadows, away from directional lights and from point lights.

use glam::DVec3;

/// A sphere as a light sees it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Caster {
    pub(crate) center: DVec3,
    pub(crate) radius: f64,
    /// Unit vectors across the light.
    pub(crate) right: DVec3,
    pub(crate) up: DVec3,
    /// Its cone, seen from a point light, for which the vectors across mean nothing.
    pub(crate) cone: Option<Cone>,
}

/// The cone that a sphere fills, seen from a point outside of it: what lies in it, beyond the sphere, is in its shadow.
///
/// With a from the apex to the sphere's center, v to a point and K = |a|² − r², v lies inside where
/// (v · a)² > |v|² K, and v · a > K beyond the circle in which the cone touches the sphere, for points outside of
/// that one.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Cone {
    pub(crate) apex: DVec3,
    /// a.
    pub(crate) axis: DVec3,
    /// K.
    pub(crate) power: f64,
}

impl Cone {
    pub(crate) fn new(apex: DVec3, center: DVec3, radius: f64) -> Self {
        let axis = center - apex;
        let length = axis.length();
        Self {
            apex,
            axis,
            power: (length - radius) * (length + radius),
        }
    }

    /// Returns whether all of a ball lies in the shadow, by more than rounding.
    pub(crate) fn contains(&self, middle: DVec3, around: f64) -> bool {
        let distance = self.axis.length();
        let unit = self.axis / distance;
        let cosine = self.power.max(0.0).sqrt() / distance;
        let sine = ((1.0 - cosine) * (1.0 + cosine)).sqrt();
        let way = middle - self.apex;
        let along = way.dot(unit);
        let aside = (way - unit * along).length();
        let around = around + 1e-9 * (way.length() + distance);
        along * sine - aside * cosine > around && along - around > self.power / distance
    }
}
