//! The planes between the viewpoint and the edges of pixels.

use glam::{DVec2, DVec3};

use crate::View;
use crate::rounding::UNIT_ROUNDOFF;

/// A sphere in the camera's frame, its radius with more than what rounding may cost.
#[derive(Clone, Copy, Debug)]
pub(super) struct InCamera {
    center: DVec3,
    radius: f64,
}

impl InCamera {
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

    /// Whether all of the sphere may be behind the viewpoint, where no ray goes.
    pub(super) fn is_behind(&self) -> bool {
        self.center.z < -self.radius
    }
}

/// The planes through the viewpoint and the edges of tiles, in the camera's frame.
#[derive(Clone, Debug)]
pub(super) struct Planes {
    /// Between tiles side by side, from the left; the normals point right.
    columns: Vec<DVec2>,
    /// Between tiles one above the other, from the top; the normals point down.
    rows: Vec<DVec2>,
}

impl Planes {
    /// The planes of tiles with this side.
    pub(super) fn new(view: &View, tile_side: u32) -> Self {
        let distance = view.lens.distance * view.zoom;
        let pixel = view.pixel_size();
        let planes = |pixels: u32, sign: f64, shift: f64| {
            let edges = (0..pixels).step_by(tile_side as usize).chain([pixels]);
            let plane = |edge: u32| {
                let on_retina = sign * (f64::from(edge) - 0.5 * f64::from(pixels)) * pixel + shift;
                let length = libm::hypot(distance, on_retina);
                sign * DVec2::new(distance / length, -on_retina / length)
            };
            edges.map(plane).collect()
        };
        Self {
            columns: planes(view.width, 1.0, view.lens.shift.x),
            rows: planes(view.height, -1.0, view.lens.shift.y),
        }
    }

    /// Tiles side by side.
    pub(super) fn columns(&self) -> usize {
        self.columns.len() - 1
    }

    /// Tiles one above the other.
    pub(super) fn rows(&self) -> usize {
        self.rows.len() - 1
    }

    /// Whether the sphere may be seen in this column of tiles.
    pub(super) fn is_in_column(&self, sphere: &InCamera, column: usize) -> bool {
        let across = DVec2::new(sphere.center.x, sphere.center.z);
        is_between(&self.columns[column..column + 2], across, sphere.radius)
    }

    /// Whether the sphere may be seen in this row of tiles.
    pub(super) fn is_in_row(&self, sphere: &InCamera, row: usize) -> bool {
        let across = DVec2::new(sphere.center.y, sphere.center.z);
        is_between(&self.rows[row..row + 2], across, sphere.radius)
    }
}

/// Whether a sphere reaches between two planes; true where a number is not finite.
fn is_between(planes: &[DVec2], center: DVec2, radius: f64) -> bool {
    !(planes[0].dot(center) < -radius || planes[1].dot(center) > radius)
}
