//! Lights.

use glam::DVec3;

use super::color::Color;

/// A light so far away that its direction is the same everywhere.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DirectionalLight {
    toward: DVec3,
    intensity: Color,
}

impl DirectionalLight {
    /// The light that lies in the direction of `toward`, a world vector of any finite length.
    ///
    /// `None` where the vector is zero or not finite: it has no direction.
    pub fn new(toward: DVec3, intensity: Color) -> Option<Self> {
        // The largest component becomes 1 first, so that no square over- or underflows.
        let largest = toward.abs().max_element();
        let toward = (toward / largest).try_normalize()?;
        Some(Self { toward, intensity })
    }

    /// Unit vector toward the light, in the world frame.
    pub fn toward(&self) -> DVec3 {
        self.toward
    }

    /// Radiance of a white surface that faces the light.
    pub fn intensity(&self) -> Color {
        self.intensity
    }
}
