//! Errors of computed distances and normals.

use glam::DVec3;
use num_bigint::BigInt;

use super::integers::{cross, dot, mantissa_and_exponent, shifted, to_float};
use super::{DIGITS, ExactHit};

/// The exponents of the unit in the last place of the smallest and of the largest numbers.
const UNITS: (i64, i64) = (-1074, 971);

impl ExactHit {
    /// The error of a computed distance in units in the last place.
    ///
    /// The unit is the distance from the correctly rounded t to the next double away from zero. If this t exceeds the
    /// largest double, infinity is correct; otherwise infinity counts as 2¹⁰²⁴, the next number after the largest.
    pub fn ulps(&self, found: f64) -> f64 {
        if found.is_nan() || found < 0.0 {
            return f64::INFINITY;
        }
        let digits = i64::from(f64::MANTISSA_DIGITS);
        let natural = self.exponent + self.distance.bits() as i64 - digits;
        let mut unit = natural.max(UNITS.0);
        let half: BigInt = BigInt::from(1) << (unit - self.exponent - 1);
        let rounded: BigInt = (&self.distance + half) >> (unit - self.exponent);
        if rounded.bits() as i64 > digits {
            unit += 1;
        }
        if unit > UNITS.1 && found == f64::INFINITY {
            return 0.0;
        }
        let unit = unit.min(UNITS.1);
        let (mantissa, exponent) = if found == f64::INFINITY {
            (1, UNITS.1 + digits)
        } else {
            mantissa_and_exponent(found)
        };
        let common = exponent.min(self.exponent);
        let error = (BigInt::from(mantissa) << (exponent - common))
            - (&self.distance << (self.exponent - common));
        to_float(&error, common - unit).abs()
    }

    /// The angle between a computed normal and the exact one, in 2⁻⁵³ radians.
    pub fn angle(&self, found: DVec3) -> f64 {
        if !found.is_finite() || found == DVec3::ZERO {
            return f64::INFINITY;
        }
        let found = found.to_array().map(fixed_point);
        let products = cross(&found, &self.normal);
        let [x, y, z] = products.map(|product| to_float(&product, -2 * DIGITS));
        let cosine = to_float(&dot(&found, &self.normal), -2 * DIGITS);
        libm::atan2(DVec3::new(x, y, z).length(), cosine) * TO_UNITS
    }

    /// The difference between the length of a computed normal and 1, in units of 2⁻⁵³.
    pub fn excess_length(found: DVec3) -> f64 {
        if !found.is_finite() {
            return f64::INFINITY;
        }
        let found = found.to_array().map(fixed_point);
        let excess = dot(&found, &found) - (BigInt::from(1) << (2 * DIGITS));
        to_float(&excess, -2 * DIGITS).abs() / 2.0 * TO_UNITS
    }
}

/// Converts radians to 2⁻⁵³ radians.
const TO_UNITS: f64 = 2.0 / f64::EPSILON;

/// A double in units of 2^−`DIGITS`, truncated to an integer.
fn fixed_point(value: f64) -> BigInt {
    let (mantissa, exponent) = mantissa_and_exponent(value);
    shifted(&BigInt::from(mantissa), exponent + DIGITS)
}
