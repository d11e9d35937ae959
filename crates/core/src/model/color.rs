//! Color.

use glam::DVec3;

/// A linear color with Rec. 709 primaries: x red, y green, z blue.
pub type Color = DVec3;

/// True where all channels of a color are the same.
pub(crate) fn is_grey(color: Color) -> bool {
    color.x == color.y && color.y == color.z
}
