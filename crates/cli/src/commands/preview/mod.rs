//! `marbles preview`: a frame in the terminal.

mod blocks;
mod kitty;
pub(crate) mod screen;
mod watch;

use std::ops::ControlFlow;

use marbles_core::{Cancelled, Image, Method, Renderer, Settings, View};
use marbles_scene::Scene;

use self::screen::{Area, Screen};
use crate::base::failure::Failure;
use crate::base::status;
use crate::base::threads;
use crate::commands::args::{PreviewArguments, Size};
use crate::commands::frame;
use crate::commands::scene;
use crate::formats::srgb;
use crate::terminal::console::Console;
use crate::terminal::interrupt;
use crate::terminal::progress::Progress;

/// Lines that stay free for the shell's prompt.
const PROMPT_LINES: u32 = 2;

pub(crate) fn run(arguments: &PreviewArguments, console: &Console) -> Result<u8, Failure> {
    let screen = Screen::of(console)?;
    let threads = threads::start(None)?;
    if arguments.watch {
        return threads.install(|| watch::run(arguments, &screen, console));
    }
    let scene = threads.install(|| scene::load(&arguments.scene, console, false))?;
    let view = fitted(
        frame::view(&scene, arguments.frame)?,
        &screen.area(PROMPT_LINES),
    );
    interrupt::listen(console.farewell());
    let progress = Progress::new(console, None, false, 1);
    progress.begin(0, u64::from(view.width) * u64::from(view.height));
    let render = || render(&scene, &view, arguments.tolerance, Some(&progress));
    let picture = threads.install(render);
    progress.finish();
    let Ok(picture) = picture else {
        return Ok(status::INTERRUPTED);
    };
    console.print(&screen.show(&picture)?);
    Ok(status::SUCCESS)
}

/// What is shown: sRGB codes of red, green and blue, row by row.
#[derive(Clone, Debug)]
struct Picture {
    width: u32,
    height: u32,
    codes: Vec<[u8; 3]>,
}

impl Picture {
    fn of(image: &Image) -> Self {
        let (width, height) = (image.width(), image.height());
        let pixels = (0..height).flat_map(|row| (0..width).map(move |col| (col, row)));
        let codes = pixels.map(|(col, row)| {
            let [red, green, blue, _] = image.rgba(col, row);
            [red, green, blue].map(srgb::encode_8)
        });
        Self {
            width,
            height,
            codes: codes.collect(),
        }
    }

    fn row(&self, row: u32) -> &[[u8; 3]] {
        let width = self.width as usize;
        &self.codes[row as usize * width..][..width]
    }
}

/// Renders on the threads of the current pool.
fn render(
    scene: &Scene,
    view: &View,
    tolerance: f64,
    progress: Option<&Progress<'_>>,
) -> Result<Picture, Cancelled> {
    let world = scene.world();
    let renderer = match progress {
        Some(progress) => progress.while_preparing(world.spheres().len(), || Renderer::new(world)),
        None => Renderer::new(world),
    };
    let settings = Settings {
        method: Method::Tolerance(tolerance),
        alpha: false,
    };
    let image = renderer.render(scene.exposure(view), &settings, &|pixels| {
        if let Some(progress) = progress {
            progress.advance(pixels);
        }
        if interrupt::requested() {
            ControlFlow::Break(())
        } else {
            ControlFlow::Continue(())
        }
    })?;
    Ok(Picture::of(&image))
}

/// The view with as many pixels as fill the area one way, and keep the picture's form.
fn fitted(view: View, area: &Area) -> View {
    let (width, height) = (f64::from(view.width), f64::from(view.height));
    let scale = (f64::from(area.width) / width).min(f64::from(area.height) / height);
    let scale = if area.enlarges { scale } else { scale.min(1.0) };
    let side = |length: f64, most: u32| ((length * scale).round() as u32).clamp(1, most);
    let size = Size {
        width: side(width, area.width),
        height: side(height, area.height),
    };
    frame::resized(view, Some(size))
}

#[cfg(test)]
mod tests;
