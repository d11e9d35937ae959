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
mod scaled;

pub(crate) use fast::Relative;

use std::cmp::Ordering;

use glam::DVec3;
use thiserror::Error;

use self::fast::{Answer, Decision};
use self::scaled::Scaled;
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
    /// `normal` within 2 · 2⁻⁵³ radians of the exact normal. Derived in the three floors;
    /// `tests/src/hits` measures both against rational arithmetic.
    #[inline]
    pub fn hit(&self, ray: &Ray) -> Option<Hit> {
        self.hit_and_floor(ray).0
    }

    /// [`Sphere::hit`], and which arithmetic settled it.
    #[inline]
    pub fn hit_and_floor(&self, ray: &Ray) -> (Option<Hit>, Floor) {
        self.settle(ray, fast::hit(self, ray))
    }

    /// Whether [`Sphere::hit`] finds anything, for less.
    #[inline]
    pub fn is_hit(&self, ray: &Ray) -> bool {
        let relative = Relative::new(self, ray.origin);
        match relative.decide(ray.direction, ray.direction.length_squared()) {
            Decision::Miss => false,
            Decision::Hit(_) => true,
            Decision::Undecided => self.hit_precisely(ray).0.is_some(),
        }
    }

    /// What depends on the sphere and a viewpoint alone, for [`Sphere::hit_from_viewpoint`].
    pub(crate) fn relative_to(&self, viewpoint: DVec3) -> Relative {
        Relative::precise(self, viewpoint)
    }

    /// [`Sphere::hit`] for a ray whose origin the sphere is known from, and its direction's square.
    #[inline(always)]
    pub(crate) fn hit_from_viewpoint(
        &self,
        relative: &Relative,
        ray: &Ray,
        direction_sq: f64,
    ) -> Option<Hit> {
        self.settle(ray, fast::hit_relative(self, relative, ray, direction_sq))
            .0
    }

    /// Whether this sphere's hit lies nearer than another's on the same ray; exact, and false for
    /// equal distances.
    #[inline(always)]
    pub(crate) fn is_nearer(&self, hit: &Hit, other: &Self, other_hit: &Hit, ray: &Ray) -> bool {
        /// Two distances that are each off by a unit in the last place at most, relatively.
        const CLOSE: f64 = 4.0 * f64::EPSILON;
        if (hit.t - other_hit.t).abs() > CLOSE * other_hit.t {
            return hit.t < other_hit.t;
        }
        self != other && exact::compare_distances(self, other, ray) == Ordering::Less
    }

    #[inline(always)]
    fn settle(&self, ray: &Ray, answer: Answer) -> (Option<Hit>, Floor) {
        match answer {
            Answer::Miss => (None, Floor::Fast),
            Answer::Hit(hit) => (Some(hit), Floor::Fast),
            Answer::Undecided => self.hit_precisely(ray),
        }
    }

    #[cold]
    #[inline(never)]
    fn hit_precisely(&self, ray: &Ray) -> (Option<Hit>, Floor) {
        let finite = ray.origin.is_finite() && ray.direction.is_finite();
        if !finite || ray.direction == DVec3::ZERO {
            return (None, Floor::Fast);
        }
        // First the size: a scene of any scale is then treated the same, to the bit.
        let scaled = Scaled::new(self, ray);
        match fast::hit(&scaled.sphere, &scaled.ray) {
            Answer::Miss => return (None, Floor::Fast),
            Answer::Hit(hit) => return (Some(scaled.restore(hit)), Floor::Fast),
            Answer::Undecided => {}
        }
        match double::hit(&scaled.sphere, &scaled.ray) {
            Some(hit) => (hit.map(|hit| scaled.restore(hit)), Floor::Double),
            None => (exact::hit(self, ray), Floor::Exact),
        }
    }
}

#[cfg(test)]
mod tests;
