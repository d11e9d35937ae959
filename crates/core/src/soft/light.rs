//! The soft light of a world, at a point.

use glam::DVec3;

use super::cap::Cap;
use super::edges::Edge;
use super::point::{Occluders, SurfacePoint};
use super::sky::sky_light;
use super::sun::{Received, Sun};
use super::visible::Hidden;
use crate::model::color::Color;
use crate::model::light::DirectionalLight;
use crate::model::sky::Sky;
use crate::model::world::World;
use crate::search::beyond::Beyond;

/// One of the soft lights.
#[derive(Clone, Copy, Debug)]
pub(crate) enum SoftLight {
    Sun(Sun),
    Sky(Sky),
}

impl SoftLight {
    pub(crate) fn sun(light: &DirectionalLight) -> Self {
        Self::Sun(Sun {
            disc: Cap::within(light.toward(), 0.5 * light.diameter()),
            intensity: light.intensity(),
        })
    }

    /// A bound of the light of a white matte surface.
    pub(crate) fn brightest(&self) -> Color {
        match self {
            Self::Sun(sun) => sun.intensity,
            Self::Sky(sky) => sky.brightest(),
        }
    }

    /// False if there is no light at all, as in a frame whose keys have put it out.
    pub(crate) fn is_bright(&self) -> bool {
        self.brightest() != Color::ZERO
    }

    /// The light that a point reflects toward the eye.
    pub(crate) fn at(
        &self,
        point: &SurfacePoint,
        world: &World,
        occluders: Option<&Occluders<'_>>,
        hidden: &mut Hidden,
    ) -> Color {
        match self {
            Self::Sky(sky) => world.albedo(point.sphere) * sky_light(sky, point, occluders, hidden),
            Self::Sun(sun) => {
                let mut edges = Vec::new();
                if let Some(occluders) = occluders {
                    let toward = Beyond::Cone {
                        apex: point.position,
                        around: 0.0,
                        axis: sun.disc.axis,
                        sine: sun.disc.sine,
                        cosine: sun.disc.cosine,
                    };
                    occluders.for_each_sphere(point.sphere, &toward, |sphere| {
                        edges.push(Edge::Sphere {
                            center: sphere.center(),
                            radius: sphere.radius(),
                        });
                    });
                }
                sun_light(sun, point, sun.received(point, &edges, hidden), world)
            }
        }
    }
}

/// The light of a sun that a point reflects toward the eye.
pub(crate) fn sun_light(
    sun: &Sun,
    point: &SurfacePoint,
    received: Received,
    world: &World,
) -> Color {
    if received.share == 0.0 {
        return Color::ZERO;
    }
    let material = world.material(point.sphere);
    let diffuse = power(received.whole, material.exponent);
    let mut light = world.albedo(point.sphere) * diffuse;
    if let Some(highlight) = &material.highlight {
        light += Color::splat(highlight.strength * shine(sun, point, highlight.shininess));
    }
    light * sun.intensity * received.share
}

/// The power of n·h, with the middle of the disc for the light; 0 where that is not above the surface.
fn shine(sun: &Sun, point: &SurfacePoint, shininess: f64) -> f64 {
    let toward = sun.disc.axis;
    let cosine = point.shading.dot(toward);
    if cosine <= 0.0 {
        return 0.0;
    }
    let half: DVec3 = toward + point.to_eye;
    power(
        (point.shading.dot(half) / half.length()).clamp(0.0, 1.0),
        shininess,
    )
}

fn power(base: f64, exponent: f64) -> f64 {
    if exponent == 1.0 {
        base
    } else {
        libm::pow(base.clamp(0.0, 1.0), exponent)
    }
}
