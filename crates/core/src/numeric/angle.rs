//! Angles as points of the unit circle.

use super::double_double::DoubleDouble;
use crate::numeric::pair::both;

/// An angle, held as its sine and cosine.
///
/// Rotations need nothing else, and many angles are exact in this form that are not in radians:
/// a quarter turn, or the direction of a vector with whole coordinates.
///
/// # Example
/// ```
/// use marbles_core::Angle;
///
/// let quarter = Angle::from_degrees(90.0);
/// assert_eq!((quarter.sin, quarter.cos), (1.0, 0.0)); // exactly
/// assert_eq!(Angle::from_degrees(90.0 + 360.0), quarter);
/// assert_eq!(Angle::from_sides(1.0, 1.0).degrees(), 45.0);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Angle {
    /// Sine of the angle.
    pub sin: f64,
    /// Cosine of the angle.
    pub cos: f64,
    /// The second halves of sine and cosine in twice the precision of a double; 0 if they are not known.
    pub(crate) rest: [f64; 2],
}

impl Angle {
    /// No turn at all.
    pub const ZERO: Self = Self::new(0.0, 1.0);

    /// The angle with this sine and cosine, whose squares have the sum 1.
    pub const fn new(sin: f64, cos: f64) -> Self {
        let rest = [0.0; 2];
        Self { sin, cos, rest }
    }

    /// The angle of `radians`.
    pub fn from_radians(radians: f64) -> Self {
        let (sin, cos) = libm::sincos(radians);
        Self::new(sin, cos)
    }

    /// The angle of `degrees`, any finite number of turns.
    ///
    /// # Accuracy
    /// Multiples of 90 are exact, and angles whose difference is a multiple of 360 without
    /// rounding are the same angle to the bit: `fmod` is exact, and so is the subtraction of the
    /// nearest quarter turn (Sterbenz's lemma).
    pub fn from_degrees(degrees: f64) -> Self {
        const QUARTER_TURN: f64 = 90.0;
        let degrees = libm::fmod(degrees, 4.0 * QUARTER_TURN);
        let quarters = libm::round(degrees / QUARTER_TURN);
        let within = degrees - QUARTER_TURN * quarters;
        let turned = |[sin, cos]: [f64; 2]| match (quarters as i32).rem_euclid(4) {
            0 => [sin, cos],
            1 => [cos, -sin],
            2 => [-sin, -cos],
            _ => [-cos, sin],
        };
        let (sin, cos) = libm::sincos(within.to_radians());
        let [sin_rest, cos_rest] = precise(within);
        let rest = [(sin_rest - sin.into()).high, (cos_rest - cos.into()).high];
        let [sin, cos] = turned([sin, cos]);
        Self {
            sin,
            cos,
            rest: turned(rest),
        }
    }

    /// Sine and cosine, to twice the precision of a double where that is known.
    pub(crate) fn precise(self) -> [Precise; 2] {
        let [sin_rest, cos_rest] = self.rest;
        both(
            [(self.sin, sin_rest), (self.cos, cos_rest)],
            Precise::from_parts,
        )
    }

    /// The angle turned the other way.
    pub(crate) fn reversed(self) -> Self {
        let [sin_rest, cos_rest] = self.rest;
        Self {
            sin: -self.sin,
            cos: self.cos,
            rest: [-sin_rest, cos_rest],
        }
    }

    /// The angle of a right triangle's corner with the given opposite and adjacent sides, of any
    /// sign; `ZERO` where both are zero.
    pub fn from_sides(opposite: f64, adjacent: f64) -> Self {
        // Dividing by the larger side first keeps the hypotenuse finite.
        let scale = opposite.abs().max(adjacent.abs());
        if scale == 0.0 {
            return Self::ZERO;
        }
        let (opposite, adjacent) = (opposite / scale, adjacent / scale);
        let hypotenuse = libm::hypot(opposite, adjacent);
        Self::new(opposite / hypotenuse, adjacent / hypotenuse)
    }

    /// The angle in degrees, from −180 to 180.
    pub fn degrees(self) -> f64 {
        libm::atan2(self.sin, self.cos).to_degrees()
    }
}

/// Numbers of twice the precision of a double, on any processor.
pub(crate) type Precise = DoubleDouble<false>;

/// Sine and cosine of at most 45 degrees, by their series.
///
/// # Accuracy
/// 1e-31: the first term that is left out is below 1e-33.
fn precise(degrees: f64) -> [Precise; 2] {
    // π/180, and what that lacks.
    const RADIANS: Precise = Precise {
        high: 0.017453292519943295,
        low: 2.9486522708701687e-19,
    };
    const TERMS: i32 = 29;
    let radians = Precise::from(degrees) * RADIANS;
    let mut sums = [Precise::from(0.0), Precise::from(1.0)];
    let mut term = Precise::from(1.0);
    for power in 1..=TERMS {
        term = term * radians / Precise::from(f64::from(power));
        let sum = &mut sums[usize::from(power % 2 == 0)];
        *sum = if power % 4 < 2 {
            *sum + term
        } else {
            *sum - term
        };
    }
    sums
}

#[cfg(test)]
mod tests;
