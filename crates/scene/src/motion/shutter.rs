//! The motion of the camera while a frame's shutter is open.

use marbles_core::{Motion, Pose};

use super::camera::CameraMotion;

/// The shutter of a frame.
#[derive(Debug)]
pub(crate) struct OpenShutter<'scene> {
    pub(crate) motion: &'scene CameraMotion,
    pub(crate) frame: i32,
    /// The time for which it is open, in frames.
    pub(crate) duration: f64,
}

impl Motion for OpenShutter<'_> {
    /// `None` at the very moment at which a camera has come to its target.
    fn pose(&self, time: f64) -> Option<Pose> {
        self.motion.pose(self.frame, self.duration * time).ok()
    }

    fn is_smooth(&self) -> bool {
        !self.motion.has_key_at(self.frame)
    }
}
