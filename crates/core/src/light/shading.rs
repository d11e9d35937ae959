//! The light that a hit sends to the viewer.

use glam::DVec3;

use crate::hit::outcome::Hit;
use crate::model::color::Color;
use crate::model::ray::Ray;
use crate::model::roughness::PixelKey;
use crate::model::world::World;
use crate::numeric::power::Power;
use crate::search::visibility::Visibility;

/// Radiance of a sphere toward the origin of the ray that hit it.
#[cfg_attr(
    not(test),
    allow(dead_code, reason = "what rays side by side are tested against")
)]
pub(crate) fn shade(
    world: &World,
    visibility: &Visibility<'_>,
    ray: &Ray,
    sphere: usize,
    hit: &Hit,
    pixel: PixelKey,
) -> Color {
    if hit.inner_side {
        return shade_inner_side(world, sphere);
    }
    let point = Surface {
        sphere,
        normal: hit.normal,
        to_viewer: -ray.direction,
        pixel,
    };
    shade_lit(world, &point, |light| {
        let toward = world.lights[light].toward();
        let to_light = Ray {
            origin: ray.at(hit.t),
            direction: toward,
        };
        !world.shadows || !visibility.is_blocked(light, &to_light, ray.point_error(hit.t), sphere)
    })
}

/// Radiance of a sphere's inner side, which only the ambient light reaches.
pub(crate) fn shade_inner_side(world: &World, sphere: usize) -> Color {
    world.albedo(sphere) * world.ambient
}

/// A point of a sphere's outer side, and who looks at it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Surface {
    pub(crate) sphere: usize,
    /// Unit outward normal, in the world frame.
    pub(crate) normal: DVec3,
    /// The direction toward the viewpoint, of any length.
    pub(crate) to_viewer: DVec3,
    pub(crate) pixel: PixelKey,
}

/// Radiance of a point under those lights that it faces and for which `is_lit` holds.
pub(crate) fn shade_lit(world: &World, point: &Surface, is_lit: impl Fn(usize) -> bool) -> Color {
    let material = world.material(point.sphere);
    let normal = match &material.roughness {
        Some(roughness) => {
            let radius = world.spheres()[point.sphere].radius();
            roughness.perturb(point.normal, radius, point.sphere, point.pixel)
        }
        None => point.normal,
    };
    let mut diffuse = world.ambient;
    let mut mirrored = Color::ZERO;
    let falloff = Power::new(material.exponent);
    let highlight = material
        .highlight
        .map(|highlight| (highlight.strength, Power::new(highlight.shininess)));
    for (index, light) in world.lights.iter().enumerate() {
        let facing = normal.dot(light.toward());
        if facing <= 0.0 || !is_lit(index) {
            continue;
        }
        let intensity = light.intensity();
        diffuse += intensity * falloff.scalar(facing);
        if let Some((strength, falloff)) = &highlight {
            let half = half_vector(light.toward(), point.to_viewer);
            let spot = falloff.scalar(normal.dot(half));
            mirrored += intensity * (*strength * spot);
        }
    }
    world.albedo(point.sphere) * diffuse + mirrored
}

/// Unit vector half-way between a unit vector and a vector of any length; zero where they are
/// opposite.
fn half_vector(light: DVec3, view: DVec3) -> DVec3 {
    // A power of two taken out first changes nothing but that no square over- or underflows.
    // (Zero has no exponent: it stays zero with any.)
    let exponent = libm::ilogb(view.abs().max_element()).clamp(-1100, 1100);
    let view = view.map(|part| libm::scalbn(part, -exponent));
    (light + view.normalize_or_zero()).normalize_or_zero()
}
