//! The choice between samples and an integral.

use std::num::NonZeroU32;

use rayon::prelude::*;

use super::settings::Settings;
use crate::model::camera::Projection;
use crate::model::color::Color;
use crate::model::exposure::Exposure;
use crate::model::light::Light;
use crate::model::light_unit::LightUnit;
use crate::model::sky::Sky;
use crate::model::sphere::Sphere;
use crate::model::view::View;
use crate::model::world::World;
use crate::picture::image::Uniform;
use crate::picture::pixel::{Evidence, Method, Status};
use crate::raster::Raster;
use crate::sampling::Supersampling;

/// The way to make a picture, and what is known of all its pixels before.
pub(super) struct Approach {
    pub(super) method: Method,
    pub(super) uniform: Uniform,
}

/// Samples on a side of a pixel that meet a tolerance.
struct Preview {
    /// The least tolerance, in multiples of the contrast of the world.
    from: f64,
    samples: NonZeroU32,
    evidence: Evidence,
    /// True if it pays only where there are more spheres than pixels, and no raster knows their shadows in less time.
    is_for_crowds: bool,
}

/// The cheapest first. From the whole contrast on any answer is good enough.
///
/// # Accuracy
/// Below that samples are an estimate: N × N of them claim [`OF_SPACING`] / N of the contrast. One straight edge along
/// the grid costs half of 1/N at the worst; over all scenes in `scenes` and a million spheres no pixel was off by more
/// than 0.71 / N. Strips between the samples could fool them, two of which claim their whole width, and more than a few
/// spheres that fit between them: where any may be that small, the integral is taken.
const PREVIEWS: [Preview; 4] = [
    Preview {
        from: 2.5,
        samples: NonZeroU32::MIN,
        evidence: Evidence::Bound,
        is_for_crowds: false,
    },
    Preview {
        from: 1.0,
        samples: NonZeroU32::new(2).unwrap(),
        evidence: Evidence::Bound,
        is_for_crowds: false,
    },
    Preview {
        from: 0.5,
        samples: NonZeroU32::new(3).unwrap(),
        evidence: Evidence::Estimate,
        is_for_crowds: false,
    },
    Preview {
        from: 0.2,
        samples: NonZeroU32::new(6).unwrap(),
        evidence: Evidence::Estimate,
        is_for_crowds: true,
    },
];

/// The claim of samples, in parts of the contrast times their spacing in pixels.
const OF_SPACING: f64 = 1.2;

impl Approach {
    /// The one that `settings` ask for in a world under some lights and a sky.
    pub(super) fn of(
        world: &World,
        (lights, sky): (&[Light], Option<Sky>),
        exposure: &Exposure<'_>,
        settings: &Settings,
    ) -> Self {
        let tolerance = match settings.method {
            Method::Samples(samples) => {
                return Self {
                    method: settings.method,
                    uniform: Supersampling::uniform(samples),
                };
            }
            Method::Tolerance(tolerance) => tolerance,
        };
        let contrast = contrast(world, (lights, sky), settings.alpha);
        let view = exposure.view();
        let has_raster = || {
            world.shadows
                && sky.is_none()
                && Raster::serves(world, view, lights)
                && !any_sphere(world, &|sphere| is_large(sphere, view))
        };
        let meets = |preview: &&Preview| {
            preview.from * contrast <= tolerance
                && preview.is_for(world, exposure)
                && !(preview.is_for_crowds && has_raster())
        };
        let Some(preview) = PREVIEWS.iter().find(meets) else {
            return Self {
                method: settings.method,
                uniform: Uniform::default(),
            };
        };
        Self {
            method: Method::Samples(preview.samples),
            uniform: Uniform {
                error: Some(contrast * preview.claims()),
                outcome: Some((preview.evidence, Status::Met)),
            },
        }
    }
}

impl Preview {
    /// True for pictures that it can be taken for. Of those that move, only bounds are.
    fn is_for(&self, world: &World, exposure: &Exposure<'_>) -> bool {
        let view = exposure.view();
        let pixels = u64::from(view.width) * u64::from(view.height);
        let is_crowd = world.spheres().len() as u64 > pixels;
        match self.evidence {
            Evidence::Bound => true,
            Evidence::Estimate => {
                (is_crowd || !self.is_for_crowds)
                    && exposure.motion().is_none()
                    && !has_smaller(world, view, 1.0 / f64::from(self.samples.get()))
            }
        }
    }

    /// The part of the contrast that pixels may be off by.
    fn claims(&self) -> f64 {
        match self.evidence {
            Evidence::Bound => 1.0,
            Evidence::Estimate => OF_SPACING / f64::from(self.samples.get()),
        }
    }
}

/// Returns whether some sphere may be seen with a smaller radius, in pixels along either axis.
fn has_smaller(world: &World, view: &View, radius: f64) -> bool {
    let unit = view.pixels_per_unit().min_element();
    let is_smaller = |sphere: &Sphere| {
        let distance = match view.lens.projection() {
            Projection::Central => (sphere.center() - view.camera.position).length(),
            Projection::Parallel => 1.0,
        };
        sphere.radius() * unit < radius * distance
    };
    any_sphere(world, &is_smaller)
}

/// Whether something holds for any sphere of a world.
fn any_sphere(world: &World, holds: &(dyn Fn(&Sphere) -> bool + Sync)) -> bool {
    world.spheres().par_iter().any(holds)
}

/// Returns whether a sphere may be seen larger than a raster takes it: the tiles that see it are left to its edges.
fn is_large(sphere: &Sphere, view: &View) -> bool {
    /// In pixels. Not tuned: it is the largest radius of a raster of 8 × 8 samples a pixel.
    const LARGEST: f64 = 128.0;
    let distance = (sphere.center() - view.camera.position).length();
    sphere.radius() * view.pixels_per_unit().max_element() > LARGEST * distance
}

/// The largest difference between what pixels may show, in any channel, and in alpha, which has the unit of light.
fn contrast(world: &World, (lights, sky): (&[Light], Option<Sky>), alpha: bool) -> f64 {
    let (background, of_alpha) = if alpha {
        (Color::ZERO, LightUnit::new(world, lights, sky).unit)
    } else {
        (world.background, 0.0)
    };
    let [dark, bright] = world.range_of_light((lights, sky), background);
    (bright - dark).max_element().max(of_alpha)
}

#[cfg(test)]
mod tests;
