//! The picture that is shown.

use std::ops::ControlFlow;

use marbles_core::{Cancelled, Exposure, Method, Renderer, Settings, View, World};
use marbles_scene::Scene;

use crate::base::size::Size;
use crate::terminal::interrupt;
use crate::terminal::progress::Progress;
use marbles_core::srgb;

/// A picture of sRGB codes of red, green and blue, row by row.
#[derive(Clone, Debug)]
pub(super) struct Picture {
    pub(super) size: Size,
    pub(super) codes: Vec<[u8; 3]>,
}

impl Picture {
    pub(super) fn row(&self, row: u32) -> &[[u8; 3]] {
        let width = self.size.width as usize;
        &self.codes[row as usize * width..][..width]
    }

    /// The picture in another size, in which each pixel has the color of the nearest one.
    pub(super) fn stretched(&self, size: Size) -> Self {
        let nearest = |index: u32, of: u32, from: u32| {
            let twice = u64::from(2 * index + 1) * u64::from(from);
            (twice / (2 * u64::from(of))) as u32
        };
        let codes = size.places().map(|(col, row)| {
            let col = nearest(col, size.width, self.size.width);
            self.row(nearest(row, size.height, self.size.height))[col as usize]
        });
        Self {
            size,
            codes: codes.collect(),
        }
    }
}

/// Renders on the threads of the current pool, until the user asks to end the work.
pub(super) fn render(
    (scene, world): (&Scene, &World),
    view: &View,
    tolerance: f64,
    progress: Option<&Progress<'_>>,
) -> Result<Picture, Cancelled> {
    if let Some(progress) = progress {
        progress.prepare(world.spheres().len());
    }
    let renderer = Renderer::new(world);
    render_until(
        &renderer,
        scene.exposure(view),
        Method::Tolerance(tolerance),
        &|pixels| {
            if let Some(progress) = progress {
                progress.advance(pixels);
            }
            interrupt::requested()
        },
    )
}

/// Renders on the threads of the current pool until `is_over`, which is called with the number of pixels that were
/// rendered since the last call.
pub(super) fn render_until(
    renderer: &Renderer<'_>,
    exposure: Exposure<'_>,
    method: Method,
    is_over: &(dyn Fn(u64) -> bool + Sync),
) -> Result<Picture, Cancelled> {
    let size = Size::of(exposure.view());
    let settings = Settings {
        method,
        alpha: false,
    };
    let image =
        renderer.render_with_progress(exposure, &settings, &|pixels| match is_over(pixels) {
            true => ControlFlow::Break(()),
            false => ControlFlow::Continue(()),
        })?;
    let codes = size.places().map(|(col, row)| {
        let [red, green, blue, _] = image.rgba(col, row);
        [red, green, blue].map(srgb::encode_8)
    });
    Ok(Picture {
        size,
        codes: codes.collect(),
    })
}
