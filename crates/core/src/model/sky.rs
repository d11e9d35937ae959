//! The light of the sky.

use glam::DVec3;

use super::color::Color;
use super::emission::unit;
use super::light_error::LightError;

/// Light of one radiance from the directions above a plane, and of another from those below it.
///
/// # Example
/// ```
/// use marbles_core::glam::DVec3;
/// use marbles_core::{Sky, World};
///
/// let mut world = World::new();
/// world.sky = Some(Sky::uniform(DVec3::splat(0.5)));
/// let blue = DVec3::new(0.4, 0.6, 1.0);
/// world.sky = Some(Sky::in_halves(blue, DVec3::splat(0.2), DVec3::Y)?);
/// # Ok::<(), marbles_core::LightError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sky {
    pub(crate) above: Color,
    pub(crate) below: Color,
    pub(crate) up: DVec3,
}

impl Sky {
    /// The same radiance from everywhere.
    pub fn uniform(radiance: Color) -> Self {
        Self {
            above: radiance,
            below: radiance,
            up: DVec3::Y,
        }
    }

    /// One radiance from above the plane across `up`, a vector in the world frame of any finite length, and another from
    /// below.
    ///
    /// # Errors
    /// Refuses a vector that is zero or not finite: it has no direction.
    pub fn in_halves(above: Color, below: Color, up: DVec3) -> Result<Self, LightError> {
        let up = unit(up).ok_or(LightError::Up(up))?;
        Ok(Self { above, below, up })
    }

    /// The radiance above the plane.
    pub fn above(&self) -> Color {
        self.above
    }

    /// The radiance below the plane.
    pub fn below(&self) -> Color {
        self.below
    }

    /// The unit vector across the plane, in the world frame.
    pub fn up(&self) -> DVec3 {
        self.up
    }

    /// True if the light of both reaches points by the same parts: by one of all of it, or by those of two halves.
    pub(crate) fn has_parts_of(&self, other: &Self) -> bool {
        match (self.above == self.below, other.above == other.below) {
            (true, true) => true,
            (false, false) => self.up == other.up,
            _ => false,
        }
    }

    /// The larger radiance in each channel.
    pub(crate) fn brightest(&self) -> Color {
        self.above.max(self.below)
    }
}
