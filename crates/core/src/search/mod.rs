//! Which sphere a ray meets.
//!
//! [`Visibility`] is what depends on the world alone, [`Seen`] what depends on a view too. Both
//! leave out what cannot matter, by bounds that are rounded outward; every decision about what
//! remains is exact for the given doubles.

pub(crate) mod bins;
pub(crate) mod casters;
pub(crate) mod coverage;
pub(crate) mod crowd;
pub(crate) mod discs;
pub(crate) mod eight;
pub(crate) mod frustum;
pub(crate) mod hierarchy;
pub(crate) mod seen;

use std::num::NonZeroU32;
use std::ops::Range;
use std::sync::{Arc, OnceLock};

use glam::DVec3;

use self::casters::Casters;
use self::discs::{MOST_REMEMBERING, Remembered};
use self::hierarchy::Hierarchy;
use crate::model::light::DirectionalLight;
use crate::model::ray::Ray;
use crate::model::sphere::Sphere;
use crate::model::world::World;

/// Lengths whose squares are far from over- and underflow.
const MODERATE: Range<f64> = 1e-35..1e35;

/// So many spheres are searched from front to back: most of them are hidden, or not in the picture.
const CROWD: usize = 1 << 15;

/// Through which points of the retina rays go.
#[derive(Clone, Copy, Debug)]
enum Points {
    /// Any.
    All,
    /// The midpoints of an N × N division of every pixel.
    Midpoints(NonZeroU32),
}

/// Answers whether a sphere stands between a point and a light.
#[derive(Clone, Debug)]
pub(crate) struct Visibility<'world> {
    spheres: &'world [Sphere],
    /// In a world of shadows, or of very many spheres.
    hierarchy: Option<Arc<Hierarchy>>,
    /// For every light what may keep it from a point; nothing in a world without shadows.
    casters: Vec<Casters<'world>>,
    /// For every light and sphere what may keep it from that, once it was asked for; nothing in a
    /// world of very many.
    discs: Vec<Box<[OnceLock<Remembered>]>>,
    /// Whether squares of all lengths are far from over- and underflow.
    is_moderate: bool,
    extent: Extent,
}

/// Bounds of all spheres together.
#[derive(Clone, Copy, Debug)]
struct Extent {
    /// The least and the greatest coordinates of centers; infinite where there are none.
    low: DVec3,
    high: DVec3,
    largest_radius: f64,
}

impl<'world> Visibility<'world> {
    /// Prepares the search in a world.
    pub(crate) fn new(world: &'world World) -> Self {
        let spheres = world.spheres();
        let lights = if world.shadows {
            &world.lights[..]
        } else {
            &[]
        };
        let is_asked = !lights.is_empty() || spheres.len() >= CROWD;
        let hierarchy = is_asked.then(|| Arc::new(Hierarchy::new(spheres)));
        let of_light = |light: &DirectionalLight| {
            let hierarchy = hierarchy.clone()?;
            Some(Casters::new(spheres, hierarchy, light.toward()))
        };
        let casters = lights.iter().filter_map(of_light).collect();
        let remembering = if spheres.len() <= MOST_REMEMBERING {
            spheres.len()
        } else {
            0
        };
        let unasked = || (0..remembering).map(|_| OnceLock::new()).collect();
        let mut extent = Extent {
            low: DVec3::INFINITY,
            high: DVec3::NEG_INFINITY,
            largest_radius: 0.0,
        };
        let mut smallest_radius = f64::INFINITY;
        for sphere in spheres {
            extent.low = extent.low.min(sphere.center());
            extent.high = extent.high.max(sphere.center());
            extent.largest_radius = extent.largest_radius.max(sphere.radius());
            smallest_radius = smallest_radius.min(sphere.radius());
        }
        let largest = extent.low.abs().max(extent.high.abs()).max_element();
        let is_moderate = spheres.is_empty()
            || MODERATE.contains(&smallest_radius)
                && MODERATE.contains(&extent.largest_radius)
                && largest < MODERATE.end;
        Self {
            spheres,
            hierarchy,
            casters,
            discs: lights.iter().map(|_| unasked()).collect(),
            is_moderate,
            extent,
        }
    }

    /// The hierarchy that finds what a view sees, where asking sphere by sphere takes too long.
    fn crowd(&self) -> Option<&Hierarchy> {
        let is_crowd = self.spheres.len() >= CROWD && self.is_moderate;
        self.hierarchy.as_deref().filter(|_| is_crowd)
    }

    /// Whether squares of all lengths of the spheres are far from over- and underflow.
    pub(crate) fn is_moderate(&self) -> bool {
        self.is_moderate
    }

    /// The spheres, by their indices.
    pub(crate) fn spheres(&self) -> &'world [Sphere] {
        self.spheres
    }

    /// Whether any sphere but the one with the index `except` stands between a point of that
    /// one's surface, known up to a distance of `point_error`, and the light with this index.
    ///
    /// Another sphere whose surface passes through the point within that error hides the light if
    /// it lies toward it: coincident spheres do not darken each other, touching ones do not leak.
    pub(crate) fn is_blocked(
        &self,
        light: usize,
        to_light: &Ray,
        point_error: f64,
        except: usize,
    ) -> bool {
        let own = &self.spheres[except];
        self.casters[light].any(to_light.origin, point_error, |index| {
            let caster = &self.spheres[index];
            // A sphere that coincides with the point's own is settled by n·l as that one is.
            index != except && caster.is_met(to_light, point_error) && caster != own
        })
    }

    /// Whether something `holds` for any of the spheres that may keep the light with this index from
    /// points of space that lie within `around` of `points` or between them: each is asked once, those
    /// sooner, by and large, that lie nearer, until it does.
    pub(crate) fn casters(
        &self,
        light: usize,
        points: &[DVec3],
        around: f64,
        holds: impl FnMut(usize) -> bool,
    ) -> bool {
        let of_light = &self.casters[light];
        let heights = points.iter().map(|&point| of_light.height(point));
        let lowest = heights.fold(f64::INFINITY, f64::min) - around;
        of_light.any_within(points, around, lowest, holds)
    }
}

#[cfg(test)]
pub(crate) mod tests;
