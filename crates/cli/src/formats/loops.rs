//! Files with all pictures of a sequence, which are shown in a loop.

use super::animation::Animation;
use super::encoding::AnimationFormat;
use super::png::shape::Shape;
use super::{gif, png, webp};
use crate::files::save::Fault;
use crate::files::temporary::TemporaryFile;

/// Frames per second if the rate is unknown, as in scene files.
const FRAMES_PER_SECOND: f64 = 24.0;

/// Begins a file with this number of pictures, which are shown at this rate.
pub(super) fn begin(
    format: AnimationFormat,
    file: &mut TemporaryFile,
    shape: Shape,
    frames: u32,
    frames_per_second: Option<f64>,
) -> Result<Box<dyn Animation + '_>, Fault> {
    let rate = frames_per_second.unwrap_or(FRAMES_PER_SECOND);
    Ok(match format {
        AnimationFormat::Apng => Box::new(png::animation::Animation::begin(
            file.file(),
            shape,
            frames,
            rate,
        )?),
        AnimationFormat::Gif => {
            let pictures = file.another()?;
            Box::new(gif::Animation::begin(file.file(), pictures, shape, rate)?)
        }
        AnimationFormat::Webp => {
            Box::new(webp::Animation::begin(file.file(), shape, frames, rate)?)
        }
    })
}

/// The highest rate at which players show the pictures of a file, if there is a limit.
pub(crate) fn most_frames_per_second(format: AnimationFormat) -> Option<f64> {
    match format {
        AnimationFormat::Apng => None,
        AnimationFormat::Gif => Some(gif::MOST_FRAMES_PER_SECOND),
        AnimationFormat::Webp => Some(webp::MOST_FRAMES_PER_SECOND),
    }
}
