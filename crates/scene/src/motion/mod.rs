//! Camera and lights over time: curves through keys, turntables, and the place of a camera that frames.

mod camera;
mod channels;
mod checks;
mod curve;
mod error;
mod framing;
mod lights;
mod shutter;
mod sky;
mod turntable;

pub(crate) use camera::CameraMotion;
pub use error::{FrameError, FrameFault};
pub(crate) use framing::{Framed, Framing, Picture, Turning, axes_of_orbit};
pub(crate) use lights::Lights;
pub(crate) use shutter::OpenShutter;
pub(crate) use sky::SkyMotion;
