//! Materials of surfaces.

use glam::DVec3;

use super::color::Color;
use super::outline::Outline;

/// The way in which a surface reflects light.
///
/// # Example
/// ```
/// use marbles_core::glam::DVec3;
/// use marbles_core::{Highlight, Material};
///
/// let red = Material {
///     albedo: DVec3::new(0.9, 0.2, 0.15),
///     highlight: Some(Highlight::default()),
///     ..Material::default()
/// };
/// assert_eq!(red.exponent, 1.0); // Lambert's law
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Material {
    /// Fraction of the light that is scattered, per channel.
    pub albedo: Color,
    /// Contrast exponent of n·l, greater than 0; 1 is Lambert's law.
    pub exponent: f64,
    /// The mirror-like spot, if any.
    pub highlight: Option<Highlight>,
    /// The bumps, if any.
    pub roughness: Option<Roughness>,
    /// The line of one color along the contour, if any.
    pub outline: Option<Outline>,
}

impl Material {
    /// Matte white: Lambert's law, everything scattered.
    pub const MATTE_WHITE: Self = Self {
        albedo: DVec3::ONE,
        exponent: 1.0,
        highlight: None,
        roughness: None,
        outline: None,
    };
}

/// Matte white.
impl Default for Material {
    fn default() -> Self {
        Self::MATTE_WHITE
    }
}

/// The strength 0.5 and the shininess 40, as in scene files.
impl Default for Highlight {
    fn default() -> Self {
        Self {
            strength: 0.5,
            shininess: 40.0,
        }
    }
}

/// A highlight, `strength · max(0, n·h)^shininess` with h half-way between light and viewer.
///
/// # Example
/// ```
/// # use marbles_core::glam::DVec3;
/// # use marbles_core::{Angle, Camera, Lens, Material, Sphere, View, World, Highlight, Light, Renderer, Settings};
/// # let mut world = World::new();
/// # let white = world.add_material(Material {
/// #     highlight: Some(Highlight { strength: 0.25, shininess: 1.0 }),
/// #     albedo: DVec3::ZERO,
/// #     ..Material::default()
/// # });
/// # world.add_sphere(Sphere::new(DVec3::new(0.0, 0.0, 5.0), 1.0)?, white);
/// # let lens = Lens::from_field_of_view(Angle::from_degrees(0.01))?;
/// # let view = View::new(Camera::default(), lens, 16, 16);
/// // A black ball with this highlight, seen from the light: n·h is 1 in the middle.
/// let highlight = Highlight { strength: 0.25, shininess: 1.0 };
/// # assert_eq!(world.material(0).highlight, Some(highlight));
/// world.lights.push(Light::directional(DVec3::NEG_Z, DVec3::ONE)?);
/// let image = Renderer::new(&world).render(&view, &Settings::default());
/// assert!((image.rgba(8, 8)[0] - highlight.strength).abs() < 1e-3);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Highlight {
    /// Radiance at the brightest point under a light of intensity 1, at least 0.
    pub strength: f64,
    /// Exponent, greater than 0: the larger, the smaller the spot.
    pub shininess: f64,
}

/// A perturbation of the shading normal by random numbers in [−1, 1): see [`Grain`].
///
/// # Example
/// ```
/// use marbles_core::glam::DVec3;
/// use marbles_core::{Grain, Material, Roughness, Sphere, World};
///
/// let rough = Roughness { amplitude: 0.3, grain: Grain::Surface(0.1), seed: 1 };
/// let mut world = World::new();
/// let bumpy = world.add_material(Material { roughness: Some(rough), ..Material::default() });
/// world.add_sphere(Sphere::new(DVec3::new(0.0, 0.0, 5.0), 1.0)?, bumpy);
/// assert!(world.has_bumps());
/// # Ok::<(), marbles_core::SphereError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Roughness {
    /// From 0 (smooth) up to, not including, 1.
    pub amplitude: f64,
    /// The thing that the numbers are attached to.
    pub grain: Grain,
    /// Seed of the numbers.
    pub seed: u64,
}

/// The thing that the random numbers of a rough surface are attached to.
///
/// # Example
/// ```
/// # use std::num::NonZeroU32;
/// # use marbles_core::glam::DVec3;
/// # use marbles_core::{Angle, Camera, Grain, Image, Lens, Light, Material, Method, Renderer};
/// # use marbles_core::{Roughness, Settings, Sphere, View, World};
/// // Renders a frame of a still ball with these bumps.
/// let frame = |grain: Grain, frame: i64| -> Result<Image, Box<dyn std::error::Error>> {
///     let roughness = Some(Roughness { amplitude: 0.3, grain, seed: 1 });
/// #     let mut world = World::new();
/// #     let bumpy = world.add_material(Material { roughness, ..Material::default() });
/// #     world.add_sphere(Sphere::new(DVec3::new(0.0, 0.0, 5.0), 1.0)?, bumpy);
/// #     world.lights.push(Light::directional(DVec3::NEG_Z, DVec3::ONE)?);
/// #     let lens = Lens::from_field_of_view(Angle::from_degrees(40.0))?;
/// #     let view = View { frame, ..View::new(Camera::default(), lens, 8, 8) };
/// #     let settings = Settings { method: Method::Samples(NonZeroU32::MIN), alpha: false };
///     // …
/// #     Ok(Renderer::new(&world).render(&view, &settings))
/// };
/// assert_eq!(frame(Grain::Surface(0.1), 1)?, frame(Grain::Surface(0.1), 2)?);
/// assert_ne!(frame(Grain::Pixel, 1)?, frame(Grain::Pixel, 2)?);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Grain {
    /// The surface: smooth noise with cells of this size, in scene units, greater than 0. Bumps repeat about every three
    /// cells; a tenth of the radius gives a clearly bumpy ball. The noise tilts normals equally in all directions: the
    /// part of the vector of three numbers that is perpendicular to the normal is multiplied by the amplitude and added to
    /// the normal.
    Surface(f64),
    /// The picture: an independent draw for each pixel and frame. Each component of the normal is multiplied by a
    /// number from 1 − amplitude to 1 + amplitude.
    Pixel,
}
