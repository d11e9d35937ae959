//! Colormaps: from numbers to colors.

use glam::DVec3;
use serde::Deserialize;

use crate::values::from_srgb;

/// A scale of 256 colors.
#[derive(Clone, Copy, Debug, Default, Deserialize, Eq, PartialEq)]
pub(crate) enum Colormap {
    #[default]
    Viridis,
    Inferno,
    Magma,
    Plasma,
    Cividis,
    CoolWarm,
    Grey,
}

impl Colormap {
    /// The colors, linear, in the order of the numbers.
    pub(crate) fn colors(self) -> Vec<DVec3> {
        if self == Self::Grey {
            return (0..=255).map(|grey| from_srgb(0x01_01_01 * grey)).collect();
        }
        let color = |line: &str| {
            let digits = line.split(',').nth(self as usize)?;
            u32::from_str_radix(digits, 16).ok().map(from_srgb)
        };
        COLORS.lines().skip(1).filter_map(color).collect()
    }
}

/// The index of a number's color, where `low` has the first and `high` the last; what lies beyond
/// has theirs, and all have the middle one where both are the same.
pub(crate) fn index(number: f64, low: f64, high: f64) -> u8 {
    // Halved, no difference overflows.
    let range = 0.5 * high - 0.5 * low;
    if range <= 0.0 {
        return 128;
    }
    (256.0 * ((0.5 * number - 0.5 * low) / range)) as u8
}

/// A line for each of the 256 numbers, a column for each colormap but `Grey`, in their order.
///
/// # Source
/// The colors of matplotlib 3.11, rounded to 8 bit. Those that are listed there are in the public
/// domain (CC0); CoolWarm is the diverging map of Moreland, "Diverging color maps for scientific
/// visualization", 2009.
const COLORS: &str = include_str!("colormaps.csv");

#[cfg(test)]
mod tests;
