//! The camera: where it stands, where it looks, and its lens.

use std::fmt;

use glam::{DMat3, DVec2, DVec3};

use crate::numeric::angle::{Angle, Precise};
use crate::numeric::pair::three;

/// A viewpoint and an orientation.
///
/// Camera axes are x right, y up, z forward, as the world's are.
///
/// # Example
/// ```
/// use marbles_core::glam::DVec3;
/// use marbles_core::{Angle, Camera};
///
/// let camera = Camera::look_at(DVec3::new(0.0, 0.0, -5.0), DVec3::ZERO, Angle::ZERO)?;
/// assert_eq!(camera.forward(), DVec3::Z);
/// // The same place, as one on a circle around the target.
/// let angle = Angle::from_degrees(0.0);
/// let orbit = Camera::orbit(DVec3::ZERO, 5.0, angle, Angle::ZERO, Angle::ZERO);
/// assert_eq!(orbit.position, camera.position);
/// # Ok::<(), marbles_core::CameraError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Camera {
    /// The viewpoint, in the world frame.
    pub position: DVec3,
    /// A point on the axis of view, in the world frame, near what the camera looks at. If you know none, use the
    /// viewpoint.
    ///
    /// The coordinates of a far viewpoint are rounded, and this would move everything that parallel rays meet. These
    /// rays are therefore measured from this point if it is nearer, unless it is off the axis by more than rounding.
    pub on_axis: DVec3,
    /// The rotation from camera axes to world axes.
    pub world_from_camera: DMat3,
}

/// The reason for which a camera or a lens was refused.
///
/// # Example
/// ```
/// use marbles_core::{Angle, CameraError, Lens};
///
/// let refused = Lens::from_field_of_view(Angle::from_degrees(180.0));
/// assert_eq!(refused, Err(CameraError::FieldOfView(180.0)));
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum CameraError {
    /// The target is the position, or not at a finite distance from it: the camera has no direction.
    Target {
        /// The position of the camera.
        position: DVec3,
        /// The point that it was to look at.
        target: DVec3,
    },
    /// The field of view is not between 0 and 180 degrees: the angle from 0 to 360.
    FieldOfView(f64),
}

impl fmt::Display for CameraError {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Target { position, target } => write!(
                out,
                "expected a target at a finite distance from {position} that is not 0, found {target}"
            ),
            Self::FieldOfView(found) => write!(
                out,
                "expected a field of view between 0 and 180 degrees, found {found}"
            ),
        }
    }
}

impl std::error::Error for CameraError {}

/// The camera at the origin that looks along z.
impl Default for Camera {
    fn default() -> Self {
        Self::free(DVec3::ZERO, Angle::ZERO, Angle::ZERO, Angle::ZERO)
    }
}

impl Camera {
    /// The camera at `position`, turned by `pan` toward +x, then `tilt` toward +y, then `roll`
    /// clockwise as seen from behind it.
    pub fn free(position: DVec3, pan: Angle, tilt: Angle, roll: Angle) -> Self {
        let about_x = DMat3::from_cols(
            DVec3::X,
            DVec3::new(0.0, tilt.cos, -tilt.sin),
            DVec3::new(0.0, tilt.sin, tilt.cos),
        );
        let about_y = DMat3::from_cols(
            DVec3::new(pan.cos, 0.0, -pan.sin),
            DVec3::Y,
            DVec3::new(pan.sin, 0.0, pan.cos),
        );
        let about_z = DMat3::from_cols(
            DVec3::new(roll.cos, -roll.sin, 0.0),
            DVec3::new(roll.sin, roll.cos, 0.0),
            DVec3::Z,
        );
        Self {
            position,
            on_axis: nearest_to_origin(position, pan, tilt),
            world_from_camera: about_y * about_x * about_z,
        }
    }

    /// The camera at `position` that has `target` in the middle of its view.
    ///
    /// If the target is straight above or below, the pan is 0.
    ///
    /// # Errors
    /// Refuses a target that is the position, or not at a finite distance from it.
    pub fn look_at(position: DVec3, target: DVec3, roll: Angle) -> Result<Self, CameraError> {
        let way = Some(target - position).filter(|way| way.is_finite());
        let toward = way.and_then(Self::pan_and_tilt_toward);
        let (pan, tilt) = toward.ok_or(CameraError::Target { position, target })?;
        Ok(Self {
            on_axis: target,
            ..Self::free(position, pan, tilt, roll)
        })
    }

    /// The camera that looks at `target` from `radius` away: `azimuth` is its pan, `elevation`
    /// how far it stands above the target, looking down.
    pub fn orbit(
        target: DVec3,
        radius: f64,
        azimuth: Angle,
        elevation: Angle,
        roll: Angle,
    ) -> Self {
        let turned = Self::free(target, azimuth, elevation.reversed(), roll);
        Self {
            position: target - turned.forward() * radius,
            on_axis: target,
            ..turned
        }
    }

    /// The unit vector along the axis of view, in the world frame.
    pub fn forward(&self) -> DVec3 {
        self.world_from_camera.z_axis
    }

    /// The same camera, moved by the vector `by`.
    pub fn moved(self, by: DVec3) -> Self {
        Self {
            position: self.position + by,
            on_axis: self.on_axis + by,
            ..self
        }
    }

    /// The place where parallel rays begin that go through the plane across the axis of view at the distance `along` from
    /// the world's origin: a point on the axis of view.
    ///
    /// # Accuracy
    /// Across the axis it is off by rounding of the nearer one of the viewpoint and the point on the axis, and of how
    /// far away they are.
    pub(crate) fn on_axis_at(&self, along: f64) -> DVec3 {
        let forward = self.forward();
        let way = |from: DVec3| along - from.dot(forward);
        let size = |from: DVec3| from.length() + way(from).abs();
        let between = self.on_axis - self.position;
        let aside = (between - forward * between.dot(forward)).length();
        let is_on_axis = aside <= MOST_ASIDE * (between.length() + size(self.on_axis));
        let from = if is_on_axis && size(self.on_axis) < way(self.position).abs() {
            self.on_axis
        } else {
            self.position
        };
        from + forward * way(from)
    }

