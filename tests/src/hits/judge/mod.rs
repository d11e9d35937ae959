//! The judge: computes exactly whether and where a ray hits a sphere, from the given doubles alone.
//!
//! Every double is an integer times a power of two. So the quadratic A t² − 2 B t + K = 0 has integer coefficients:
//! with d the direction and f = center − origin, A = d·d, B = d·f, K = f·f − r², and its discriminant is Q = A r² − |d
//! × f|². Decisions are signs of integers. The distance is enclosed in rational numbers from the integer square root of
//! Q.
//!
//! It shares nothing with the code under test: neither the library for large integers, nor the formulas of
//! discriminant, distance and normal, nor the rounding.

mod integers;
mod point;
mod score;

use marbles_core::{Ray, Sphere};
use num_bigint::{BigInt, BigUint};

pub use point::{Exact, ExactPoint};

use integers::{cross, dot, integers, shifted, to_float};

/// Correct binary digits of distance and normal. A unit in the last place of a double is at least 2⁷⁰ times as large.
const DIGITS: i64 = 125;

/// The exact nearest intersection of the sphere in front of the ray's origin.
pub struct ExactHit {
    /// Whether the origin lies inside or on the surface.
    pub inner_side: bool,
    /// The distance is between this number and this number plus 2, times two to the `exponent`.
    distance: BigInt,
    exponent: i64,
    /// The outward normal in units of 2^−`DIGITS`, with truncated components.
    normal: [BigInt; 3],
}

/// The exact hit; `None` for a miss. A tangent is a hit, t = 0 is not; a ray without a direction misses.
pub fn judge(sphere: &Sphere, ray: &Ray) -> Option<ExactHit> {
    let quadratic = Quadratic::new(sphere, ray);
    quadratic.is_hit().then(|| quadratic.hit())
}

/// K and Q / A, each with a relative error of about 2⁻⁵².
pub fn powers(sphere: &Sphere, ray: &Ray) -> (f64, f64) {
    let quadratic = Quadratic::new(sphere, ray);
    let unit = 2 * quadratic.scene_unit;
    let ratio = to_float(&quadratic.discriminant, 0) / to_float(&quadratic.direction_sq, 0);
    (
        to_float(&quadratic.outside, unit),
        libm::scalbn(ratio, unit as i32),
    )
}

struct Quadratic {
    direction: [BigInt; 3],
    to_center: [BigInt; 3],
    radius: BigInt,
    /// A.
    direction_sq: BigInt,
    /// B.
    along: BigInt,
    /// K.
    outside: BigInt,
    /// Q.
    discriminant: BigInt,
    /// The binary exponents of the unit of coordinates, and of the unit of solutions.
    scene_unit: i64,
    unit: i64,
}

impl Quadratic {
    fn new(sphere: &Sphere, ray: &Ray) -> Self {
        let (center, origin) = (sphere.center().to_array(), ray.origin.to_array());
        let ([cx, cy, cz, ox, oy, oz, radius], scene_unit) = integers([
            center[0],
            center[1],
            center[2],
            origin[0],
            origin[1],
            origin[2],
            sphere.radius(),
        ]);
        let (direction, direction_unit) = integers(ray.direction.to_array());
        let to_center = [cx - ox, cy - oy, cz - oz];
        let moment = cross(&direction, &to_center);
        let direction_sq = dot(&direction, &direction);
        let radius_sq = &radius * &radius;
        Self {
            along: dot(&direction, &to_center),
            outside: dot(&to_center, &to_center) - &radius_sq,
            discriminant: &direction_sq * radius_sq - dot(&moment, &moment),
            direction,
            to_center,
            radius,
            direction_sq,
            scene_unit,
            unit: scene_unit - direction_unit,
        }
    }

    /// Returns whether there is a solution greater than 0: the product of both solutions is K / A, their sum 2 B / A.
    fn is_hit(&self) -> bool {
        let zero = BigInt::ZERO;
        if self.direction_sq == zero || self.discriminant < zero {
            return false;
        }
        self.outside < zero || self.along > zero
    }

    /// The smallest solution greater than 0: (B − √Q) / A from outside, else (B + √Q) / A.
    fn hit(&self) -> ExactHit {
        let inner_side = self.outside <= BigInt::ZERO;
        let places = self.places_of_the_root();
        let square = BigUint::try_from(&self.discriminant << (2 * places)).unwrap();
        // The root lies between this and this plus 1.
        let root = BigInt::from(square.sqrt());
        let along = &self.along << places;
        let numerator = if inner_side {
            along + root
        } else {
            along - root - BigInt::from(1)
        };
        let denominator = &self.direction_sq << places;

        let bits = |value: &BigInt| value.bits() as i64;
        let more = DIGITS + 2 + bits(&denominator) - bits(&numerator);
        let distance = if more >= 0 {
            (&numerator << more) / &denominator
        } else {
            &numerator / (&denominator << -more)
        };
        let length = &denominator * &self.radius;
        let normal = [0, 1, 2].map(|axis| {
            let from_center =
                &numerator * &self.direction[axis] - &denominator * &self.to_center[axis];
            shifted(&from_center, DIGITS) / &length
        });
        ExactHit {
            inner_side,
            distance,
            exponent: self.unit - more,
            normal,
        }
    }

    /// The number of binary places of the root that give the distance and the normal their digits.
    fn places_of_the_root(&self) -> i64 {
        let bits = |value: &BigInt| value.bits() as i64;
        // The numerator B ± √Q is at least A |K| / (|B| + √Q), or 2 B where K = 0; the normal's
        // is A r long, and one unit of the root moves it by |d|.
        let sum = bits(&self.along).max(bits(&self.discriminant) / 2 + 1) + 1;
        let numerator = if self.outside == BigInt::ZERO {
            bits(&self.along)
        } else {
            bits(&self.direction_sq) + bits(&self.outside) - 2 - sum
        };
        let normal = bits(&self.direction_sq) / 2 + bits(&self.radius) - 2;
        (DIGITS + 3 - numerator.min(normal)).max(0)
    }
}

#[cfg(test)]
mod tests;
