//! The frames that cannot be rendered.

/// The reason for which a frame of a valid scene cannot be rendered.
///
/// # Example
/// ```
/// # use std::path::Path;
/// # use marbles_scene::Scene;
/// // Between its keys the camera comes to its target.
/// let text = "(image: (width: 64, height: 48), lens: Fov(40), spheres: [],
///     camera: LookAt(position: (0, 0, -1), target: (0, 0, 0)),
///     animation: Keyframes(keys: [
///         (frame: 1, position: (0, 0, -1)), (frame: 3, position: (0, 0, 1)),
///     ]))";
/// let scene = Scene::parse(text, Path::new("through.ron"))?;
/// let error = scene.view(2).unwrap_err();
/// assert_eq!(error.frame, 2);
/// assert_eq!(error.to_string(), "frame 2: the camera is at its target, and has no direction of view");
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, Eq, PartialEq, thiserror::Error)]
#[non_exhaustive]
#[error("frame {frame}: {fault}")]
pub struct FrameError {
    /// The number of the frame.
    pub frame: i32,
    /// The fault of the camera, of a light, or of the sky in it.
    pub fault: FrameFault,
}

/// The fault of a camera, a light or a sky in a frame.
///
/// # Example
/// ```
/// # use std::path::Path;
/// # use marbles_scene::{FrameFault, Scene};
/// // Half-way between two opposite directions, the light has none.
/// let text = r#"(image: (width: 64, height: 48), lens: Fov(40), camera: Free(), spheres: [],
///     lights: [Directional(toward: (0, 1, 0), name: "sun")],
///     animation: Keyframes(keys: [
///         (frame: 1, light: "sun", toward: (0, 1, 0)),
///         (frame: 3, light: "sun", toward: (0, -1, 0)),
///     ]))"#;
/// let scene = Scene::parse(text, Path::new("sun.ron"))?;
/// let error = scene.view(2).unwrap_err();
/// assert_eq!(error.fault, FrameFault::LightNowhere(0));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, Eq, PartialEq, thiserror::Error)]
#[non_exhaustive]
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
    /// The direction up of the sky has come to the zero vector between keys.
    #[error("the sky has no direction `up`")]
    SkyNowhere,
}
