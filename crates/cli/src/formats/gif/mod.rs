//! GIF: pictures in one file, which follow each other in a loop, with 256 colors for all of them.

mod animation;
mod dither;
mod histogram;
mod palette;

pub(super) use self::animation::{Animation, MOST_FRAMES_PER_SECOND};
