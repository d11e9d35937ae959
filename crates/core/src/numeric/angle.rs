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
mod tests {
    use super::*;

    #[test]
    fn quarter_turns_are_exact() {
        for turns in -3..=3 {
            let at = |quarter: i32| Angle::from_degrees(f64::from(360 * turns + 90 * quarter));
            assert_eq!(at(0), Angle { sin: 0.0, cos: 1.0 });
            assert_eq!(at(1), Angle { sin: 1.0, cos: 0.0 });
            assert_eq!(
                at(2),
                Angle {
                    sin: 0.0,
                    cos: -1.0
                }
            );
            assert_eq!(
                at(3),
                Angle {
                    sin: -1.0,
                    cos: 0.0
                }
            );
        }
    }

    #[test]
    fn degrees_come_back() {
        for tenths in -1799..=1799 {
            let degrees = f64::from(tenths) / 10.0;
            assert!((Angle::from_degrees(degrees).degrees() - degrees).abs() < 1e-13);
        }
    }

    #[test]
    fn sides_of_any_size_make_an_angle() {
        for scale in [1e-300, 1.0, 1e300] {
            let angle = Angle::from_sides(3.0 * scale, 4.0 * scale);
            assert!((angle.sin - 0.6).abs() < 1e-15 && (angle.cos - 0.8).abs() < 1e-15);
        }
        assert_eq!(Angle::from_sides(0.0, 0.0), Angle::ZERO);
        assert_eq!(
            Angle::from_sides(-7.0, 0.0),
            Angle {
                sin: -1.0,
                cos: 0.0
            }
        );
    }
}
