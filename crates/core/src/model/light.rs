//! Lights.

use glam::DVec3;

use super::color::Color;
use super::emission::{Emission, unit};
use super::light_error::LightError;
use super::sphere::Sphere;

/// A light.
///
/// # Example
/// ```
/// use marbles_core::Light;
/// use marbles_core::glam::DVec3;
///
/// let sun = Light::directional(DVec3::new(0.0, 2.0, 0.0), DVec3::ONE)?;
/// assert_eq!(sun.toward(), Some(DVec3::Y));
/// assert_eq!(sun.intensity(), DVec3::ONE);
/// # Ok::<(), marbles_core::LightError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Light {
    /// So far away that its direction is the same everywhere.
    Directional(DirectionalLight),
    /// At a point.
    Point(PointLight),
}

/// A light so far away that its direction is the same everywhere.
///
/// # Example
/// ```
/// use marbles_core::glam::DVec3;
/// use marbles_core::{DirectionalLight, World};
///
/// let sun = DirectionalLight::new(DVec3::new(0.0, 3.0, 4.0), DVec3::ONE)?;
/// assert!((sun.toward() - DVec3::new(0.0, 0.6, 0.8)).length() < 1e-15);
/// let mut world = World::new();
/// world.lights.push(sun.into());
/// # Ok::<(), marbles_core::LightError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DirectionalLight {
    toward: DVec3,
    intensity: Color,
    diameter: f64,
}

/// A light at a point of the world.
///
/// # Example
/// ```
/// use marbles_core::glam::DVec3;
/// use marbles_core::{Light, LightFalloff, PointLight, Sphere};
///
/// // As bright as a directional light of intensity 1 at a distance of 2.
/// let lamp = PointLight::new(DVec3::ZERO, DVec3::ONE, LightFalloff::InverseSquare, 2.0)?;
/// // The nearest point of this sphere is 4 away: a quarter of that.
/// let sphere = Sphere::new(DVec3::new(0.0, 0.0, 5.0), 1.0)?;
/// let brightest = Light::from(lamp).brightest_on(&sphere);
/// assert!((brightest.x - 0.25).abs() < 1e-9);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PointLight {
    position: DVec3,
    intensity: Color,
    falloff: LightFalloff,
    reference: f64,
    emission: Option<Emission>,
}

/// The way in which a point light falls off with the distance.
///
/// # Example
/// ```
/// use marbles_core::glam::DVec3;
/// use marbles_core::{Light, LightFalloff, PointLight, Sphere};
///
/// let far = Sphere::new(DVec3::new(0.0, 0.0, 101.0), 1.0)?;
/// let brightest = |falloff| {
///     let lamp = PointLight::new(DVec3::ZERO, DVec3::ONE, falloff, 1.0)?;
///     Ok::<f64, marbles_core::LightError>(Light::from(lamp).brightest_on(&far).x)
/// };
/// assert_eq!(brightest(LightFalloff::None)?, 1.0);
/// assert!((brightest(LightFalloff::InverseSquare)? - 1e-4).abs() < 1e-9);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub enum LightFalloff {
    /// With its square.
    InverseSquare,
    /// Not at all.
    None,
}

impl Light {
    /// The directional light that [`DirectionalLight::new`] makes.
    ///
    /// # Errors
    /// Refuses a vector that has no direction.
    pub fn directional(toward: DVec3, intensity: Color) -> Result<Self, LightError> {
        DirectionalLight::new(toward, intensity).map(Self::Directional)
    }

    /// The radiance of a white surface that faces the light; for a point light, at its reference distance.
    pub fn intensity(&self) -> Color {
        match self {
            Self::Directional(light) => light.intensity,
            Self::Point(light) => light.intensity,
        }
    }

    /// The unit vector toward a directional light, in the world frame; `None` for a point light.
    pub fn toward(&self) -> Option<DVec3> {
        match self {
            Self::Directional(light) => Some(light.toward),
            Self::Point(_) => None,
        }
    }

    /// The light whose disc has a diameter, if it is one: a sun, whose shadows are soft.
    pub fn sun(&self) -> Option<&DirectionalLight> {
        match self {
            Self::Directional(light) => Some(light).filter(|light| light.diameter > 0.0),
            Self::Point(_) => None,
        }
    }

    /// The point light, if it is one.
    pub fn point(&self) -> Option<&PointLight> {
        match self {
            Self::Directional(_) => None,
            Self::Point(light) => Some(light),
        }
    }

    /// An upper bound of the radiance that the light gives a white surface on the outer side of a sphere.
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
    /// Creates the light that lies in the direction of `toward`, a vector in the world frame of any finite length.
    ///
    /// # Errors
    /// Refuses a vector that is zero or not finite: it has no direction.
    pub fn new(toward: DVec3, intensity: Color) -> Result<Self, LightError> {
        let toward = unit(toward).ok_or(LightError::Toward(toward))?;
        Ok(Self {
            toward,
            intensity,
            diameter: 0.0,
        })
    }

    /// The same light as a disc of this angular diameter in radians; 0 makes it a point again.
    ///
    /// # Errors
    /// Refuses a diameter that is negative, not a number, or not less than 180 degrees.
    pub fn with_diameter(self, diameter: f64) -> Result<Self, LightError> {
        if !(0.0..std::f64::consts::PI).contains(&diameter) {
            return Err(LightError::Diameter(diameter));
        }
        Ok(Self { diameter, ..self })
    }

    /// The angular diameter of its disc, in radians; 0 for a point.
    pub fn diameter(&self) -> f64 {
        self.diameter
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
    /// Creates a light at a point of the world. A white surface that faces it at the distance `reference` has the
    /// radiance `intensity`.
    ///
    /// # Errors
    /// Refuses a position that is not finite, and a distance that is not finite or not greater than 0.
    pub fn new(
        position: DVec3,
        intensity: Color,
        falloff: LightFalloff,
        reference: f64,
    ) -> Result<Self, LightError> {
        if !position.is_finite() {
            return Err(LightError::Position(position));
        }
        if !(reference > 0.0 && reference.is_finite()) {
            return Err(LightError::Reference(reference));
        }
        Ok(Self {
            position,
            intensity,
            falloff,
            reference,
            emission: None,
        })
    }

    /// The same light with an emission: its intensity is then that in the direction that it faces.
    #[must_use]
    pub fn with_emission(self, emission: Emission) -> Self {
        Self {
            emission: Some(emission),
            ..self
        }
    }

    /// The light that it sends in each direction; `None` if it sends as much in all of them.
    pub fn emission(&self) -> Option<&Emission> {
        self.emission.as_ref()
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

    /// The distance at which a white surface that faces it has the radiance [`Self::intensity`].
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
        if let Some(emission) = &self.emission {
            let ahead = (sphere.center() - self.position).dot(emission.direction());
            if ahead + sphere.radius() + slack <= 0.0 {
                return Color::ZERO;
            }
        }
        self.intensity * self.most_from(apart - sphere.radius() - slack)
    }
}
