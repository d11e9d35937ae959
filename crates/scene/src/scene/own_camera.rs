//! The camera that a scene has from its file, and what another one in its place has to know.

use marbles_core::Lens;

use crate::file::FrameOver;
use crate::motion::{CameraMotion, Lights};
use crate::world::StepKey;

/// The parts of a scene file from which the spheres make something else.
#[derive(Clone, Debug)]
pub(super) struct AsWritten {
    /// The lens, which may be scaled to frame the spheres.
    pub(super) lens: Lens,
    /// The part of the picture that a framing camera fills, and with which spheres.
    pub(super) fill: Option<(f64, FrameOver)>,
    /// The lights, some of which may lack a reference distance.
    pub(super) lights: Lights,
}

/// The camera of a scene, while another one is in its place.
#[derive(Clone, Debug)]
pub(super) struct OwnCamera {
    pub(super) motion: CameraMotion,
    pub(super) lens: Lens,
    /// Cameras that frame the spheres of each step alone.
    pub(super) framed: Vec<(StepKey, CameraMotion, Lens)>,
    pub(super) lights: Lights,
    /// Its kind, as the file writes it.
    pub(super) kind: &'static str,
}
