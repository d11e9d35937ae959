//! The pinhole camera: where it stands, where it looks, and its retina.

use glam::{DMat3, DVec2, DVec3};

use crate::numeric::angle::Angle;

/// A viewpoint and an orientation.
///
/// Camera axes are x right, y up, z forward, as the world's are.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Camera {
    /// The viewpoint, in the world frame.
    pub position: DVec3,
    /// The rotation from camera axes to world axes.
    pub world_from_camera: DMat3,
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
            world_from_camera: about_y * about_x * about_z,
        }
    }

    /// The camera at `position` that has `target` in the middle of its view.
    ///
    /// Straight up or down the pan is 0. `None` where the target is the position.
    pub fn look_at(position: DVec3, target: DVec3, roll: Angle) -> Option<Self> {
        let (pan, tilt) = Self::pan_and_tilt_toward(target - position)?;
        Some(Self::free(position, pan, tilt, roll))
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
        let tilt = Angle {
            sin: -elevation.sin,
            cos: elevation.cos,
        };
        let turned = Self::free(target, azimuth, tilt, roll);
        Self {
            position: target - turned.forward() * radius,
            ..turned
        }
    }

    /// Unit vector in the middle of the view, in the world frame.
    pub fn forward(&self) -> DVec3 {
        self.world_from_camera.z_axis
    }

    /// Pan and tilt of a camera that looks along `direction`; pan 0 straight up or down, `None`
    /// where the direction is zero.
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

/// The flat retina in front of the viewpoint.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lens {
    /// Width of the retina in scene units, greater than 0; square pixels give its height.
    pub width: f64,
    /// Distance of the retina from the viewpoint at zoom 1, greater than 0.
    pub distance: f64,
    /// The way from the axis of view to the retina's center, in scene units, right and up.
    pub shift: DVec2,
}

impl Lens {
    /// The lens whose picture spans the horizontal angle `field_of_view` in radians, between 0
    /// and π; its retina stands at distance 1.
    pub fn from_field_of_view(field_of_view: f64) -> Self {
        Self {
            width: 2.0 * libm::tan(0.5 * field_of_view),
            distance: 1.0,
            shift: DVec2::ZERO,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn turned(pan: f64, tilt: f64, roll: f64) -> Camera {
        let angle = Angle::from_degrees;
        Camera::free(DVec3::ZERO, angle(pan), angle(tilt), angle(roll))
    }

    #[test]
    fn quarter_turns_go_where_the_conventions_say() {
        assert_eq!(turned(90.0, 0.0, 0.0).forward(), DVec3::X);
        assert_eq!(turned(0.0, 90.0, 0.0).forward(), DVec3::Y);
        // Clockwise from behind: the camera's up goes to the right.
        assert_eq!(
            turned(0.0, 0.0, 90.0).world_from_camera * DVec3::Y,
            DVec3::X
        );
    }

    #[test]
    fn pan_then_tilt_reaches_the_spherical_direction() {
        let forward = turned(30.0, 60.0, 77.0).forward();
        let expected = DVec3::new(0.25, 0.75_f64.sqrt(), 0.5 * 0.75_f64.sqrt());
        assert!((forward - expected).length() < 1e-15);
    }

    #[test]
    fn orientations_are_rotations() {
        for step in 0..100 {
            let angle = 37.3 * f64::from(step);
            let matrix = turned(angle, 1.7 * angle, -0.6 * angle).world_from_camera;
            assert!((matrix.determinant() - 1.0).abs() < 1e-14);
            assert!((matrix * matrix.transpose()).abs_diff_eq(DMat3::IDENTITY, 1e-15));
        }
    }

    #[test]
    fn looks_straight_up_with_pan_zero() {
        let up = Camera::look_at(DVec3::ZERO, DVec3::new(0.0, 1e-300, 0.0), Angle::ZERO);
        assert_eq!(up, Some(turned(0.0, 90.0, 0.0)));
        let down = Camera::look_at(DVec3::ONE, DVec3::new(1.0, -7.0, 1.0), Angle::ZERO).unwrap();
        assert_eq!(
            down.world_from_camera,
            turned(0.0, -90.0, 0.0).world_from_camera
        );
    }

    #[test]
    fn looking_nowhere_is_no_camera() {
        assert_eq!(Camera::look_at(DVec3::ONE, DVec3::ONE, Angle::ZERO), None);
    }

    #[test]
    fn orbit_stands_behind_and_above_its_target() {
        let target = DVec3::new(1.0, 2.0, 3.0);
        let angle = Angle::from_degrees;
        let camera = Camera::orbit(target, 10.0, angle(90.0), angle(30.0), Angle::ZERO);
        let expected = target + DVec3::new(-10.0 * 0.75_f64.sqrt(), 5.0, 0.0);
        assert!((camera.position - expected).length() < 1e-14);
        let looking = Camera::look_at(camera.position, target, Angle::ZERO).unwrap();
        assert!(
            looking
                .world_from_camera
                .abs_diff_eq(camera.world_from_camera, 1e-15)
        );
    }

    #[test]
    fn field_of_view_is_the_angle_across_the_retina() {
        let lens = Lens::from_field_of_view(std::f64::consts::FRAC_PI_2);
        assert!((lens.width - 2.0).abs() < 1e-15);
    }
}
