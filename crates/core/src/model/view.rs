//! The view from which a world is rendered.

use glam::{DVec2, DVec3};

use super::camera::{Camera, Lens, Projection};
use super::outline::OutlineView;
use super::ray::Ray;

/// One picture to take: camera, lens, and the pixels of the retina.
///
/// # Example
/// ```
/// use marbles_core::glam::{DVec2, DVec3};
/// use marbles_core::{Angle, Camera, Lens, View};
///
/// let lens = Lens::from_field_of_view(Angle::from_degrees(40.0))?;
/// let view = View::new(Camera::default(), lens, 640, 480);
/// // A point on the axis of view is seen in the middle.
/// let middle = view.project(DVec3::new(0.0, 0.0, 5.0));
/// assert_eq!(middle, Some(DVec2::new(320.0, 240.0)));
/// assert_eq!(view.project(DVec3::NEG_Z), None);
/// let closer = View { zoom: 2.0, ..view };
/// assert_eq!(closer.pixels_per_unit(), 2.0 * view.pixels_per_unit());
/// assert_eq!(view.pixel_size().x, view.pixel_size().y);
/// # Ok::<(), marbles_core::CameraError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct View {
    /// The viewpoint and the directions of the camera.
    pub camera: Camera,
    /// Its retina.
    pub lens: Lens,
    /// The factor by which the retina's distance is multiplied, or the width of a parallel lens is divided, greater
    /// than 0.
    pub zoom: f64,
    /// Columns of the picture, at least 1.
    pub width: u32,
    /// Rows of the picture, at least 1.
    pub height: u32,
    /// Number of the frame; only [`crate::Grain::Pixel`] depends on it.
    pub frame: i64,
}

impl View {
    /// Creates the view through a lens into a picture of so many columns and rows, without zoom, as frame 1.
    pub fn new(camera: Camera, lens: Lens, width: u32, height: u32) -> Self {
        Self {
            camera,
            lens,
            zoom: 1.0,
            width,
            height,
            frame: 1,
        }
    }

    /// Width and height of a pixel on the retina, in scene units.
    pub fn pixel_size(&self) -> DVec2 {
        let width = self.lens.width / f64::from(self.width);
        DVec2::new(width, width / self.lens.pixel_aspect)
    }

    /// The numbers of pixels that a length of 1 spans across and upward on the plane at distance 1 in front of the
    /// viewpoint; for a parallel lens, on any plane perpendicular to the axis of view.
    pub fn pixels_per_unit(&self) -> DVec2 {
        let across = self.magnification() / self.pixel_size().x;
        DVec2::new(across, across * self.lens.pixel_aspect)
    }

    /// The length on the retina of a length of 1 on the plane at distance 1 in front of the viewpoint; for a parallel
    /// lens, on any plane perpendicular to the axis of view.
    pub fn magnification(&self) -> f64 {
        match self.lens.projection() {
            Projection::Central => self.lens.distance * self.zoom,
            Projection::Parallel => self.zoom,
        }
    }

    /// The part of the plane at distance 1 in front of the viewpoint that the picture shows: its center, to the right
    /// and up from the axis of view, and its width and height.
    pub fn screen_window(&self) -> (DVec2, DVec2) {
        let magnification = self.magnification();
        let width = self.lens.width / magnification;
        let height = width * f64::from(self.height) / f64::from(self.width);
        (
            self.lens.shift / magnification,
            DVec2::new(width, height / self.lens.pixel_aspect),
        )
    }

    /// The part of the view that the outlines of spheres depend on.
    pub(crate) fn outline_view(&self) -> OutlineView {
        OutlineView {
            pixel: 1.0 / (self.pixels_per_unit().x * self.lens.pixel_aspect.sqrt()),
            projection: self.lens.projection(),
        }
    }

    /// The ray through a point of the retina. It begins at the viewpoint. For a parallel lens it begins on the plane
    /// through the viewpoint, at the point that is seen there, and its direction is a unit vector.
    pub fn ray(&self, retina_point: DVec2) -> Ray {
        let axes = &self.camera.world_from_camera;
        match self.lens.projection() {
            Projection::Central => Ray {
                origin: self.camera.position,
                direction: *axes * retina_point.extend(self.lens.distance * self.zoom),
            },
            Projection::Parallel => {
                let DVec2 { x, y } = retina_point / self.zoom;
                Ray {
                    origin: self.camera.position + (axes.x_axis * x + axes.y_axis * y),
                    direction: axes.z_axis,
                }
            }
        }
    }

    /// The retina point (u, v) in the middle of a cell of the grid that divides every pixel into
    /// `divisions` × `divisions` cells; cell (0, 0) is the top left one.
    ///
    /// Points that mirror each other in the middle of an unshifted retina do so to the bit.
    pub fn cell_center(&self, col: u64, row: u64, divisions: u32) -> DVec2 {
        let width = self.lens.width / (f64::from(self.width) * f64::from(divisions));
        let height = width / self.lens.pixel_aspect;
        // Twice the distance from the middle, in cells: a whole number.
        let twice = |index: u64, pixels: u32| {
            2 * index as i64 + 1 - i64::from(divisions) * i64::from(pixels)
        };
        let u = 0.5 * width * twice(col, self.width) as f64;
        let v = -0.5 * height * twice(row, self.height) as f64;
        DVec2::new(u, v) + self.lens.shift
    }

    /// The pixel coordinates (column, row) at which a world point is seen; pixel (0, 0) spans
    /// from 0 to 1. `None` when the point is not in front of the viewpoint.
    ///
    /// These coordinates count from the corner of the picture. [`Intrinsics`](crate::Intrinsics) counts from the center of
    /// the first pixel, as OpenCV does, so its coordinates are smaller by half a pixel.
    pub fn project(&self, point: DVec3) -> Option<DVec2> {
        let from_eye = point - self.camera.position;
        let in_camera = self.camera.world_from_camera.transpose() * from_eye;
        if in_camera.z <= 0.0 {
            return None;
        }
        let scale = match self.lens.projection() {
            Projection::Central => self.lens.distance * self.zoom / in_camera.z,
            Projection::Parallel => self.zoom,
        };
        Some(self.pixel_of(in_camera.truncate() * scale))
    }

    /// The pixel coordinates of a point of the plane of the retina, from the axis of view.
    pub(super) fn pixel_of(&self, point: DVec2) -> DVec2 {
        let on_retina = point - self.lens.shift;
        let size = DVec2::new(f64::from(self.width), f64::from(self.height));
        0.5 * size + DVec2::new(on_retina.x, -on_retina.y) / self.pixel_size()
    }
}

#[cfg(test)]
mod tests;
