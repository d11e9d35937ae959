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

mod ball;
mod double;
mod exact;
mod fast;
mod scaled;

pub(crate) use ball::Ball;
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
    /// `normal` within 2 · 2⁻⁵³ radians of the exact normal and its length within 2.5 · 2⁻⁵³ of 1.
    /// Derived in the three floors;
    /// `tests/src/hits` measures both against rational arithmetic.
    #[inline(always)]
    pub fn hit(&self, ray: &Ray) -> Option<Hit> {
        self.hit_and_floor(ray).0
    }

    /// [`Sphere::hit`], and which arithmetic settled it.
    #[inline(always)]
    pub fn hit_and_floor(&self, ray: &Ray) -> (Option<Hit>, Floor) {
        self.settle(ray, fast::hit(self, ray))
    }

    /// Whether a ray meets the sphere whose origin is known up to a distance of `origin_error`.
    ///
    /// Where that error leaves open on which side of the surface the origin lies, it counts as
    /// lying on it: the ray then meets the sphere where it goes inward. So a point keeps the light
    /// that leaves a surface it shares with this sphere, and none that enters there.
    #[inline(always)]
    pub(crate) fn is_met(&self, ray: &Ray, origin_error: f64) -> bool {
        let relative = Relative::new(self, ray.origin);
        let direction_sq = ray.direction.length_squared();
        // An origin off by e moves |f|² by e (2 |f| + e), and |f| = r where that matters.
        let slack = origin_error * (2.0 * self.radius + origin_error);
        match relative.decide(ray.direction, direction_sq, slack) {
            Decision::Miss => false,
            Decision::Hit(_) => true,
            Decision::Undecided => self.is_met_precisely(ray, origin_error),
        }
    }

    #[cold]
    #[inline(never)]
    fn is_met_precisely(&self, ray: &Ray, origin_error: f64) -> bool {
        if !can_hit(ray) {
            return false;
        }
        let scaled = Scaled::new(self, ray);
        let origin_error = scaled.length(origin_error);
        let slack = origin_error * (2.0 * scaled.sphere.radius + origin_error);
        let outside = double::outside::<false>(&scaled.sphere, scaled.ray.origin);
        // An origin that is known exactly is left to the exact decision.
        if slack > 0.0 && outside.abs() <= slack {
            let to_center = scaled.sphere.center - scaled.ray.origin;
            return scaled.ray.direction.dot(to_center) > 0.0;
        }
        self.hit_precisely(ray).0.is_some()
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

    /// Which of two spheres' hits on the same ray lies nearer; exact.
    #[inline(always)]
    pub(crate) fn compare(&self, hit: &Hit, other: &Self, other_hit: &Hit, ray: &Ray) -> Ordering {
        /// Two distances that are each off by a unit in the last place at most, relatively.
        const CLOSE: f64 = 4.0 * f64::EPSILON;
        if (hit.t - other_hit.t).abs() > CLOSE * other_hit.t {
            return if hit.t < other_hit.t {
                Ordering::Less
            } else {
                Ordering::Greater
            };
        }
        if self == other {
            Ordering::Equal
        } else {
            exact::compare_distances(self, other, ray)
        }
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
        if !can_hit(ray) {
            return (None, Floor::Fast);
        }
        // First the size: a scene of any scale is then treated the same, to the bit.
        let scaled = Scaled::new(self, ray);
        if let Some(hit) = scaled.hit_fast() {
            return (hit, Floor::Fast);
        }
        match scaled.hit_double() {
            Some(hit) => (hit, Floor::Double),
            None => (exact::hit(self, ray), Floor::Exact),
        }
    }

    /// What one floor alone finds out, `None` where it cannot decide: to test the floors by.
    #[doc(hidden)]
    pub fn hit_on_floor(&self, ray: &Ray, floor: Floor) -> Option<Option<Hit>> {
        if !can_hit(ray) {
            return Some(None);
        }
        match floor {
            Floor::Fast => match fast::hit(self, ray) {
                Answer::Miss => Some(None),
                Answer::Hit(hit) => Some(Some(hit)),
                Answer::Undecided => Scaled::new(self, ray).hit_fast(),
            },
            Floor::Double => Scaled::new(self, ray).hit_double(),
            Floor::Exact => Some(exact::hit(self, ray)),
        }
    }
}

/// Whether the ray is finite and goes anywhere.
fn can_hit(ray: &Ray) -> bool {
    ray.origin.is_finite() && ray.direction.is_finite() && ray.direction != DVec3::ZERO
}

#[cfg(test)]
mod tests;
