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

/// The reason why frames at this rate are shown at another one, if there is one.
pub(crate) fn why_other_rate(format: AnimationFormat, rate: f64) -> Option<String> {
    let longest = most_seconds(format);
    if 1.0 / rate > longest {
        return Some(format!(
            "its format shows a frame for at most {longest} s, but this loop has {rate} frames per second"
        ));
    }
    let most = most_frames_per_second(format).filter(|most| rate > *most)?;
    Some(format!(
        "players show at most {most:.0} frames per second, but this loop has {rate}"
    ))
}

/// The longest time in seconds for which a file can show a picture.
fn most_seconds(format: AnimationFormat) -> f64 {
    match format {
        AnimationFormat::Apng => png::animation::MOST_SECONDS,
        AnimationFormat::Gif => gif::MOST_SECONDS,
        AnimationFormat::Webp => webp::MOST_SECONDS,
    }
}

/// The highest rate at which players show the pictures of a file, if there is a limit.
fn most_frames_per_second(format: AnimationFormat) -> Option<f64> {
    match format {
        AnimationFormat::Apng => None,
        AnimationFormat::Gif => Some(gif::MOST_FRAMES_PER_SECOND),
        AnimationFormat::Webp => Some(webp::MOST_FRAMES_PER_SECOND),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rates_that_a_format_does_not_have_are_explained() {
        use AnimationFormat::{Apng, Gif, Webp};
        for (format, slow, fast) in [
            (Gif, 0.0016, 50.0),
            (Webp, 0.00006, 90.0),
            (Apng, 0.000016, 1e4),
        ] {
            assert_eq!(why_other_rate(format, slow), None);
            assert_eq!(why_other_rate(format, fast), None);
        }
        for (format, rate, expected) in [
            (
                Gif,
                0.001,
                "its format shows a frame for at most 655.35 s, but this loop has 0.001 frames per second",
            ),
            (
                Webp,
                0.00005,
                "its format shows a frame for at most 16777.215 s, but this loop has 0.00005 frames per second",
            ),
            (
                Apng,
                0.00001,
                "its format shows a frame for at most 65535 s, but this loop has 0.00001 frames per second",
            ),
            (
                Gif,
                60.0,
                "players show at most 50 frames per second, but this loop has 60",
            ),
        ] {
            assert_eq!(why_other_rate(format, rate).as_deref(), Some(expected));
        }
    }
}
