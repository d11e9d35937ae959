//! Angles as points of the unit circle.

/// An angle, held as its sine and cosine.
///
/// Rotations need nothing else, and many angles are exact in this form that are not in radians:
/// a quarter turn, or the direction of a vector with whole coordinates.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Angle {
    /// Sine of the angle.
    pub sin: f64,
    /// Cosine of the angle.
    pub cos: f64,
}

impl Angle {
    /// No turn at all.
    pub const ZERO: Self = Self { sin: 0.0, cos: 1.0 };

    /// The angle of `radians`.
    pub fn from_radians(radians: f64) -> Self {
        let (sin, cos) = libm::sincos(radians);
        Self { sin, cos }
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
        let Self { sin, cos } =
            Self::from_radians((degrees - QUARTER_TURN * quarters).to_radians());
        match (quarters as i32).rem_euclid(4) {
            0 => Self { sin, cos },
            1 => Self {
                sin: cos,
                cos: -sin,
            },
            2 => Self {
                sin: -sin,
                cos: -cos,
            },
            _ => Self {
                sin: -cos,
                cos: sin,
            },
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
        Self {
            sin: opposite / hypotenuse,
            cos: adjacent / hypotenuse,
        }
    }

    /// The angle in degrees, from −180 to 180.
    pub fn degrees(self) -> f64 {
        libm::atan2(self.sin, self.cos).to_degrees()
    }
}

#[cfg(test)]
mod tests;
