//! Methods to intersect a ray and a sphere, for comparison.
//!
//! All are inlined where they are called by name, so that no timing includes a call.

use glam::DVec3;
use marbles_core::{Ray, Sphere};

/// The result of every form: the distance and the outward normal.
pub type Form = fn(&Sphere, &Ray) -> Option<(f64, DVec3)>;

/// The methods with their names; the last one is that of marbles.
pub const FORMS: [(&str, Form); 4] = [
    ("(-b - sqrt(b² - 4ac)) / 2a", original),
    ("stable q", stable),
    ("perpendicular", perpendicular),
    ("marbles", marbles),
];

/// The textbook quadratic; the far root if the near one is behind the origin.
#[inline(always)]
pub fn original(sphere: &Sphere, ray: &Ray) -> Option<(f64, DVec3)> {
    let from_center = ray.origin - sphere.center();
    let a = ray.direction.length_squared();
    let b = 2.0 * ray.direction.dot(from_center);
    let c = from_center.length_squared() - sphere.radius() * sphere.radius();
    let discriminant = b * b - 4.0 * a * c;
    if discriminant < 0.0 {
        return None;
    }
    let near = (-b - discriminant.sqrt()) / (2.0 * a);
    let far = (-b + discriminant.sqrt()) / (2.0 * a);
    in_front(sphere, ray, near, far)
}

/// The same discriminant; one root by addition, the other from the product of both.
#[inline(always)]
pub fn stable(sphere: &Sphere, ray: &Ray) -> Option<(f64, DVec3)> {
    let from_center = ray.origin - sphere.center();
    let a = ray.direction.length_squared();
    let b = 2.0 * ray.direction.dot(from_center);
    let c = from_center.length_squared() - sphere.radius() * sphere.radius();
    let discriminant = b * b - 4.0 * a * c;
    if discriminant < 0.0 {
        return None;
    }
    let q = -0.5 * (b + discriminant.sqrt().copysign(b));
    in_front(sphere, ray, (q / a).min(c / q), (q / a).max(c / q))
}

/// The discriminant from the perpendicular from the center to the ray, and stable roots.
///
/// # Source
/// E. Haines, J. Günther, T. Akenine-Möller, Precision Improvements for Ray/Sphere Intersection,
/// Ray Tracing Gems, 2019, chapter 7.
#[inline(always)]
pub fn perpendicular(sphere: &Sphere, ray: &Ray) -> Option<(f64, DVec3)> {
    let from_center = ray.origin - sphere.center();
    let radius_sq = sphere.radius() * sphere.radius();
    let a = ray.direction.length_squared();
    let along = -ray.direction.dot(from_center);
    let foot = from_center + ray.direction * (along / a);
    let half_chord_sq = radius_sq - foot.length_squared();
    if half_chord_sq < 0.0 {
        return None;
    }
    let q = along + (a * half_chord_sq).sqrt().copysign(along);
    let c = from_center.length_squared() - radius_sq;
    in_front(sphere, ray, (q / a).min(c / q), (q / a).max(c / q))
}

fn in_front(sphere: &Sphere, ray: &Ray, near: f64, far: f64) -> Option<(f64, DVec3)> {
    let t = if near > 0.0 { near } else { far };
    (t > 0.0).then(|| (t, (ray.at(t) - sphere.center()) / sphere.radius()))
}

/// The form of marbles.
#[inline(always)]
pub fn marbles(sphere: &Sphere, ray: &Ray) -> Option<(f64, DVec3)> {
    sphere.hit(ray).map(|hit| (hit.t, hit.normal))
}
