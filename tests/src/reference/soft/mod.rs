//! The light of suns with a disc and of skies, computed by other means than the renderer's.
//!
//! The renderer adds up the arcs that bound the visible directions. Here, the light is an integral over meridians: half
//! circles of directions around the axis of the disc, or around the normal for a sky. A sphere hides an interval of each
//! meridian; the rest is integrated in closed form along the meridian, and by Gauss–Kronrod rules across meridians,
//! between those at which the visible intervals change.
//!
//! | file | contents |
//! |---|---|
//! | `cap.rs` | the directions that a sphere hides, and where the borders of two of them cross |
//! | `meridians.rs` | meridians, what caps hide of them, and the integral over them |
//! | `point.rs` | the light of a sun or of a sky at a point |
//! | `lamps.rs` | the soft lights of a world, and what changes along a surface |
//! | `center.rs` | the light in the middle of a pixel |

mod cap;
mod center;
mod lamps;
mod meridians;
mod point;

pub use center::Center;
pub(crate) use lamps::{SoftState, Softness, Sun};
