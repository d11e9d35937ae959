//! A sphere that may be seen in a cell.

use glam::DVec3;

use crate::edges::cell::Ball;
use crate::edges::terminator::Plane;
use crate::exact::scene::InCamera;
use crate::model::material::Grain;
use crate::model::roughness::PixelKey;
use crate::numeric::polynomial::{Linear, Quadratic};

/// A sphere that may be seen in a cell.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Active {
    pub(crate) sphere: usize,
    pub(crate) ball: Ball,
    /// The discriminant Q of the ray.
    pub(crate) discriminant: Quadratic,
    /// d · c, for parallel rays the center's distance from their plane.
    pub(crate) along: Linear,
    pub(crate) terminators: Terminators,
    /// Whether no light reaches it, as inside of a sphere.
    pub(crate) is_dark: bool,
}

/// The place where the surface of a sphere turns from a light.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Terminators {
    /// On the great circle across the light.
    Plain,
    /// On another great circle: these factors of normals, in the world's frame, tilt it.
    Tilted(DVec3),
    /// Inside bumps.
    Anywhere,
    /// Nowhere: light goes on with the other sign.
    Nowhere,
}

impl Terminators {
    pub(crate) fn of(scene: &InCamera<'_>, sphere: usize, pixel: PixelKey) -> Self {
        let Some(roughness) = &scene.world.material(sphere).roughness else {
            return Self::Plain;
        };
        match roughness.grain {
            // The factors bend that of a point light.
            Grain::Pixel if scene.has_near_lights => Self::Anywhere,
            Grain::Pixel => Self::Tilted(roughness.pixel_factors(sphere, pixel)),
            Grain::Surface(_) => Self::Anywhere,
        }
    }

    /// The plane of the terminator of a light on a ball, whose axis is on the side that faces it: with
    /// factors w, (n ∘ w) · l = n · (w ∘ l).
    pub(crate) fn plane(&self, scene: &InCamera<'_>, ball: &Ball, light: usize) -> Option<Plane> {
        let toward = match &scene.lights[light].near {
            None => scene.lights[light].toward,
            Some(_) if matches!(self, Self::Anywhere | Self::Nowhere) => return None,
            Some(near) => return Plane::of_near_light(near.position - ball.center, ball.radius),
        };
        let axis = match self {
            Self::Plain => Some(toward),
            Self::Tilted(factors) => {
                let to_world = scene.world_from_camera;
                let tilted = *factors * (to_world * toward);
                Some((to_world.transpose() * tilted).normalize())
            }
            Self::Anywhere | Self::Nowhere => None,
        };
        axis.map(|axis| Plane { axis, offset: 0.0 })
    }
}
