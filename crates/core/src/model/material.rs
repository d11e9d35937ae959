//! Materials of surfaces.

use glam::DVec3;

use super::color::Color;
use super::outline::Outline;

/// The answer of a surface to light.
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
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Highlight {
    /// Radiance at the brightest point under a light of intensity 1, at least 0.
    pub strength: f64,
    /// Exponent, greater than 0: the larger, the smaller the spot.
    pub shininess: f64,
}

/// A perturbation of the shading normal by random numbers in [−1, 1): see [`Grain`].
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
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Grain {
    /// To the surface: smooth noise with cells of this size, in scene units, greater than 0. It tilts
    /// normals, alike in all directions: what of the vector of three numbers is across the normal is added
    /// to it, times the amplitude.
    Surface(f64),
    /// To the picture: an independent draw for each pixel and frame. Each component of the normal is
    /// multiplied by a number from 1 − amplitude to 1 + amplitude.
    Pixel,
}
