//! The directions in which an LED sends its light.

use glam::DVec3;

use super::light_error::LightError;

/// The light that a lamp such as an LED sends in each direction: in the one that it faces as much as a point light
/// without an emission, at an angle θ to it the cosine of θ to a power of that, from 90 degrees on nothing.
///
/// # Example
/// ```
/// use marbles_core::glam::DVec3;
/// use marbles_core::{Emission, LightFalloff, PointLight};
///
/// let down = Emission::new(DVec3::new(0.0, -2.0, 0.0), 1.5)?;
/// assert_eq!((down.direction(), down.mu()), (DVec3::NEG_Y, 1.5));
/// let lamp = PointLight::new(DVec3::ZERO, DVec3::ONE, LightFalloff::InverseSquare, 1.0)?;
/// let led = lamp.with_emission(down);
/// assert_eq!(led.emission(), Some(&down));
/// # Ok::<(), marbles_core::LightError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Emission {
    direction: DVec3,
    mu: f64,
}

impl Emission {
    /// Creates the emission of a lamp that faces `direction`, a vector in the world frame of any finite length, with the
    /// power `mu` of the cosine. With 1 the lamp is a small matte surface (Lambert's law); with 0 it sends as much light
    /// in each direction of a half space.
    ///
    /// # Errors
    /// Refuses a vector that is zero or not finite, and a power that is negative or not finite.
    pub fn new(direction: DVec3, mu: f64) -> Result<Self, LightError> {
        let unit = unit(direction).ok_or(LightError::Direction(direction))?;
        if !(mu >= 0.0 && mu.is_finite()) {
            return Err(LightError::Mu(mu));
        }
        // A negative zero would be another power.
        let mu = mu + 0.0;
        Ok(Self {
            direction: unit,
            mu,
        })
    }

    /// Unit vector in which the lamp faces, in the world frame.
    pub fn direction(&self) -> DVec3 {
        self.direction
    }

    /// The power of the cosine.
    pub fn mu(&self) -> f64 {
        self.mu
    }
}

/// The unit vector in the direction of another one, which may be very long or very short; none of zero, and of what is not
/// finite.
pub(super) fn unit(vector: DVec3) -> Option<DVec3> {
    // The largest component becomes 1 first, so that no square over- or underflows.
    let largest = vector.abs().max_element();
    (vector / largest).try_normalize()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn refuses_what_is_no_direction_or_no_power() {
        for direction in [DVec3::ZERO, DVec3::NAN, DVec3::new(1.0, f64::INFINITY, 0.0)] {
            let refused = Emission::new(direction, 1.0);
            assert!(
                matches!(refused, Err(LightError::Direction(_))),
                "{direction}"
            );
        }
        for mu in [-1e-9, f64::NAN, f64::INFINITY] {
            let refused = Emission::new(DVec3::Z, mu);
            assert!(matches!(refused, Err(LightError::Mu(_))), "{mu}");
        }
    }

    #[test]
    fn directions_of_any_length_become_unit_vectors() {
        for scale in [1e-300, 1.0, 1e300] {
            let emission = Emission::new(DVec3::new(3.0, 0.0, -4.0) * scale, 2.0).unwrap();
            let apart = emission.direction() - DVec3::new(0.6, 0.0, -0.8);
            assert!(apart.length() < 1e-15, "{scale:e}");
        }
    }

    #[test]
    fn a_negative_zero_is_zero() {
        let emission = Emission::new(DVec3::Z, -0.0).unwrap();
        assert!(emission.mu().is_sign_positive());
    }
}
