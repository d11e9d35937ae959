//! Color.

use glam::DVec3;

/// A linear color with Rec. 709 primaries: x red, y green, z blue.
///
/// # Example
/// ```
/// use marbles_core::{Color, World};
///
/// let mut world = World::new();
/// world.ambient = Color::new(0.5, 0.25, 0.125);
/// assert_eq!(world.ambient.x, 0.5); // red
/// ```
pub type Color = DVec3;

/// True where all channels of a color are the same.
pub(crate) fn is_grey(color: Color) -> bool {
    color.x == color.y && color.y == color.z
}
