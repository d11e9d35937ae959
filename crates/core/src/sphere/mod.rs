//! Spheres, and where rays meet them: every decision exact, every distance to the last place.
//!
//! With o the ray's origin, d its direction, c the center, r the radius and f = c − o, the ray
//! meets the sphere where A t² − 2 B t + K = 0 with
//!
//! > A = d·d,  B = d·f,  K = f·f − r²,  Q = B² − A K = A r² − |d × f|².
//!
//! K < 0 inside. From outside (K > 0) the ray hits where B > 0 and Q ≥ 0, at t = K / (B + √Q);
//! from inside always, at the far root; from the surface (K = 0) where B > 0, at t = 2 B / A.
//!
//! Three floors answer. [`fast`] knows bounds of its rounding errors and answers wherever they
//! decide; [`double`] does the same with twice the digits; [`exact`] computes with integers and
//! always answers.

mod double;
mod exact;
mod fast;

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

/// Which arithmetic settled a hit or a miss.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub enum Floor {
    /// Doubles, with a bound of their rounding errors.
    Fast,
    /// Numbers of twice the precision, with a bound too.
    Double,
    /// Integers: no rounding.
    Exact,
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
    /// A ray without direction, or with a part that is not finite, hits nothing.
    ///
    /// # Accuracy
    /// Hit or miss is decided exactly for the given doubles. Bounds: `t` lies within one unit in
    /// the last place of the exact distance (a distance beyond the largest double is infinite),
    /// `normal` within 2 · 2⁻⁵³ radians of the exact normal and its length within 2.5 · 2⁻⁵³ of 1.
    /// Derived in the three floors;
    /// `tests/src/hits` measures both against rational arithmetic.
    #[inline]
    pub fn hit(&self, ray: &Ray) -> Option<Hit> {
        self.hit_and_floor(ray).0
    }

    /// [`Sphere::hit`], and which arithmetic settled it.
    #[inline]
    pub fn hit_and_floor(&self, ray: &Ray) -> (Option<Hit>, Floor) {
        match fast::hit(self, ray) {
            fast::Answer::Miss => (None, Floor::Fast),
            fast::Answer::Hit(hit) => (Some(hit), Floor::Fast),
            fast::Answer::Undecided => self.hit_precisely(ray),
        }
    }

    /// What one floor alone finds out, `None` where it cannot decide: to test the floors by.
    pub fn hit_on_floor(&self, ray: &Ray, floor: Floor) -> Option<Option<Hit>> {
        if !is_line(ray) {
            return Some(None);
        }
        match floor {
            Floor::Fast => match fast::hit(self, ray) {
                fast::Answer::Miss => Some(None),
                fast::Answer::Hit(hit) => Some(Some(hit)),
                fast::Answer::Undecided => None,
            },
            Floor::Double => double::hit(self, ray),
            Floor::Exact => Some(exact::hit(self, ray)),
        }
    }

    #[cold]
    fn hit_precisely(&self, ray: &Ray) -> (Option<Hit>, Floor) {
        if !is_line(ray) {
            return (None, Floor::Fast);
        }
        match double::hit(self, ray) {
            Some(answer) => (answer, Floor::Double),
            None => (exact::hit(self, ray), Floor::Exact),
        }
    }
}

/// Whether a ray has a direction and no part that is infinite or not a number.
fn is_line(ray: &Ray) -> bool {
    ray.origin.is_finite() && ray.direction.is_finite() && ray.direction != DVec3::ZERO
}

#[cfg(test)]
mod tests;
