//! What the camera does while a frame's shutter is open.

use marbles_core::{Motion, Pose};

use crate::Scene;

/// The shutter of a frame.
#[derive(Debug)]
pub(crate) struct OpenShutter<'scene> {
    scene: &'scene Scene,
    frame: i32,
    /// How long it is open, in frames.
    duration: f64,
}

impl<'scene> OpenShutter<'scene> {
    pub(crate) fn new(scene: &'scene Scene, frame: i32, duration: f64) -> Self {
        Self {
            scene,
            frame,
            duration,
        }
    }
}

impl Motion for OpenShutter<'_> {
    /// `None` at the very moment at which a camera has come to its target.
    fn pose(&self, time: f64) -> Option<Pose> {
        self.scene.pose(self.frame, self.duration * time).ok()
    }

    fn is_smooth(&self) -> bool {
        !self.scene.has_key_at(self.frame)
    }
}
