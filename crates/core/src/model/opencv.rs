//! Cameras as OpenCV has them.
//!
//! The world's axes are left-handed, and no rotation leads from them to a right-handed frame. The world
//! is therefore handed out with z negated: X = (x, y, −z) is right-handed. OpenCV's camera axes are
//! x right, y down, z forward. With W the rotation from the camera's axes to the world's and e the
//! viewpoint,
//!
//! ```text
//! x_camera = R X + t,   R = D Wᵀ F,   t = −D Wᵀ e,   D = diag(1, −1, 1),   F = diag(1, 1, −1)
//! ```
//!
//! and det R = det D · det W · det F = 1. D and F change signs only, so that R has the digits of W.
//! Pixel (0, 0) is the *center* of the first pixel, half a pixel from the corner of the picture.

use glam::{DMat3, DVec2, DVec3};

use super::camera::{Camera, Lens};
use super::view::View;

/// The factors that turn a camera's y up into OpenCV's y down, and back.
const DOWN: DVec3 = DVec3::new(1.0, -1.0, 1.0);

/// Converts a point or a direction from the world to the right-handed world with z negated, or back.
pub fn right_handed(vector: DVec3) -> DVec3 {
    // Without `+ 0` there would be negative zeros, which readers of files stumble over.
    DVec3::new(vector.x, vector.y, -vector.z) + DVec3::ZERO
}

/// The place of a camera: `x_camera = rotation · X + translation`, from the right-handed world with z
/// negated to OpenCV's axes.
///
/// # Example
/// ```
/// use marbles_core::glam::DVec3;
/// use marbles_core::{Angle, Camera, Extrinsics};
///
/// let camera = Camera::look_at(DVec3::new(0.0, 0.0, -5.0), DVec3::ZERO, Angle::ZERO)?;
/// let extrinsics = Extrinsics::of(&camera);
/// // y is down.
/// assert_eq!(extrinsics.point(DVec3::new(1.0, 2.0, 0.0)), DVec3::new(1.0, -2.0, 5.0));
/// assert_eq!(extrinsics.camera().position, camera.position);
/// # Ok::<(), marbles_core::CameraError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Extrinsics {
    /// R, of determinant 1.
    pub rotation: DMat3,
    /// t, in scene units.
    pub translation: DVec3,
}

impl Extrinsics {
    /// The place of this camera.
    pub fn of(camera: &Camera) -> Self {
        let camera_from_world = camera.world_from_camera.transpose();
        let translation = DOWN * -(camera_from_world * camera.position);
        Self {
            rotation: mirrored(camera_from_world),
            translation: translation + DVec3::ZERO,
        }
    }

    /// The camera at this place.
    pub fn camera(&self) -> Camera {
        let world_from_camera = mirrored(self.rotation).transpose();
        let in_world = |place: DVec3| -(world_from_camera * (DOWN * place)) + DVec3::ZERO;
        Camera {
            position: in_world(self.translation),
            on_axis: in_world(self.translation.with_z(0.0)),
            world_from_camera,
        }
    }

    /// A point of the (left-handed) world in OpenCV's axes.
    pub fn point(&self, position: DVec3) -> DVec3 {
        self.rotation * right_handed(position) + self.translation
    }

    /// A direction of the (left-handed) world in OpenCV's axes.
    pub fn direction(&self, toward: DVec3) -> DVec3 {
        self.rotation * right_handed(toward)
    }
}

/// D M F, which is its own inverse.
fn mirrored(matrix: DMat3) -> DMat3 {
    let columns = [matrix.x_axis, matrix.y_axis, -matrix.z_axis];
    let [x, y, z] = columns.map(|column| DOWN * column + DVec3::ZERO);
    DMat3::from_cols(x, y, z)
}

/// The matrix of a pinhole camera: a point is seen at `focal_lengths · (x, y) / z + principal_point`, with the products
/// of components.
///
/// These coordinates count from the center of the first pixel, as OpenCV does. [`View::project`] counts from the corner of the
/// picture, so its coordinates are larger by half a pixel.
///
/// # Example
/// ```
/// use marbles_core::glam::DVec2;
/// use marbles_core::{Angle, Camera, Intrinsics, Lens, View};
///
/// let lens = Lens::from_field_of_view(Angle::from_degrees(90.0))?;
/// let intrinsics = Intrinsics::of(&View::new(Camera::default(), lens, 100, 60));
/// // Half the width is 50 pixels, over tan 45°.
/// assert!((intrinsics.focal_lengths - DVec2::splat(50.0)).length() < 1e-12);
/// assert_eq!(intrinsics.principal_point, DVec2::new(49.5, 29.5));
/// # Ok::<(), marbles_core::CameraError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Intrinsics {
    /// The distance of the retina in widths and in heights of a pixel, greater than 0: equal if pixels are square.
    pub focal_lengths: DVec2,
    /// The pixel that the axis of view passes, (0, 0) at the center of the first one.
    pub principal_point: DVec2,
}

impl Intrinsics {
    /// The matrix of this view, with its zoom.
    ///
    /// The focal lengths are infinite for a parallel lens, for which you can use [`View::pixels_per_unit`]. They are also
    /// infinite if the distance of the retina, in pixels, is beyond the range of doubles.
    pub fn of(view: &View) -> Self {
        let shift = view.lens.shift / view.pixel_size();
        let middle = middle(view.width, view.height);
        let across = view.lens.distance * view.zoom / view.pixel_size().x;
        Self {
            focal_lengths: DVec2::new(across, across * view.lens.pixel_aspect),
            principal_point: DVec2::new(middle.x - shift.x, middle.y + shift.y),
        }
    }

    /// The lens that has this matrix in a picture of so many pixels, at zoom 1: its retina is measured in widths of a
    /// pixel.
    pub fn lens(&self, width: u32, height: u32) -> Lens {
        let aside = middle(width, height) - self.principal_point;
        let pixel_aspect = self.focal_lengths.y / self.focal_lengths.x;
        Lens {
            width: f64::from(width),
            distance: self.focal_lengths.x,
            shift: DVec2::new(aside.x, -aside.y / pixel_aspect),
            pixel_aspect,
        }
    }

    /// K.
    pub fn matrix(&self) -> DMat3 {
        let DVec2 { x, y } = self.principal_point;
        DMat3::from_cols(
            DVec3::new(self.focal_lengths.x, 0.0, 0.0),
            DVec3::new(0.0, self.focal_lengths.y, 0.0),
            DVec3::new(x, y, 1.0),
        )
    }
}

/// The middle of a picture.
fn middle(width: u32, height: u32) -> DVec2 {
    0.5 * (DVec2::new(f64::from(width), f64::from(height)) - DVec2::ONE)
}

#[cfg(test)]
mod tests;
