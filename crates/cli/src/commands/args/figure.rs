//! The arguments that change a figure of a table.

use clap::{Args, value_parser};
use marbles_scene::{Figure, ViewAngle};

/// The direction of the camera, and its turn.
#[derive(Clone, Copy, Debug, Default, Args)]
pub(crate) struct FigureOptions {
    /// Look from `front`, `back`, `left`, `right`, `top` or `bottom`, or from AZIMUTH,ELEVATION in degrees, such as
    /// 30,15; everything stays in the picture [default: the camera of the scene; for a table, the angle that shows most]
    #[arg(long, value_name = "VIEW", allow_hyphen_values = true)]
    pub(crate) view: Option<ViewAngle>,

    /// Move the camera around once, in 120 or FRAMES frames
    #[arg(
        long,
        value_name = "FRAMES",
        num_args = 0..=1,
        require_equals = true,
        default_missing_value = "120",
        value_parser = value_parser!(u32).range(1..=1_000_000)
    )]
    pub(crate) turntable: Option<u32>,
}

impl FigureOptions {
    /// The figure of a table, in this size if there is one.
    pub(crate) fn figure(self, size: Option<(u32, u32)>) -> Figure {
        Figure {
            view: self.view,
            turntable: self.turntable,
            size,
        }
    }
}
