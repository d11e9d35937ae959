//! Polynomials of the coordinates (x, y) of a cell.

use std::ops::{Add, Mul, Sub};

use super::pair::both;

/// `one + x·x + y·y`, the coefficients named after what they multiply.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Linear {
    pub(crate) one: f64,
    pub(crate) x: f64,
    pub(crate) y: f64,
}

/// A polynomial of degree 2, the coefficients named after what they multiply.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Quadratic {
    pub(crate) one: f64,
    pub(crate) x: f64,
    pub(crate) y: f64,
    pub(crate) xx: f64,
    pub(crate) xy: f64,
    pub(crate) yy: f64,
}

impl Quadratic {
    /// A bound of the distance between the values in the square −½ ≤ x, y ≤ ½ and that in its
    /// middle.
    pub(crate) fn spread(&self) -> f64 {
        0.5 * (self.x.abs() + self.y.abs()) + 0.25 * (self.xx.abs() + self.xy.abs() + self.yy.abs())
    }

    /// The value at a place.
    pub(crate) fn at(&self, x: f64, y: f64) -> f64 {
        (x * self.xx + y * self.xy + self.x) * x + (y * self.yy + self.y) * y + self.one
    }

    /// Whether the polynomial may have a zero in the square −½ ≤ x, y ≤ ½.
    pub(crate) fn may_vanish(&self) -> bool {
        // The tiny part is for the rounding of the coefficients. NaN may be anything.
        let spread = self.spread();
        let most = spread + 1e-12 * (spread + self.one.abs());
        self.one.abs() <= most || !most.is_finite()
    }

    /// The same with x and y in each other's place.
    pub(crate) fn transposed(&self) -> Self {
        Self {
            x: self.y,
            y: self.x,
            xx: self.yy,
            yy: self.xx,
            ..*self
        }
    }

    /// The places where the zeros cross a line y = const: once with the polynomial rising in the direction of x, once
    /// with it falling; NaN, infinite or far off where they do not.
    ///
    /// The root that adds numbers of one sign is computed as it stands, the other from the product
    /// of both: a x² + 2 b x + c.
    pub(crate) fn crossings(&self, y: f64) -> [f64; 2] {
        let b = (y * self.xy + self.x) * 0.5;
        let c = (y * self.yy + self.y) * y + self.one;
        // Where rounding decides whether there are two roots or none, there is a double one: a plane
        // through the eye cuts a sphere in a circle that is seen as a line.
        const DOUBLE: f64 = 1e-13;
        const ROUNDINGS: f64 = 1e-15;
        let (square, product) = (b * b, c * self.xx);
        let discriminant = square - product;
        let summands = (0.5 * self.x.abs() + 0.25 * self.xy.abs()).powi(2)
            + self.xx.abs() * (self.one.abs() + 0.5 * self.y.abs() + 0.25 * self.yy.abs());
        let is_double =
            discriminant.abs() < (square + product.abs()) * DOUBLE + summands * ROUNDINGS;
        let root = if is_double { 0.0 } else { discriminant }.sqrt();
        let sum = b.abs() + root;
        let (near, far) = (c / sum, sum / self.xx);
        if b > 0.0 { [-near, -far] } else { [far, near] }
    }

    /// The lines y = const that the zeros touch, as (x, y) of the points where they do; NaN where
    /// there are none.
    pub(crate) fn extremes(&self) -> [(f64, f64); 2] {
        // The discriminant of the crossings, as a polynomial of y.
        let leading = 0.25 * self.xy * self.xy - self.xx * self.yy;
        let half = 0.25 * self.x * self.xy - 0.5 * self.xx * self.y;
        let constant = 0.25 * self.x * self.x - self.xx * self.one;
        let root = (half * half - leading * constant).sqrt();
        let sum = -(half + root.copysign(half));
        both([sum / leading, constant / sum], |y| {
            let x = -0.5 * (self.x + self.xy * y) / self.xx;
            (x, y)
        })
    }
}

impl Mul for Linear {
    type Output = Quadratic;

    fn mul(self, other: Self) -> Quadratic {
        Quadratic {
            one: self.one * other.one,
            x: self.one * other.x + self.x * other.one,
            y: self.one * other.y + self.y * other.one,
            xx: self.x * other.x,
            xy: self.x * other.y + self.y * other.x,
            yy: self.y * other.y,
        }
    }
}

impl Mul<f64> for Quadratic {
    type Output = Self;

    fn mul(self, factor: f64) -> Self {
        Self {
            one: self.one * factor,
            x: self.x * factor,
            y: self.y * factor,
            xx: self.xx * factor,
            xy: self.xy * factor,
            yy: self.yy * factor,
        }
    }
}

impl Add for Quadratic {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        Self {
            one: self.one + other.one,
            x: self.x + other.x,
            y: self.y + other.y,
            xx: self.xx + other.xx,
            xy: self.xy + other.xy,
            yy: self.yy + other.yy,
        }
    }
}

impl Sub for Quadratic {
    type Output = Self;

    fn sub(self, other: Self) -> Self {
        self + other * -1.0
    }
}

#[cfg(test)]
mod tests;
