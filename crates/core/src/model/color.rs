//! Color, and light in one channel or in three.

use std::ops::{Add, AddAssign, Mul};

use glam::DVec3;

/// A linear color with Rec. 709 primaries: x red, y green, z blue.
pub type Color = DVec3;

/// An amount of light per channel: `f64` for a scene without color, [`Color`] for one with.
///
/// What computes light is generic over this, so that a grey scene costs one channel only.
pub trait Radiance:
    Copy + Send + Sync + Add<Output = Self> + AddAssign + Mul<Output = Self> + Mul<f64, Output = Self>
{
    /// No light.
    const ZERO: Self;

    /// Number of channels.
    const CHANNELS: usize;

    /// The channels of `color` that this type counts; a grey one keeps the first.
    fn from_color(color: Color) -> Self;

    /// The channels in their order.
    fn channels(&self) -> &[f64];

    /// The lesser of the two in each channel.
    fn min(self, other: Self) -> Self;

    /// The greater of the two in each channel.
    fn max(self, other: Self) -> Self;
}

impl Radiance for f64 {
    const ZERO: Self = 0.0;
    const CHANNELS: usize = 1;

    fn from_color(color: Color) -> Self {
        color.x
    }

    fn channels(&self) -> &[f64] {
        std::slice::from_ref(self)
    }

    fn min(self, other: Self) -> Self {
        f64::min(self, other)
    }

    fn max(self, other: Self) -> Self {
        f64::max(self, other)
    }
}

impl Radiance for Color {
    const ZERO: Self = DVec3::ZERO;
    const CHANNELS: usize = 3;

    fn from_color(color: Color) -> Self {
        color
    }

    fn channels(&self) -> &[f64] {
        self.as_ref()
    }

    fn min(self, other: Self) -> Self {
        DVec3::min(self, other)
    }

    fn max(self, other: Self) -> Self {
        DVec3::max(self, other)
    }
}

/// Whether all channels of a color are the same.
pub(crate) fn is_grey(color: Color) -> bool {
    color.x == color.y && color.y == color.z
}
