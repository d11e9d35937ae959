//! The choice between samples and an integral.

use std::num::NonZeroU32;

use super::settings::Settings;
use crate::model::color::Color;
use crate::model::light::Light;
use crate::model::world::World;
use crate::picture::image::Uniform;
use crate::picture::pixel::{Evidence, Method, Status};
use crate::sampling::Supersampling;

/// The way to make a picture, and what is known of all its pixels before.
pub(super) struct Approach {
    pub(super) method: Method,
    pub(super) uniform: Uniform,
}

/// Samples on a side of a pixel where any answer is good enough, from these multiples of the contrast on.
const PREVIEWS: [(f64, NonZeroU32); 2] =
    [(2.5, NonZeroU32::MIN), (1.0, NonZeroU32::new(2).unwrap())];

impl Approach {
    /// The one that `settings` ask for in a world under some lights. Where the tolerance is no less than the whole contrast of the world, samples
    /// meet it, whatever they miss.
    pub(super) fn of(world: &World, lights: &[Light], settings: &Settings) -> Self {
        match settings.method {
            Method::Samples(samples) => Self {
                method: settings.method,
                uniform: Supersampling::uniform(samples),
            },
            Method::Tolerance(tolerance) => {
                let contrast = contrast(world, lights, settings.alpha);
                let preview = PREVIEWS
                    .iter()
                    .find(|(times, _)| times * contrast <= tolerance);
                match preview {
                    Some((_, samples)) => Self {
                        method: Method::Samples(*samples),
                        uniform: Uniform {
                            error: Some(contrast),
                            outcome: Some((Evidence::Bound, Status::Met)),
                        },
                    },
                    None => Self {
                        method: settings.method,
                        uniform: Uniform::default(),
                    },
                }
            }
        }
    }
}

/// The largest difference between what pixels may show, in any channel; alpha is one.
fn contrast(world: &World, lights: &[Light], alpha: bool) -> f64 {
    let (background, of_alpha) = if alpha {
        (Color::ZERO, 1.0)
    } else {
        (world.background, 0.0)
    };
    let [dark, bright] = world.range_of_light(lights, background);
    (bright - dark).max_element().max(of_alpha)
}

#[cfg(test)]
mod tests;
