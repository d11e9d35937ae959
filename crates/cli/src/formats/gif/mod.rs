//! GIF: pictures in one file, which are shown in a loop and share 256 colors.

mod animation;
mod dither;
mod histogram;
mod indexed;
mod palette;

pub(super) use self::animation::{Animation, MOST_FRAMES_PER_SECOND, MOST_SECONDS};
pub(crate) use self::indexed::Indexed;
