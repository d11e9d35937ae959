//! Points and normals by coordinates, with so many digits that cancellation does no harm.

use std::cmp::Ordering;

use glam::DVec3;
use marbles_core::{Ray, Sphere};
use num_bigint::{BigInt, BigUint};

use super::Quadratic;
use super::integers::{dot, integers, mantissa_and_exponent, to_float};

/// Binary places of roots after the binary point: hundreds more than any coordinate loses.
const PLACES: u64 = 640;

/// The nearest intersection of a sphere in front of a ray's origin, with its coordinates.
pub struct ExactPoint {
    quadratic: Quadratic,
    origin: [BigInt; 3],
    /// B ± √Q, in units of 2^−`PLACES`.
    sum: BigInt,
}

/// A fraction times two to the `exponent`; its denominator is greater than 0.
#[derive(Clone)]
pub struct Exact {
    numerator: BigInt,
    denominator: BigInt,
    exponent: i64,
}

impl ExactPoint {
    /// The point; `None` for a miss.
    pub fn new(sphere: &Sphere, ray: &Ray) -> Option<Self> {
        let quadratic = Quadratic::new(sphere, ray);
        if !quadratic.is_hit() {
            return None;
        }
        let root = root(&quadratic.discriminant);
        let along = &quadratic.along << PLACES;
        let is_inside = quadratic.outside <= BigInt::ZERO;
        let origin = ray.origin.to_array().map(|part| {
            let (mantissa, exponent) = mantissa_and_exponent(part);
            BigInt::from(mantissa) << (exponent - quadratic.scene_unit).max(0)
        });
        Some(Self {
            sum: if is_inside {
                along + root
            } else {
                along - root
            },
            quadratic,
            origin,
        })
    }

    /// The distance in multiples of the ray's direction.
    pub fn distance(&self) -> Exact {
        Exact {
            numerator: self.sum.clone(),
            denominator: &self.quadratic.direction_sq << PLACES,
            exponent: self.quadratic.unit,
        }
    }

    /// The distance in scene units.
    pub fn length(&self) -> Exact {
        Exact {
            numerator: &self.sum * root(&self.quadratic.direction_sq),
            denominator: &self.quadratic.direction_sq << (2 * PLACES),
            exponent: self.quadratic.scene_unit,
        }
    }

    /// A coordinate of the point in the world.
    pub fn position(&self, axis: usize) -> Exact {
        let Quadratic {
            direction,
            direction_sq,
            scene_unit,
            ..
        } = &self.quadratic;
        let origin = (direction_sq * &self.origin[axis]) << PLACES;
        Exact {
            numerator: origin + &direction[axis] * &self.sum,
            denominator: direction_sq << PLACES,
            exponent: *scene_unit,
        }
    }

    /// The component of the outward normal along a vector.
    pub fn normal(&self, along: DVec3) -> Exact {
        let (along, unit) = integers(along.to_array());
        let Quadratic {
            direction,
            to_center,
            direction_sq,
            radius,
            ..
        } = &self.quadratic;
        let to_center = (direction_sq * dot(&along, to_center)) << PLACES;
        Exact {
            numerator: dot(&along, direction) * &self.sum - to_center,
            denominator: (direction_sq * radius) << PLACES,
            exponent: unit,
        }
    }
}

/// The root of a number, in units of 2^−`PLACES`.
fn root(number: &BigInt) -> BigInt {
    let square = BigUint::try_from(number << (2 * PLACES)).unwrap();
    BigInt::from(square.sqrt())
}

impl Exact {
    /// A double.
    pub fn number(value: f64) -> Self {
        let (mantissa, exponent) = mantissa_and_exponent(value);
        Self {
            numerator: BigInt::from(mantissa),
            denominator: BigInt::from(1),
            exponent,
        }
    }

    /// The product with a double.
    pub fn times(mut self, factor: f64) -> Self {
        let (mantissa, exponent) = mantissa_and_exponent(factor);
        self.numerator *= mantissa;
        self.exponent += exponent;
        self
    }

    /// The distance of a number from this one, in units in the last place of floats with this number of binary digits
    /// and this smallest exponent.
    pub fn error(&self, found: f64, (digits, least): (i32, i32)) -> f64 {
        let (mantissa, own) = mantissa_and_exponent(found);
        let unit = own.min(self.exponent);
        let found = (BigInt::from(mantissa) << (own - unit)) * &self.denominator;
        let exact = &self.numerator << (self.exponent - unit);
        let place = |value: f64| match value {
            0.0 => least,
            _ => libm::ilogb(value).max(least),
        };
        let ratio = |numerator: &BigInt, exponent: i64| {
            // As large as the denominator is, both are made about 1.
            let size = self.denominator.bits() as i64;
            to_float(numerator, exponent - size) / to_float(&self.denominator, -size)
        };
        let value = ratio(&self.numerator, self.exponent);
        ratio(&(found - exact), unit).abs() / libm::scalbn(1.0, place(value) + 1 - digits)
    }

    /// The order of two numbers. They are equal if they agree to so many digits that they must be.
    pub fn order(&self, other: &Self) -> Ordering {
        let unit = self.exponent.min(other.exponent);
        let one = (&self.numerator * &other.denominator) << (self.exponent - unit);
        let two = (&other.numerator * &self.denominator) << (other.exponent - unit);
        let difference = &one - &two;
        if difference.bits() + PLACES * 3 / 4 < one.bits() {
            Ordering::Equal
        } else {
            one.cmp(&two)
        }
    }
}
