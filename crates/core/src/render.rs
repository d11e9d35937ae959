//! The loop over the tiles of a picture.

use std::num::NonZeroU32;
use std::ops::ControlFlow;

use rayon::iter::ParallelIterator;
use thiserror::Error;

use crate::integration::{Integrator, Supersampling, Tile};
use crate::{Channels, Color, Image, Radiance, View, World};

/// Side of a tile, in pixels.
const TILE_SIDE: u32 = 8;

/// How a picture is rendered.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settings {
    /// How pixels are averaged.
    pub method: Method,
    /// Whether the background is left out and coverage kept as an alpha channel.
    pub alpha: bool,
}

/// How pixels are averaged.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Method {
    /// Over the midpoints of an N × N division of every pixel.
    Samples(NonZeroU32),
}

/// The caller of [`render`] asked it to stop.
#[derive(Clone, Copy, Debug, Eq, Error, PartialEq)]
#[error("the rendering was stopped")]
pub struct Cancelled;

/// Renders what `view` sees of `world`, on the threads of the current rayon pool.
///
/// The picture does not depend on the number of threads. `progress` is called, from any of them,
/// with the number of pixels that were just finished; when it breaks, the rendering ends soon.
/// A world without colour makes a picture with one channel.
///
/// # Errors
/// [`Cancelled`] when `progress` broke.
pub fn render(
    world: &World,
    view: &View,
    settings: &Settings,
    progress: &(dyn Fn(u64) -> ControlFlow<()> + Sync),
) -> Result<Image, Cancelled> {
    let Method::Samples(samples) = settings.method;
    let integrator = Supersampling::new(world, view, samples, settings.alpha);
    let channels = if world.is_grey() {
        Channels::Grey
    } else {
        Channels::Rgb
    };
    let mut image = Image::new(view.width, view.height, channels, settings.alpha);
    match channels {
        Channels::Grey => fill::<f64>(&mut image, &integrator, progress),
        Channels::Rgb => fill::<Color>(&mut image, &integrator, progress),
    }?;
    Ok(image)
}

fn fill<C: Radiance>(
    image: &mut Image,
    integrator: &impl Integrator<C>,
    progress: &(dyn Fn(u64) -> ControlFlow<()> + Sync),
) -> Result<(), Cancelled> {
    image.bands_mut(TILE_SIDE).try_for_each(|mut band| {
        let Tile {
            row, width, height, ..
        } = band.area;
        let mut pixels = Vec::with_capacity((TILE_SIDE * height) as usize);
        for col in (0..width).step_by(TILE_SIDE as usize) {
            let tile = Tile {
                col,
                row,
                width: TILE_SIDE.min(width - col),
                height,
            };
            integrator.integrate(tile, &mut pixels);
            band.write(tile, &pixels);
            if progress(pixels.len() as u64).is_break() {
                return Err(Cancelled);
            }
            pixels.clear();
        }
        Ok(())
    })
}
