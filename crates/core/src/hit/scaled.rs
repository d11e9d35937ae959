//! Powers of two taken out of a ray and a sphere.

use glam::DVec3;

use super::double;
use super::fast;
use super::fast::Answer;
use super::outcome::Hit;
use crate::model::ray::Ray;
use crate::model::sphere::Sphere;
use crate::numeric::rounding::two_difference;

/// A ray and a sphere of moderate size, like the given ones but for powers of two.
///
/// The larger of the center's coordinates and the radius lies between 1 and 4, the largest
/// component of the direction between 1 and 2. The origin keeps what rounding would lose of
/// c − o. Parts that are smaller by 2¹⁰⁰⁰ are lost, which no bound of the first two floors notices.
pub(super) struct Scaled {
    pub(super) sphere: Sphere,
    pub(super) ray: Ray,
    /// The exponent by which lengths of the world were scaled.
    length_exponent: i32,
    /// The exponent by which distances along the ray have to be scaled back.
    distance_exponent: i32,
}

impl Scaled {
    /// The ray must be finite and have a direction.
    pub(super) fn new(sphere: &Sphere, ray: &Ray) -> Self {
        /// Coordinates beyond this could overflow when subtracted.
        const LARGE: f64 = f64::MAX / 4.0;
        let (center, origin) = (sphere.center, ray.origin);
        let large = center.abs().max(origin.abs()).max_element() > LARGE;
        let first = if large { -2 } else { 0 };
        let shrink = |value: f64| libm::scalbn(value, first);
        let difference = |axis: usize| two_difference(shrink(center[axis]), shrink(origin[axis]));
        let to_center = [difference(0), difference(1), difference(2)];
        let radius = shrink(sphere.radius);
        let largest = to_center
            .iter()
            .fold(radius, |largest, part| largest.max(part.0.abs()));
        let scene = exponent(largest);
        let turn = exponent(ray.direction.abs().max_element());
        let scale = |value: f64| libm::scalbn(value, -scene);
        Self {
            sphere: Sphere {
                center: DVec3::from_array(to_center.map(|(high, _)| scale(high))),
                radius: scale(radius),
            },
            ray: Ray {
                origin: DVec3::from_array(to_center.map(|(_, low)| scale(-low))),
                direction: ray.direction.map(|part| libm::scalbn(part, -turn)),
            },
            length_exponent: first - scene,
            distance_exponent: scene - first - turn,
        }
    }

    /// A length of the world in this scale.
    pub(super) fn length(&self, length: f64) -> f64 {
        libm::scalbn(length, self.length_exponent)
    }

    /// A length in this scale as one of the world.
    pub(super) fn world_length(&self, length: f64) -> f64 {
        libm::scalbn(length, -self.length_exponent)
    }

    /// A distance along the scaled ray as one along the given.
    pub(super) fn world_distance(&self, t: f64) -> f64 {
        libm::scalbn(t, self.distance_exponent)
    }

    /// The answer of the first floor for the given ray and sphere.
    pub(super) fn hit_fast(&self) -> Option<Option<Hit>> {
        match fast::hit(&self.sphere, &self.ray) {
            Answer::Miss => Some(None),
            Answer::Hit(hit) => Some(Some(self.restore(hit))),
            Answer::Undecided => None,
        }
    }

    /// The answer of the second floor for the given ray and sphere.
    pub(super) fn hit_double(&self) -> Option<Option<Hit>> {
        let hit = double::hit(&self.sphere, &self.ray)?;
        Some(hit.map(|hit| self.restore(hit)))
    }

    /// The hit of the given ray and sphere, from the one of the scaled.
    fn restore(&self, hit: Hit) -> Hit {
        Hit {
            t: self.world_distance(hit.t),
            ..hit
        }
    }
}

/// The exponent of a number, and some small one for 0, which a denormal radius may shrink to.
fn exponent(value: f64) -> i32 {
    libm::ilogb(value).clamp(-1100, 1100)
}
