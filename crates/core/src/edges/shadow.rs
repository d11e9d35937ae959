//! Spheres that cast shadows.

use glam::DVec3;

/// A sphere as a light sees it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Caster {
    pub(crate) center: DVec3,
    pub(crate) radius: f64,
    /// Unit vectors across the light.
    pub(crate) right: DVec3,
    pub(crate) up: DVec3,
}
