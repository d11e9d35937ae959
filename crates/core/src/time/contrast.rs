//! The range of the light of things in a world.

use rayon::iter::{IntoParallelIterator, IntoParallelRefIterator, ParallelIterator};

use crate::model::light::Light;
use crate::model::light_unit::LightUnit;
use crate::model::sky::Sky;
use crate::model::world::World;

/// The differences of light, and of coverage, that something may make in any channel.
#[derive(Clone, Copy, Debug)]
pub(super) struct Contrast {
    /// About the largest one, highlights left out: they are seldom as narrow as what is missed between moments.
    pub(super) ordinary: f64,
    /// A bound of all.
    pub(super) most: f64,
    /// The light that an error of alpha counts as: none without an alpha channel.
    pub(super) of_alpha: f64,
}

impl Contrast {
    pub(super) fn new(world: &World, lights: &[Light], sky: Option<Sky>, alpha: bool) -> Self {
        let of_alpha = match alpha {
            true => LightUnit::new(world, lights, sky).unit,
            false => 0.0,
        };
        let lights = lights.iter();
        let lights: f64 = lights.map(|light| brightest(world, light)).sum();
        let sky = sky.map_or(0.0, |sky| sky.brightest().max_element());
        let white = world.ambient.max_element() + sky + lights;
        let spheres = (0..world.spheres().len()).into_par_iter();
        let of_spheres = spheres.map(|sphere| {
            let highlight = world.material(sphere).highlight;
            let strength = highlight.map_or(0.0, |highlight| highlight.strength);
            world.albedo(sphere).max_element() * white + strength * lights
        });
        let outlines = world.outline_colors().map(|color| color.max_element());
        let least = world.background.max_element();
        // A black world has no contrast.
        let least = least.max(of_alpha).max(f64::MIN_POSITIVE);
        let least = outlines.fold(least, f64::max);
        Self {
            ordinary: white.max(least),
            most: of_spheres.reduce(|| 0.0, f64::max).max(least),
            of_alpha,
        }
    }
}

/// A bound of the light of a white surface in the brightest channel.
fn brightest(world: &World, light: &Light) -> f64 {
    if light.point().is_none() {
        return light.intensity().max_element();
    }
    let spheres = world.spheres().par_iter();
    let of_spheres = spheres.map(|sphere| light.brightest_on(sphere).max_element());
    of_spheres.reduce(|| 0.0, f64::max)
}
