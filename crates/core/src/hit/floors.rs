//! The three floors of arithmetic in turn, until one of them decides.

use std::cmp::Ordering;

use glam::DVec3;

use super::fast::{Answer, Decision, Relative};
use super::outcome::{Floor, Hit};
use super::scaled::Scaled;
use super::{double, exact, fast};
use crate::model::ray::Ray;
use crate::model::sphere::Sphere;

impl Sphere {
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
    /// `tests/tests/hits` measures both against rational arithmetic.
    #[inline(always)]
    pub fn hit(&self, ray: &Ray) -> Option<Hit> {
        self.hit_and_floor(ray).0
    }

    /// [`Sphere::hit`], and which arithmetic settled it: to test the floors by.
    #[doc(hidden)]
    #[inline(always)]
    pub fn hit_and_floor(&self, ray: &Ray) -> (Option<Hit>, Floor) {
        self.settle(ray, fast::hit(self, ray))
    }

    /// Says whether a ray meets the sphere whose origin is known up to a distance of `origin_error`.
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

    /// K for rays from a viewpoint, to twice the precision where sizes are moderate: the square of a
    /// tangent's length, negative inside.
    pub(crate) fn outside(&self, viewpoint: DVec3) -> f64 {
        Relative::precise(self, viewpoint).outside
    }

    /// [`Sphere::hit`] for one of many rays from a viewpoint: K is precise.
    #[inline(always)]
    pub(crate) fn hit_from_viewpoint(&self, ray: &Ray) -> Option<Hit> {
        let relative = Relative::precise(self, ray.origin);
        let answer = fast::hit_relative(self, &relative, ray);
        self.settle(ray, answer).0
    }

    /// The order of two spheres' hits on the same ray by distance; exact.
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

    /// The answer of one floor alone, `None` where it cannot decide: to test the floors by.
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

/// True where the ray is finite and goes anywhere.
fn can_hit(ray: &Ray) -> bool {
    ray.origin.is_finite() && ray.direction.is_finite() && ray.direction != DVec3::ZERO
}
