//! One frame of a scene, for commands that look at no more.

use marbles_core::View;
use marbles_scene::Scene;

use crate::base::failure::Failure;
use crate::commands::args::Size;
use crate::commands::render::FRAME_OF_A_STILL;

/// From where the frame is seen that `--frame` names, which has to be one of the scene's; the first
/// where it names none.
pub(crate) fn view(scene: &Scene, frame: Option<i32>) -> Result<View, Failure> {
    let frames = scene.frames();
    let frames = frames.unwrap_or(FRAME_OF_A_STILL..=FRAME_OF_A_STILL);
    let frame = frame.unwrap_or(*frames.start());
    if !frames.contains(&frame) {
        let expected = match frames.into_inner() {
            (first, last) if first == last => format!("{first}, the only frame of the scene"),
            (first, last) => format!("a frame of the scene, from {first} to {last}"),
        };
        return Err(Failure::Usage(format!(
            "--frame: expected {expected}, found {frame}"
        )));
    }
    let view = scene.view(frame);
    view.map_err(|error| Failure::Frames(error.to_string()))
}

/// The same view in another size, where one is given.
pub(crate) fn resized(view: View, size: Option<Size>) -> View {
    match size {
        Some(Size { width, height }) => View {
            width,
            height,
            ..view
        },
        None => view,
    }
}
