//! Spheres, and where rays meet them.

use glam::DVec3;
use thiserror::Error;

use crate::Ray;

/// A sphere: an opaque surface, in the world frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sphere {
    center: DVec3,
    radius: f64,
}

/// Why a sphere was refused.
#[derive(Clone, Copy, Debug, Error, PartialEq)]
pub enum SphereError {
    /// The center is infinite or not a number.
    #[error("expected a finite center, found {0}")]
    Center(DVec3),
    /// The radius is zero, negative, infinite or not a number.
    #[error("expected a finite radius greater than 0, found {0}")]
    Radius(f64),
}

/// Where a ray meets a sphere.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hit {
    /// Distance in multiples of the ray's direction.
    pub t: f64,
    /// Unit outward normal of the sphere.
    pub normal: DVec3,
    /// Whether the ray started inside the sphere or on its surface, and so meets its inner side.
    pub inner_side: bool,
}

impl Sphere {
    /// The sphere around `center`.
    ///
    /// # Errors
    /// Refuses what is not finite, and radii that are not greater than 0.
    pub fn new(center: DVec3, radius: f64) -> Result<Self, SphereError> {
        if !center.is_finite() {
            return Err(SphereError::Center(center));
        }
        if !(radius > 0.0 && radius.is_finite()) {
            return Err(SphereError::Radius(radius));
        }
        Ok(Self { center, radius })
    }

    /// The center, in the world frame.
    pub fn center(&self) -> DVec3 {
        self.center
    }

    /// The radius, greater than 0.
    pub fn radius(&self) -> f64 {
        self.radius
    }

    /// The nearest point of the sphere in front of the ray's origin.
    ///
    /// A tangent ray hits. An origin on the surface does not hit there, but may hit across.
    pub fn hit(&self, ray: &Ray) -> Option<Hit> {
        let Ray { origin, direction } = *ray;
        let to_center = self.center - origin;
        let direction_sq = direction.length_squared();
        let along = direction.dot(to_center);
        // Greater than 0 where the origin lies outside.
        let outside = to_center.length_squared() - self.radius * self.radius;
        if outside > 0.0 && along <= 0.0 {
            return None;
        }
        // The foot of the perpendicular from the center, seen from the center.
        let foot = direction * (along / direction_sq) - to_center;
        let half_chord_sq = self.radius * self.radius - foot.length_squared();
        if half_chord_sq < 0.0 || half_chord_sq.is_nan() {
            return None;
        }
        let root = (half_chord_sq * direction_sq).sqrt();
        // Of the two roots (along ± root) / direction², the one that adds is computed so, the
        // other from their product, outside / direction²: nothing cancels.
        let t = if outside > 0.0 {
            outside / (along + root)
        } else if along >= 0.0 {
            (along + root) / direction_sq
        } else {
            outside / (along - root)
        };
        if !(t > 0.0 && t.is_finite()) {
            return None;
        }
        let inner_side = outside <= 0.0;
        let half_chord = direction * (root / direction_sq);
        let from_center = if inner_side {
            foot + half_chord
        } else {
            foot - half_chord
        };
        Some(Hit {
            t,
            normal: from_center / self.radius,
            inner_side,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn unit_sphere_at(x: f64, y: f64, z: f64) -> Sphere {
        Sphere::new(DVec3::new(x, y, z), 1.0).unwrap()
    }

    fn forward_from(origin: DVec3) -> Ray {
        Ray {
            origin,
            direction: DVec3::Z,
        }
    }

    #[test]
    fn refuses_what_is_no_sphere() {
        assert_eq!(Sphere::new(DVec3::ZERO, 0.0), Err(SphereError::Radius(0.0)));
        assert_eq!(
            Sphere::new(DVec3::ZERO, -1.0),
            Err(SphereError::Radius(-1.0))
        );
        assert!(Sphere::new(DVec3::ZERO, f64::NAN).is_err());
        assert!(Sphere::new(DVec3::new(0.0, f64::INFINITY, 0.0), 1.0).is_err());
    }

    #[test]
    fn the_nearer_crossing_is_hit() {
        let hit = unit_sphere_at(0.0, 0.0, 5.0)
            .hit(&forward_from(DVec3::ZERO))
            .unwrap();
        assert_eq!(
            hit,
            Hit {
                t: 4.0,
                normal: -DVec3::Z,
                inner_side: false
            }
        );
    }

    #[test]
    fn t_counts_multiples_of_the_direction() {
        let ray = Ray {
            origin: DVec3::ZERO,
            direction: DVec3::Z * 8.0,
        };
        assert_eq!(unit_sphere_at(0.0, 0.0, 5.0).hit(&ray).unwrap().t, 0.5);
    }

    #[test]
    fn tangent_ray_hits() {
        let hit = unit_sphere_at(0.0, 1.0, 5.0)
            .hit(&forward_from(DVec3::ZERO))
            .unwrap();
        assert_eq!(
            hit,
            Hit {
                t: 5.0,
                normal: -DVec3::Y,
                inner_side: false
            }
        );
    }

    #[test]
    fn sphere_behind_is_missed() {
        assert!(
            unit_sphere_at(0.0, 0.0, -5.0)
                .hit(&forward_from(DVec3::ZERO))
                .is_none()
        );
    }

    #[test]
    fn from_inside_the_far_side_is_hit() {
        let hit = unit_sphere_at(0.0, 0.0, 0.5)
            .hit(&forward_from(DVec3::ZERO))
            .unwrap();
        assert_eq!(
            hit,
            Hit {
                t: 1.5,
                normal: DVec3::Z,
                inner_side: true
            }
        );
    }

    #[test]
    fn origin_on_the_surface_hits_only_across() {
        let across = unit_sphere_at(0.0, 0.0, 1.0)
            .hit(&forward_from(DVec3::ZERO))
            .unwrap();
        assert_eq!(
            across,
            Hit {
                t: 2.0,
                normal: DVec3::Z,
                inner_side: true
            }
        );
        assert!(
            unit_sphere_at(0.0, 0.0, -1.0)
                .hit(&forward_from(DVec3::ZERO))
                .is_none()
        );
    }
}
