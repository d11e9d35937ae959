//! The picture that is shown.

use std::ops::ControlFlow;

use marbles_core::{Cancelled, Method, Renderer, Settings, View, World};
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
}

/// Renders on the threads of the current pool.
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
    let settings = Settings {
        method: Method::Tolerance(tolerance),
        alpha: false,
    };
    let image = renderer.render_with_progress(scene.exposure(view), &settings, &|pixels| {
        if let Some(progress) = progress {
            progress.advance(pixels);
        }
        if interrupt::requested() {
            ControlFlow::Break(())
        } else {
            ControlFlow::Continue(())
        }
    })?;
    let size = Size::of(view);
    let codes = size.places().map(|(col, row)| {
        let [red, green, blue, _] = image.rgba(col, row);
        [red, green, blue].map(srgb::encode_8)
    });
    Ok(Picture {
        size,
        codes: codes.collect(),
    })
}
