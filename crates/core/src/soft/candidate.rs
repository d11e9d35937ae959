//! The spheres that a tile may see, in the camera's frame.

use glam::{DMat3, DVec2, DVec3};

use crate::hit::ball::Ball;
use crate::model::camera::Projection;

/// A sphere in the camera's frame.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Candidate {
    /// Its place among those of the tile.
    pub(crate) number: usize,
    pub(crate) sphere: usize,
    pub(crate) center: DVec3,
    pub(crate) radius: f64,
    /// The squared distance of the center from the eye less the squared radius.
    pub(super) outside: f64,
    /// The radius of the sphere that a ray has to meet to miss the outline, if there is one.
    pub(crate) inner: Option<f64>,
    /// Whether no soft light reaches what is inside of it.
    pub(crate) hides_light: bool,
}

impl Candidate {
    pub(crate) fn new(
        ball: &Ball,
        number: usize,
        camera_from_world: &DMat3,
        inner: Option<f64>,
        hides_light: bool,
    ) -> Self {
        Self {
            number,
            sphere: ball.index as usize,
            center: *camera_from_world * ball.to_center,
            radius: ball.radius,
            outside: ball.outside,
            inner,
            hides_light,
        }
    }

    /// The candidate with rows and columns exchanged.
    pub(crate) fn transposed(&self) -> Self {
        Self {
            center: DVec3::new(self.center.y, self.center.x, self.center.z),
            ..*self
        }
    }

    /// What is positive where a ray through (u, v) meets the concentric sphere of a radius: of rays from the eye in the
    /// direction (u, v, 1) times their squared length.
    pub(super) fn meets(&self, u: f64, v: f64, radius: f64, projection: Projection) -> f64 {
        match projection {
            Projection::Central => {
                let ray = DVec3::new(u, v, 1.0);
                ray.length_squared() * (radius * radius) - ray.cross(self.center).length_squared()
            }
            Projection::Parallel => {
                let (a, b) = (u - self.center.x, v - self.center.y);
                radius * radius - a * a - b * b
            }
        }
    }

    /// The radius of the concentric sphere whose contour is the circle in which the plane where parallel rays begin cuts the
    /// sphere.
    pub(super) fn cut(&self, projection: Projection) -> Option<f64> {
        let DVec3 { z, .. } = self.center;
        let is_cut = projection == Projection::Parallel && z.abs() < self.radius;
        is_cut.then(|| ((self.radius - z) * (self.radius + z)).sqrt())
    }

    /// The distance at which a ray meets the sphere, in multiples of the ray, and whether that is from inside.
    pub(super) fn distance(&self, u: f64, v: f64, projection: Projection) -> Option<(f64, bool)> {
        let discriminant = self.meets(u, v, self.radius, projection);
        match projection {
            Projection::Central => {
                let ray = DVec3::new(u, v, 1.0);
                let along = ray.dot(self.center);
                if self.outside <= 0.0 {
                    let root = discriminant.max(0.0).sqrt();
                    return Some(((along + root) / ray.length_squared(), true));
                }
                let is_met = discriminant >= 0.0 && along > 0.0;
                is_met.then(|| (self.outside / (along + discriminant.sqrt()), false))
            }
            Projection::Parallel => {
                let root = (discriminant >= 0.0).then(|| discriminant.sqrt())?;
                let (near, far) = (self.center.z - root, self.center.z + root);
                (far > 0.0).then_some(if near > 0.0 {
                    (near, false)
                } else {
                    (far, true)
                })
            }
        }
    }

    /// The distance at which a ray meets the sphere from outside, in multiples of the ray; that of the nearest place for a ray
    /// that passes beside it.
    pub(super) fn nearest_distance(&self, u: f64, v: f64, projection: Projection) -> f64 {
        let root = self.meets(u, v, self.radius, projection).max(0.0).sqrt();
        match projection {
            Projection::Central => {
                let along = DVec3::new(u, v, 1.0).dot(self.center);
                self.outside / (along + root)
            }
            Projection::Parallel => self.center.z - root,
        }
    }

    /// True where the sphere's own light is seen if the ray meets it first: from outside, and not behind the outline.
    pub(super) fn has_light(
        &self,
        u: f64,
        v: f64,
        projection: Projection,
        is_inside: bool,
    ) -> bool {
        !is_inside
            && self
                .inner
                .is_none_or(|inner| self.meets(u, v, inner, projection) >= 0.0)
    }

    /// True if the rays through all corners of a cell meet it from outside, and show its light: then so do all rays
    /// between them, for what the eye sees of it is convex.
    pub(crate) fn fills(&self, u: [f64; 2], v: [f64; 2], projection: Projection) -> bool {
        u.into_iter().all(|u| {
            v.into_iter()
                .all(|v| match self.distance(u, v, projection) {
                    Some((_, is_inside)) => self.has_light(u, v, projection, is_inside),
                    None => false,
                })
        })
    }

    /// True unless no ray through a cell meets the sphere.
    pub(crate) fn may_be_in(&self, u: [f64; 2], v: [f64; 2], projection: Projection) -> bool {
        /// What rounding may move a sphere by.
        const SLACK: f64 = 1e-9;
        let middle = DVec3::new(0.5 * (u[0] + u[1]), 0.5 * (v[0] + v[1]), 1.0);
        let half = 0.5 * DVec2::new(u[1] - u[0], v[1] - v[0]).length();
        let (distance, reach) = match projection {
            Projection::Central => {
                if self.outside <= 0.0 {
                    return true;
                }
                let length = middle.length();
                // Rays within this angle of the middle one, seen from the eye.
                let sine = (half / length).min(1.0);
                let cosine = (1.0 - sine * sine).sqrt();
                let along = middle.dot(self.center) / length;
                let aside = middle.cross(self.center).length() / length;
                if along * cosine + aside * sine < 0.0 {
                    return false;
                }
                (aside * cosine - along * sine, self.center.length())
            }
            Projection::Parallel => {
                let apart = (middle - self.center).truncate().length();
                (apart - half, self.center.length())
            }
        };
        distance <= self.radius + SLACK * (reach + self.radius)
    }

    /// Adds the places on a line at which a ray begins or ceases to meet the concentric sphere of a radius.
    pub(super) fn add_ends(
        &self,
        v: f64,
        radius: f64,
        projection: Projection,
        ends: &mut Vec<f64>,
    ) {
        let DVec3 { x, y, z } = self.center;
        let square = radius * radius;
        match projection {
            Projection::Central => {
                let a = square - z * z - y * y;
                let b = x * (y * v + z);
                let aside = v * z - y;
                let c = (1.0 + v * v) * (square - x * x) - aside * aside;
                let discriminant = b * b - a * c;
                if discriminant >= 0.0 {
                    let q = -(b + discriminant.sqrt().copysign(b));
                    ends.extend([q / a, c / q].into_iter().filter(|end| end.is_finite()));
                }
            }
            Projection::Parallel => {
                let half_sq = square - (v - y) * (v - y);
                if half_sq >= 0.0 {
                    ends.extend([x - half_sq.sqrt(), x + half_sq.sqrt()]);
                }
            }
        }
    }
}
