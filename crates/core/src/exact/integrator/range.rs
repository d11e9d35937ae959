//! The range of light that a tile may show: the claims of pixels that are known by samples, or hardly known.

use glam::DVec3;

use super::{Exact, FEW_SAMPLES, SAMPLES};
use crate::exact::budget::MOST_SPHERES;
use crate::exact::crowd::CrowdWork;
use crate::model::color::Color;
use crate::model::roughness::PixelKey;
use crate::numeric::rounding::WIDER;
use crate::picture::pixel::{Evidence, Pixel, Status};

/// The spheres that a tile may see of which more have few samples: where these nearly coincide, each of them is held
/// against all in more than doubles, and against all their shadows.
const MOST_OF_SAMPLES: usize = 256;

/// The units in which a ray is held against a sphere in more than doubles.
pub(super) const OF_SPHERE: u64 = 8;

/// The largest distance of spheres, in radii, for rays to be decided without integers: the square of this is what
/// numbers of twice the precision may lose and still have all places of a double.
const FAR: f64 = (1_u64 << 25) as f64;

/// The radius of immense spheres, in distances of their center. Not tuned: it is far beyond floors and skies.
const IMMENSE: f64 = 1e40;

impl Exact<'_> {
    /// A pixel by samples, whose error is how far any mixture of what its tile may show lies from them; in the middle
    /// of that where each ray would have to be held against very many spheres, or the tile's crowds have cost all that
    /// they may.
    pub(super) fn sampled(
        &self,
        key: PixelKey,
        candidates: &[usize],
        range: [Color; 2],
        (crowds, most_occluders): (&mut CrowdWork, usize),
    ) -> Pixel {
        let is_few = self.are_costly(candidates);
        let rays = if is_few { FEW_SAMPLES } else { SAMPLES };
        let rays = u64::from(rays.get().pow(2));
        let count = candidates.len();
        let of_ray = OF_SPHERE * count as u64 + most_occluders as u64;
        let mut pixel = if count > MOST_SPHERES || !crowds.affords(rays * of_ray) {
            Pixel {
                value: 0.5 * (range[0] + range[1]),
                alpha: 0.5,
                ..self.empty_pixel()
            }
        } else if is_few {
            self.few_samples.pixel(key)
        } else {
            self.samples.pixel(key)
        };
        pixel.error = self.farthest(&pixel, range);
        pixel.evidence = Evidence::Bound;
        pixel.status = if pixel.error <= self.tolerance {
            Status::Met
        } else {
            Status::OutOfBudget
        };
        pixel
    }

    /// Returns whether spheres are so many, or one of them so far or so large, that each ray costs thousands of others.
    pub(super) fn are_costly(&self, spheres: &[usize]) -> bool {
        spheres.len() > MOST_OF_SAMPLES
            || spheres.iter().any(|&sphere| {
                let (center, radius) = self.groups[0].scene.center(sphere);
                let distance = center.length();
                // Integers that hold both have thousands of digits.
                let is_immense = center != DVec3::ZERO && distance < radius / IMMENSE;
                distance > FAR * radius || is_immense
            })
    }

    /// The largest distance of a pixel from any mixture of light in a range.
    fn farthest(&self, pixel: &Pixel, [least, most]: [Color; 2]) -> f64 {
        let above = (most - pixel.value).max_element();
        let below = (pixel.value - least).max_element();
        let of_light = above.max(below) * WIDER;
        if self.alpha {
            let of_alpha = pixel.alpha.max(1.0 - pixel.alpha);
            of_light.max(self.unit * of_alpha)
        } else {
            of_light
        }
    }

    /// Claims no more of a pixel than that it lies among what its tile may show.
    pub(super) fn limit(&self, pixel: &mut Pixel, [least, most]: [Color; 2]) {
        let within = Pixel {
            value: pixel.value.clamp(least, most),
            ..*pixel
        };
        let error = self.farthest(&within, [least, most]);
        if error < pixel.error {
            *pixel = Pixel {
                error,
                evidence: Evidence::Bound,
                ..within
            };
        }
    }

    /// Bounds of the light, in each channel, of what may be seen of these spheres and of the background: in the
    /// dark, and where all lights and their highlights are at their highest.
    pub(super) fn range_of_light(&self, candidates: &[usize]) -> [Color; 2] {
        if candidates.len() <= MOST_SPHERES {
            self.range_on(candidates.iter().copied())
        } else {
            // Each tile would ask thousands.
            let all = 0..self.world.spheres().len();
            *self.range.get_or_init(|| self.range_on(all))
        }
    }

    fn range_on(&self, spheres: impl Iterator<Item = usize>) -> [Color; 2] {
        let world = self.world;
        let background = self.empty_pixel().value;
        let [mut least, mut most] = [background; 2];
        let are_near = self.groups.iter().any(|group| group.scene.has_near_lights);
        let mut last = None;
        for sphere in spheres {
            // Parallel light is as bright everywhere.
            let looks = (
                world.albedo(sphere),
                std::ptr::from_ref(world.material(sphere)),
            );
            if !are_near && last.replace(looks) == Some(looks) {
                continue;
            }
            let lights = self.index.visibility.lights().iter();
            let lights = lights.map(|light| light.brightest_on(&world.spheres()[sphere]));
            let lights = lights.fold(Color::ZERO, |sum, light| sum + light);
            let albedo = world.albedo(sphere);
            let highlight = world.material(sphere).highlight;
            let strength = highlight.map_or(0.0, |highlight| highlight.strength);
            let dark = albedo * world.ambient;
            least = least.min(dark);
            most = most.max(dark + albedo * lights + lights * strength);
            if let Some(outline) = world.material(sphere).outline {
                least = least.min(outline.color);
                most = most.max(outline.color);
            }
        }
        [least, most]
    }
}
