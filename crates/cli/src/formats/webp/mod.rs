//! WebP.

mod animation;
pub(super) mod chunks;
pub(super) mod frame;

pub(super) use self::animation::{Animation, MOST_FRAMES_PER_SECOND, MOST_SECONDS};
