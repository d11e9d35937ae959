//! Lights.

use glam::DVec3;

use super::color::Color;
use super::sphere::Sphere;

/// A light.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Light {
    /// So far away that its direction is the same everywhere.
    Directional(DirectionalLight),
    /// At a point.
    Point(PointLight),
}

/// A light so far away that its direction is the same everywhere.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DirectionalLight {
    toward: DVec3,
    intensity: Color,
}

/// A light at a point of the world.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PointLight {
    position: DVec3,
    intensity: Color,
    falloff: LightFalloff,
    reference: f64,
}

/// The way in which a point light falls off with the distance.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub enum LightFalloff {
    /// With its square.
    InverseSquare,
    /// Not at all.
    None,
}

impl Light {
    /// The directional light that [`DirectionalLight::new`] makes.
    pub fn directional(toward: DVec3, intensity: Color) -> Option<Self> {
        DirectionalLight::new(toward, intensity).map(Self::Directional)
    }

    /// Radiance of a white surface that faces the light, from the reference distance of a point light.
    pub fn intensity(&self) -> Color {
        match self {
            Self::Directional(light) => light.intensity,
            Self::Point(light) => light.intensity,
        }
    }

    /// The unit vector toward a directional light, in the world frame.
    pub fn toward(&self) -> Option<DVec3> {
        match self {
            Self::Directional(light) => Some(light.toward),
            Self::Point(_) => None,
        }
    }

    /// The light as one at a point, if it is.
    pub fn point(&self) -> Option<&PointLight> {
        match self {
            Self::Directional(_) => None,
            Self::Point(light) => Some(light),
        }
    }

    /// A bound of the radiance of a white surface on the outer side of a sphere.
    pub fn brightest_on(&self, sphere: &Sphere) -> Color {
        match self {
            Self::Directional(light) => light.intensity,
            Self::Point(light) => light.brightest_on(sphere),
        }
    }
}

impl From<DirectionalLight> for Light {
    fn from(light: DirectionalLight) -> Self {
        Self::Directional(light)
    }
}

impl From<PointLight> for Light {
    fn from(light: PointLight) -> Self {
        Self::Point(light)
    }
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

impl PointLight {
    /// The light at a point of the world. Its intensity is that of a white surface at the distance `reference` that
    /// faces it.
    ///
    /// `None` where a number is not finite, or the distance not greater than 0.
    pub fn new(
        position: DVec3,
        intensity: Color,
        falloff: LightFalloff,
        reference: f64,
    ) -> Option<Self> {
        let is_sound = position.is_finite() && reference.is_finite() && reference > 0.0;
        is_sound.then_some(Self {
            position,
            intensity,
            falloff,
            reference,
        })
    }

    /// Its place in the world.
    pub fn position(&self) -> DVec3 {
        self.position
    }

    /// Radiance of a white surface at the reference distance that faces the light.
    pub fn intensity(&self) -> Color {
        self.intensity
    }

    /// The way in which it falls off.
    pub fn falloff(&self) -> LightFalloff {
        self.falloff
    }

    /// The distance at which its intensity is what it is said to be.
    pub fn reference(&self) -> f64 {
        self.reference
    }

    /// The reference distance of a light that falls off.
    pub(crate) fn falls_off_from(&self) -> Option<f64> {
        match self.falloff {
            LightFalloff::InverseSquare => Some(self.reference),
            LightFalloff::None => None,
        }
    }

    /// A bound of the factor by which its intensity is larger at some distance and beyond.
    fn most_from(&self, distance: f64) -> f64 {
        self.falls_off_from().map_or(1.0, |reference| {
            let ratio = reference / distance.max(0.0);
            // An infinite one would make darkness no number.
            (ratio * ratio).min(f64::MAX.sqrt())
        })
    }

    fn brightest_on(&self, sphere: &Sphere) -> Color {
        let apart = (sphere.center() - self.position).length();
        if apart < sphere.radius() {
            // It is inside.
            return Color::ZERO;
        }
        // What rounding takes from the difference counts for the light.
        let slack = 1e-12 * (apart + sphere.radius());
        self.intensity * self.most_from(apart - sphere.radius() - slack)
    }
}
