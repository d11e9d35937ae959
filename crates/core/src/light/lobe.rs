//! The directions in which a lamp such as an LED sends its light.

use fearless_simd::Simd;
use glam::{DMat3, DVec3};

use super::reflection::Falloff;
use crate::model::emission::Emission;
use crate::numeric::lanes::f64x8;
use crate::numeric::vectors::Vectors;

/// The light that a lamp sends in each direction, in the frame of the points that it lights: a power of the cosine of the
/// angle to the one that it faces.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Lobe {
    /// Unit vector in which the lamp faces.
    pub(crate) direction: DVec3,
    falloff: Falloff,
}

/// The light in directions that a lamp faces away from.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub(crate) enum Beyond {
    /// None: as it is.
    Nothing,
    /// The power, continued as the same polynomial where it is one of a low degree: where the cutoff is an edge, light
    /// beside it is then as smooth on both sides.
    Continued,
}

impl Lobe {
    /// The lobe of an emission, in another frame than the world's.
    pub(crate) fn new(emission: &Emission, from_world: &DMat3) -> Self {
        Self {
            direction: *from_world * emission.direction(),
            falloff: Falloff::new(emission.mu()),
        }
    }

    /// The lobe of an emission in the world's frame.
    pub(crate) fn in_world(emission: &Emission) -> Self {
        Self::new(emission, &DMat3::IDENTITY)
    }

    /// The power of the cosine.
    pub(crate) fn mu(&self) -> f64 {
        self.falloff.exponent
    }

    /// Returns whether the light begins at the cutoff with a power that is not whole, and is not smooth there.
    pub(crate) fn is_singular(&self) -> bool {
        /// Powers that are smooth enough where they begin: the sixth derivative is bounded.
        const SMOOTH: f64 = 6.0;
        self.mu().fract() != 0.0 && self.mu() < SMOOTH
    }

    /// Returns whether rules may step over the light, if they follow no other one that turns as fast.
    pub(crate) fn is_narrow(&self) -> bool {
        /// Powers that rules with six nodes along chords, and those across, integrate as polynomials.
        const BROAD: f64 = 8.0;
        self.mu() > BROAD
    }

    /// The factors of the intensity for unit vectors toward the lamp.
    #[inline(never)]
    pub(super) fn toward<S: Simd>(&self, toward: &Vectors<S>, beyond: Beyond) -> f64x8<S> {
        let simd = toward.x.simd();
        simd.vectorize(
            #[inline(always)]
            || {
                let zero = f64x8::splat(simd, 0.0);
                let one = f64x8::splat(simd, 1.0);
                let cosine = -toward.dot_one(self.direction);
                match beyond {
                    Beyond::Nothing => {
                        let power = if self.mu() == 0.0 {
                            one
                        } else {
                            self.falloff.of(cosine)
                        };
                        cosine.simd_gt(0.0).select(power, zero)
                    }
                    Beyond::Continued if self.mu() == 0.0 => one,
                    Beyond::Continued => self.falloff.continued(cosine),
                }
            },
        )
    }
}
