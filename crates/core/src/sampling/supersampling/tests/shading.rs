//! The light that one hit sends to the viewer: what that of eight rays is tested against.

use glam::DVec3;

use crate::hit::outcome::Hit;
use crate::model::color::Color;
use crate::model::ray::Ray;
use crate::model::roughness::PixelKey;
use crate::model::world::World;
use crate::numeric::power::Power;
use crate::search::visibility::Visibility;

/// Radiance of a sphere toward the origin of the ray that hit it.
pub(super) fn shade(
    world: &World,
    visibility: &Visibility<'_>,
    ray: &Ray,
    sphere: usize,
    hit: &Hit,
    pixel: PixelKey,
) -> Color {
    if hit.inner_side {
        // Only the ambient light gets there.
        return world.albedo(sphere) * world.ambient;
    }
    let material = world.material(sphere);
    let normal = match &material.roughness {
        Some(roughness) => {
            let radius = world.spheres()[sphere].radius();
            roughness.perturb(hit.normal, radius, sphere, pixel)
        }
        None => hit.normal,
    };
    let mut diffuse = world.ambient;
    let mut mirrored = Color::ZERO;
    for (index, light) in world.lights.iter().enumerate() {
        let toward = light.toward().unwrap();
        let cosine = normal.dot(toward);
        let to_light = Ray {
            origin: ray.at(hit.t),
            direction: toward,
        };
        let is_blocked = || visibility.is_blocked(index, &to_light, ray.point_error(hit.t), sphere);
        if cosine <= 0.0 || world.shadows && is_blocked() {
            continue;
        }
        diffuse += light.intensity() * Power::new(material.exponent).scalar(cosine);
        if let Some(highlight) = &material.highlight {
            let half = half_vector(toward, -ray.direction);
            let power = Power::new(highlight.shininess).scalar(normal.dot(half));
            mirrored += light.intensity() * (highlight.strength * power);
        }
    }
    world.albedo(sphere) * diffuse + mirrored
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
