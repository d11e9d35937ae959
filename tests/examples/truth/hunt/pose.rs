//! Cameras at any position and with any direction, and scenes placed in front of them.

use glam::{DMat3, DVec3};
use marbles_core::{Angle, Camera};
use marbles_tests::numbers::Numbers;

/// A free camera.
#[derive(Clone, Copy, Debug)]
pub(super) struct Pose {
    pub(super) position: DVec3,
    /// Pan, tilt and roll, in degrees.
    pub(super) angles: [f64; 3],
    rotation: DMat3,
}

impl Pose {
    pub(super) fn new(position: DVec3, angles: [f64; 3]) -> Self {
        let [pan, tilt, roll] = angles.map(Angle::from_degrees);
        Self {
            position,
            angles,
            rotation: Camera::free(position, pan, tilt, roll).world_from_camera,
        }
    }

    /// A camera at the origin that looks along z in every second scene, and anywhere within a distance otherwise.
    pub(super) fn random(numbers: &mut Numbers, within: f64) -> Self {
        if numbers.below(2) == 0 {
            return Self::new(DVec3::ZERO, [0.0; 3]);
        }
        let position = [(); 3].map(|()| numbers.between(-within, within));
        let angles = [180.0, 70.0, 30.0].map(|most| numbers.between(-most, most));
        Self::new(position.into(), angles)
    }

    /// The camera in the syntax of the file.
    pub(super) fn camera(&self) -> String {
        let DVec3 { x, y, z } = self.position;
        let [pan, tilt, roll] = self.angles;
        format!("camera: Free(position: ({x}, {y}, {z}), pan: {pan}, tilt: {tilt}, roll: {roll})")
    }

    /// Converts a point from the axes of the camera to the world.
    pub(super) fn place(&self, of_camera: DVec3) -> [f64; 3] {
        (self.position + self.direction(of_camera)).to_array()
    }

    /// Converts a direction from the axes of the camera to the world.
    pub(super) fn direction(&self, of_camera: DVec3) -> DVec3 {
        self.rotation * of_camera
    }
}
