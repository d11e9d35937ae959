//! The bounds of the rays of a tile.

use glam::DVec3;

use crate::model::camera::Projection;

/// The bounds of all rays of a tile.
#[derive(Clone, Copy, Debug)]
pub(super) struct Bundle {
    pub(super) projection: Projection,
    /// Around them; none where it would be wider than is worth having, and for parallel rays.
    pub(super) cone: Option<Cone>,
    pub(super) rows: Lines,
    pub(super) columns: Lines,
    /// No direction is shorter.
    pub(super) shortest: f64,
    /// No direction is longer.
    pub(super) longest: f64,
}

/// A circular cone with its tip in the viewpoint.
#[derive(Clone, Copy, Debug)]
pub(super) struct Cone {
    /// Unit, in the world frame.
    pub(super) axis: DVec3,
    /// The sine of the angle between the axis and the surface.
    pub(super) sine: f64,
    pub(super) cosine: f64,
}

/// The places of the rows of a tile, from above, or of its columns, from the left.
#[derive(Clone, Copy, Debug)]
pub(super) struct Lines {
    /// Unit axes of the camera, in the world frame: toward the first lines, and forward.
    pub(super) up: DVec3,
    pub(super) forward: DVec3,
    /// The number of lines on a length of 1 at the distance of 1.
    pub(super) on_unit: f64,
    /// The way from the tile's first edge to the lens's axis, in lines.
    pub(super) origin: f64,
    /// More than any number of lines that is added up.
    pub(super) size: f64,
    /// The places of the first and last samples of a line in it.
    pub(super) first: f64,
    pub(super) last: f64,
    pub(super) count: u32,
}