    /// The pan, tilt and roll with which [`Self::free`] makes this camera. If it looks straight up or down, the pan is
    /// 0.
    pub fn pan_tilt_roll(&self) -> [Angle; 3] {
        let none = Angle::ZERO;
        let (pan, tilt) = Self::pan_and_tilt_toward(self.forward()).unwrap_or((none, none));
        let upright = Self::free(DVec3::ZERO, pan, tilt, none).world_from_camera;
        let right = upright.transpose() * self.world_from_camera.x_axis;
        [pan, tilt, Angle::from_sides(-right.y, right.x)]
    }

    /// The pan and the tilt of a camera that looks along `direction`. Straight up or down the pan is 0. `None` if the
    /// direction is zero.
    pub fn pan_and_tilt_toward(direction: DVec3) -> Option<(Angle, Angle)> {
        let scale = direction.abs().max_element();
        if scale == 0.0 {
            return None;
        }
        // Dividing by the largest component first keeps the horizontal distance finite.
        let DVec3 { x, y, z } = direction / scale;
        Some((
            Angle::from_sides(x, z),
            Angle::from_sides(y, libm::hypot(x, z)),
        ))
    }
}

/// The distance by which a point on the axis of view may be aside, relative to its distance, for rounding alone: 32 units
/// of a double's precision.
const MOST_ASIDE: f64 = 16.0 * f64::EPSILON;

/// The point on the axis of view that is nearest to the world's origin; the position where numbers are too large for
/// that.
///
/// # Accuracy
/// It is rounded as doubles are: the way to it is computed with twice their precision.
fn nearest_to_origin(position: DVec3, pan: Angle, tilt: Angle) -> DVec3 {
    let [pan_sin, pan_cos] = pan.precise();
    let [tilt_sin, tilt_cos] = tilt.precise();
    let forward = [pan_sin * tilt_cos, tilt_sin, pan_cos * tilt_cos];
    let along = position.dot(DVec3::from_array(forward.map(|it| it.high)));
    let from_origin = |axis: usize| {
        let way = forward[axis] * Precise::from(along);
        (Precise::from(position[axis]) - way).high
    };
    let point = DVec3::from_array(three([0, 1, 2], from_origin));
    if point.is_finite() { point } else { position }
}

/// The flat retina in front of the viewpoint.
///
/// The rays of a pinhole go from the viewpoint through the retina. Those of a parallel lens go along
/// the axis of view, and begin on the retina, which then lies in the plane through the viewpoint.
///
/// # Example
/// ```
/// use marbles_core::glam::DVec2;
/// use marbles_core::{Angle, Lens};
///
/// let wide = Lens::from_field_of_view(Angle::from_degrees(90.0))?;
/// // 2 tan 45°, at distance 1.
/// assert!((wide.width - 2.0).abs() < 1e-15);
/// assert!(Lens::parallel(8.0, DVec2::ZERO).is_parallel());
/// # Ok::<(), marbles_core::CameraError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lens {
    /// Width of the retina in scene units, greater than 0. The pixels give its height.
    pub width: f64,
    /// Distance of the retina from the viewpoint at zoom 1, greater than 0; infinite for a parallel
    /// lens, whose rays are those from a viewpoint that is infinitely far behind the retina.
    pub distance: f64,
    /// The offset of the retina's center from the axis of view, in scene units, right and up.
    pub shift: DVec2,
    /// The width of a pixel over its height, greater than 0: 1 for square pixels.
    pub pixel_aspect: f64,
}

/// The way in which the rays of a lens lie to each other.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub(crate) enum Projection {
    /// They go through one point.
    Central,
    /// They have one direction.
    Parallel,
}

impl Lens {
    /// Creates the lens with this horizontal field of view. Its retina is at distance 1, and its pixels are square.
    ///
    /// # Errors
    /// Refuses an angle that is not between 0 and 180°. Angles that differ by whole turns are the same.
    pub fn from_field_of_view(field_of_view: Angle) -> Result<Self, CameraError> {
        let Angle { sin, cos, .. } = field_of_view;
        if !(sin > 0.0 && sin.is_finite() && cos.is_finite()) {
            let degrees = field_of_view.degrees().rem_euclid(360.0);
            return Err(CameraError::FieldOfView(degrees));
        }
        // Of both forms the one in which nothing cancels.
        let tangent_of_half = if cos > 0.0 {
            sin / (1.0 + cos)
        } else {
            (1.0 - cos) / sin
        };
        Ok(Self {
            width: 2.0 * tangent_of_half,
            distance: 1.0,
            shift: DVec2::ZERO,
            pixel_aspect: 1.0,
        })
    }

    /// Creates a lens whose rays are parallel to the axis of view. At zoom 1 the picture shows `width` scene units
    /// across. Its pixels are square.
    pub fn parallel(width: f64, shift: DVec2) -> Self {
        Self {
            width,
            distance: f64::INFINITY,
            shift,
            pixel_aspect: 1.0,
        }
    }

    /// Returns whether all rays have one direction.
    pub fn is_parallel(&self) -> bool {
        self.projection() == Projection::Parallel
    }

    pub(crate) fn projection(&self) -> Projection {
        if self.distance == f64::INFINITY {
            Projection::Parallel
        } else {
            Projection::Central
        }
    }
}

#[cfg(test)]
mod tests;
