//! The form of pictures.

use marbles_core::{Channels, World};

use super::center_channels::CenterChannels;
use crate::base::region::Region;

/// The form that all pictures of a sequence share.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Form {
    /// The rendered part of the picture.
    pub(crate) region: Region,
    pub(crate) channels: Channels,
    pub(crate) alpha: bool,
    /// The additional channels.
    pub(crate) centers: Option<CenterChannels>,
}

impl Form {
    /// The form for a part of the pictures of a world.
    pub(crate) fn new(
        region: Region,
        world: &World,
        alpha: bool,
        centers: Option<CenterChannels>,
    ) -> Self {
        Self {
            region,
            channels: Channels::of(world, alpha),
            alpha,
            centers,
        }
    }
}

/// The number of color channels.
pub(crate) fn color_count(channels: Channels) -> usize {
    match channels {
        Channels::Grey => 1,
        Channels::Rgb => 3,
    }
}
