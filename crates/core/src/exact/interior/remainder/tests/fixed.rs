//! Numbers with 256 binary places.

use std::ops::{Add, Div, Mul, Sub};

use num_bigint::{BigInt, BigUint};
use num_traits::ToPrimitive;

/// Binary places: far more than doubles have.
const PLACES: usize = 256;

/// A multiple of 2⁻²⁵⁶.
#[derive(Clone, Debug)]
pub(super) struct Fixed(BigInt);

impl Fixed {
    /// A double, without loss where it is a multiple of 2⁻²⁵⁶.
    pub(super) fn new(number: f64) -> Self {
        const MANTISSA: u64 = (1 << 52) - 1;
        let bits = number.to_bits();
        let exponent = (bits >> 52 & 0x7ff) as i32;
        assert!((1..0x7ff).contains(&exponent) || number == 0.0, "{number}");
        if number == 0.0 {
            return Self(BigInt::ZERO);
        }
        let mantissa = BigInt::from(bits & MANTISSA | 1 << 52);
        let shift = exponent - 1075 + PLACES as i32;
        let size = if shift >= 0 {
            mantissa << shift as usize
        } else {
            mantissa >> -shift as usize
        };
        Self(if number < 0.0 { -size } else { size })
    }

    /// The vector (0, 0, 1).
    pub(super) fn axis() -> [Self; 3] {
        [0.0, 0.0, 1.0].map(Self::new)
    }

    pub(super) fn sqrt(&self) -> Self {
        let square = BigUint::try_from(self.0.clone() << PLACES).expect("it is not negative");
        Self(square.sqrt().into())
    }

    pub(super) fn powi(&self, exponent: u32) -> Self {
        let mut power = Self::new(1.0);
        for _ in 0..exponent {
            power = &power * self;
        }
        power
    }

    /// The nearest double, to about 1e-17 of it or 2⁻²⁵⁶.
    pub(super) fn to_f64(&self) -> f64 {
        self.0.to_f64().expect("it is finite") * libm::exp2(-(PLACES as f64))
    }
}

impl Add for &Fixed {
    type Output = Fixed;

    fn add(self, other: Self) -> Fixed {
        Fixed(&self.0 + &other.0)
    }
}

impl Sub for &Fixed {
    type Output = Fixed;

    fn sub(self, other: Self) -> Fixed {
        Fixed(&self.0 - &other.0)
    }
}

impl Mul for &Fixed {
    type Output = Fixed;

    fn mul(self, other: Self) -> Fixed {
        Fixed((&self.0 * &other.0) >> PLACES)
    }
}

impl Div for &Fixed {
    type Output = Fixed;

    fn div(self, other: Self) -> Fixed {
        Fixed((&self.0 << PLACES) / &other.0)
    }
}

/// The sum of products.
pub(super) fn dot(one: &[Fixed; 3], other: &[Fixed; 3]) -> Fixed {
    let products = one.iter().zip(other).map(|(one, other)| one * other);
    products.fold(Fixed::new(0.0), |sum, product| &sum + &product)
}

/// Nodes and weights of Gauss's rule with this many points on [−½, ½].
///
/// Newton's method finds the roots of Legendre's polynomials.
pub(super) fn gauss(points: u32) -> Vec<(Fixed, Fixed)> {
    let one = Fixed::new(1.0);
    let node = |index: u32| {
        let angle = (f64::from(index) + 0.75) / (f64::from(points) + 0.5);
        let mut x = Fixed::new(libm::cos(std::f64::consts::PI * angle));
        let mut slope = one.clone();
        for _ in 0..8 {
            let (mut before, mut value) = (one.clone(), x.clone());
            for degree in 2..=points {
                let (n, rest) = (f64::from(degree), f64::from(degree - 1));
                let next =
                    &(&(&Fixed::new(n + rest) * &x) * &value) - &(&Fixed::new(rest) * &before);
                (before, value) = (value, &next / &Fixed::new(n));
            }
            let rise = &(&x * &value) - &before;
            let slant = &(&x * &x) - &one;
            slope = &(&Fixed::new(f64::from(points)) * &rise) / &slant;
            x = &x - &(&value / &slope);
        }
        let rest = &one - &(&x * &x);
        let weight = &one / &(&rest * &(&slope * &slope));
        (&x * &Fixed::new(0.5), weight)
    };
    (0..points).map(node).collect()
}
