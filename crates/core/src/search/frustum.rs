//! The tiles that a sphere may be seen in.

use glam::{DVec2, DVec3};

use crate::model::camera::Projection;
use crate::model::view::View;
use crate::numeric::rounding::UNIT_ROUNDOFF;
use crate::picture::tile::Tile;

/// A sphere whose center is at least so many radii ahead of the eye's plane has a silhouette that is
/// an ellipse whose ends do not cancel; of others nothing is said of where they are seen. Not tuned:
/// any number above 1 by many roundings serves.
pub(crate) const CLEAR: f64 = 1.0 + 1.0 / 64.0;

/// A sphere in the camera's frame, its radius with more than what rounding may cost.
#[derive(Clone, Copy, Debug)]
pub(super) struct CameraSphere {
    center: DVec3,
    radius: f64,
}

impl CameraSphere {
    /// From the vector to the center in the world frame.
    ///
    /// With u the unit roundoff, the rotation costs 6u |f|, the rotation's own columns are unit and
    /// orthogonal up to 16u, a ray deviates by 16u from its place on the retina, and the planes
    /// below cost 8u |f|; 128u |f| covers twice the sum. The places themselves are rounded, which a
    /// large shift of the lens makes worse; but samples lie half a cell inside their pixels, and
    /// cells are far larger than that.
    pub(super) fn new(to_center: DVec3, radius: f64, view: &View) -> Self {
        let center = view.camera.world_from_camera.transpose() * to_center;
        let slack = 128.0 * UNIT_ROUNDOFF * (to_center.abs().element_sum() + radius);
        Self {
            center,
            radius: radius + slack + f64::MIN_POSITIVE,
        }
    }

    /// The sphere in a view whose lengths are those of the world times `scale`.
    pub(super) fn of_view(to_center: DVec3, radius: f64, view: &View, scale: f64) -> Self {
        let sphere = Self::new(to_center, radius, view);
        match view.lens.projection() {
            Projection::Central => sphere,
            Projection::Parallel => sphere.of_parallel_rays(view, scale),
        }
    }

    /// The box around the silhouette on the retina at distance 1: its lowest and highest corner; none
    /// where the sphere comes too near to the eye's plane.
    pub(super) fn silhouette_box(&self) -> Option<(DVec2, DVec2)> {
        let DVec3 { x, y, z } = self.center;
        let product = (z - self.radius) * (z + self.radius);
        let ends = |along: f64| {
            let half = self.radius * (along * along + product).sqrt();
            ((along * z - half) / product, (along * z + half) / product)
        };
        let (x, y) = (ends(x), ends(y));
        let corners = (DVec2::new(x.0, y.0), DVec2::new(x.1, y.1));
        (z > CLEAR * self.radius).then_some(corners)
    }

    /// The same for parallel rays, whose origins are off by their own rounding as well; lengths are those of
    /// the world times `scale`.
    fn of_parallel_rays(self, view: &View, scale: f64) -> Self {
        let place = view.camera.position.abs().max_element();
        let slack = 16.0 * UNIT_ROUNDOFF * place * scale;
        Self {
            radius: self.radius + slack,
            ..self
        }
    }

    /// A bound from below of the distances along parallel rays at which the sphere begins.
    pub(super) fn begin(&self) -> f64 {
        self.center.z - self.radius
    }

    /// True where all of the sphere may be behind the viewpoint, where no ray goes.
    pub(super) fn is_behind(&self) -> bool {
        self.center.z < -self.radius
    }
}

/// The tiles of a picture, along one axis of the retina.
#[derive(Clone, Debug)]
struct Axis {
    /// Planes through the viewpoint between neighboring tiles, in the order of the tiles; the
    /// normals point to higher tiles.
    planes: Vec<DVec2>,
    projection: Projection,
    /// A slope, along the axis over forward, or through a parallel lens a length, times this is in tiles,
    tiles_per_slope: f64,
    /// and so far from the first.
    offset: f64,
}

/// First and last tile.
type Span = (u32, u32);

impl Axis {
    /// The axis of so many pixels with this side on the retina; `sign` is −1 if they count downward.
    fn new(
        view: &View,
        (pixels, pixel): (u32, f64),
        (sign, shift): (f64, f64),
        scale: f64,
    ) -> Self {
        let projection = view.lens.projection();
        let distance = view.magnification();
        let per_length = match projection {
            Projection::Central => distance,
            Projection::Parallel => distance / scale,
        };
        let edges = (0..pixels).step_by(Tile::SIDE as usize).chain([pixels]);
        let plane = |edge: u32| {
            let on_retina = sign * (f64::from(edge) - 0.5 * f64::from(pixels)) * pixel + shift;
            let length = libm::hypot(distance, on_retina);
            sign * DVec2::new(distance / length, -on_retina / length)
        };
        let side = f64::from(Tile::SIDE);
        Self {
            planes: edges.map(plane).collect(),
            projection,
            tiles_per_slope: sign * (per_length / pixel) / side,
            offset: (0.5 * f64::from(pixels) - sign * (shift / pixel)) / side,
        }
    }

