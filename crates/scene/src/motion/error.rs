//! The frames that cannot be rendered.

/// The reason for which a frame of a valid scene cannot be rendered.
#[derive(Clone, Copy, Debug, Eq, PartialEq, thiserror::Error)]
#[error("frame {frame}: {fault}")]
pub struct FrameError {
    /// The frame.
    pub frame: i32,
    /// The fault of the camera, or of a light, in it.
    pub fault: FrameFault,
}

/// The fault of a camera or a light in a frame.
#[derive(Clone, Copy, Debug, Eq, PartialEq, thiserror::Error)]
pub enum FrameFault {
    /// Its target is its position.
    #[error("the camera is at its target, and has no direction of view")]
    LooksNowhere,
    /// Its position is beyond the range of numbers.
    #[error("the camera is infinitely far away")]
    TooFar,
    /// The light with this number, from 0 on, has come to the zero vector between keys.
    #[error("light {} has no direction", .0 + 1)]
    LightNowhere(usize),
    /// The light with this number, from 0 on, is beyond the range of numbers.
    #[error("light {} is infinitely far away", .0 + 1)]
    LightTooFar(usize),
}
