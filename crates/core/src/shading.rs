//! The light that a hit sends to the viewer.

use glam::DVec3;

use crate::roughness::PixelKey;
use crate::visibility::Visibility;
use crate::{Hit, Radiance, Ray, World};

/// Radiance of a sphere toward the origin of the ray that hit it.
pub(crate) fn shade<C: Radiance>(
    world: &World,
    visibility: &Visibility<'_>,
    ray: &Ray,
    sphere: usize,
    hit: &Hit,
    pixel: PixelKey,
) -> C {
    let material = world.material(sphere);
    let albedo = C::from_color(material.albedo);
    let mut diffuse = C::from_color(world.ambient);
    if hit.inner_side {
        return albedo * diffuse;
    }
    let normal = match &material.roughness {
        Some(roughness) => {
            let radius = world.spheres()[sphere].radius();
            roughness.perturb(hit.normal, radius, sphere, pixel)
        }
        None => hit.normal,
    };
    let mut mirrored = C::ZERO;
    for (index, light) in world.lights.iter().enumerate() {
        let facing = normal.dot(light.toward());
        if facing <= 0.0 {
            continue;
        }
        if world.shadows {
            let to_light = Ray {
                origin: ray.at(hit.t),
                direction: light.toward(),
            };
            if visibility.is_blocked(index, &to_light, ray.point_error(hit.t), sphere) {
                continue;
            }
        }
        let intensity = C::from_color(light.intensity());
        diffuse += intensity * power(facing, material.exponent);
        if let Some(highlight) = &material.highlight {
            let half = half_vector(light.toward(), -ray.direction);
            let spot = power(normal.dot(half).max(0.0), highlight.shininess);
            mirrored += intensity * (highlight.strength * spot);
        }
    }
    albedo * diffuse + mirrored
}

/// Unit vector half-way between a unit vector and a vector of any length; zero where they are
/// opposite.
fn half_vector(light: DVec3, view: DVec3) -> DVec3 {
    // A power of two taken out first changes nothing but that no square over- or underflows.
    let exponent = libm::ilogb(view.abs().max_element());
    let view = view.map(|part| libm::scalbn(part, -exponent));
    (light + view.normalize_or_zero()).normalize_or_zero()
}

/// `base` to the power of `exponent`, for a base of at least 0.
fn power(base: f64, exponent: f64) -> f64 {
    if exponent == 1.0 {
        base
    } else {
        libm::pow(base, exponent)
    }
}