    fn tiles(&self) -> u32 {
        self.planes.len() as u32 - 1
    }

    /// The tiles that a sphere reaches into, and few others.
    fn span(&self, center: DVec2, radius: f64) -> Option<Span> {
        /// Far above the rounding errors of the quotient and of the place in tiles: those are
        /// below 10⁻¹² of the sums of absolute values that this is relative to.
        const MARGIN: f64 = 1e-10;
        let (along, forward) = (center.x, center.y);
        if self.projection == Projection::Parallel {
            let (middle, half) = (along * self.tiles_per_slope, radius * self.tiles_per_slope);
            let size = middle.abs() + half.abs() + self.offset.abs() + f64::from(self.tiles());
            let half = half.abs() + MARGIN * size;
            let (low, high) = (middle + self.offset - half, middle + self.offset + half);
            let last = f64::from(self.tiles() - 1);
            if low <= high {
                return (high >= 0.0 && low < last + 1.0)
                    .then(|| (low.max(0.0) as u32, high.min(last) as u32));
            }
            // What is not a number may be anywhere.
            return Some((0, self.tiles() - 1));
        }
        if forward > CLEAR * radius {
            let product = (forward - radius) * (forward + radius);
            let half = radius * (along * along + product).sqrt();
            let scale = self.tiles_per_slope / product;
            let (a, b) = (
                (along * forward - half) * scale,
                (along * forward + half) * scale,
            );
            let size = (along.abs() * forward + half) * scale.abs() + self.offset.abs();
            let margin = MARGIN * (size + f64::from(self.tiles()));
            let (low, high) = (
                a.min(b) + self.offset - margin,
                a.max(b) + self.offset + margin,
            );
            if low <= high {
                let last = f64::from(self.tiles() - 1);
                // In this range the casts cut off what follows the point.
                return (high >= 0.0 && low < last + 1.0)
                    .then(|| (low.max(0.0) as u32, high.min(last) as u32));
            }
        }
        let is_in = |tile: &u32| {
            let tile = *tile as usize;
            is_between(&self.planes[tile..tile + 2], center, radius)
        };
        let first = (0..self.tiles()).find(is_in)?;
        let last = (0..self.tiles()).rfind(is_in)?;
        Some((first, last))
    }
}

/// Half-space tests: true where a sphere reaches between two planes, or a number is not finite.
fn is_between(planes: &[DVec2], center: DVec2, radius: f64) -> bool {
    !(planes[0].dot(center) < -radius || planes[1].dot(center) > radius)
}

/// The tiles of a picture, from a viewpoint or along parallel rays.
#[derive(Clone, Debug)]
pub(super) struct Frustum {
    columns: Axis,
    rows: Axis,
}

/// A rectangle of tiles, ends included.
#[derive(Clone, Copy, Debug)]
pub(super) struct TileRange {
    pub(super) columns: Span,
    pub(super) rows: Span,
}

impl TileRange {
    pub(super) fn count(&self) -> u64 {
        let along = |span: Span| u64::from(span.1 - span.0 + 1);
        along(self.columns) * along(self.rows)
    }
}

impl Frustum {
    /// The frustum of a view cut into tiles, for lengths that are those of the world times `scale`.
    pub(super) fn new(view: &View, scale: f64) -> Self {
        let (shift, pixel) = (view.lens.shift, view.pixel_size());
        Self {
            columns: Axis::new(view, (view.width, pixel.x), (1.0, shift.x), scale),
            rows: Axis::new(view, (view.height, pixel.y), (-1.0, shift.y), scale),
        }
    }

    /// Tiles side by side.
    pub(super) fn columns(&self) -> u32 {
        self.columns.tiles()
    }

    /// Tiles one above the other.
    pub(super) fn rows(&self) -> u32 {
        self.rows.tiles()
    }

    /// A rectangle around the tiles that the sphere may be seen in.
    pub(super) fn range(&self, sphere: &CameraSphere) -> Option<TileRange> {
        if sphere.is_behind() {
            return None;
        }
        let DVec3 { x, y, z } = sphere.center;
        Some(TileRange {
            columns: self.columns.span(DVec2::new(x, z), sphere.radius)?,
            rows: self.rows.span(DVec2::new(y, z), sphere.radius)?,
        })
    }
}
