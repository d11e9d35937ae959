//! Which sphere a ray meets.
//!
//! [`Visibility`] is what depends on the world alone, [`Seen`] what depends on a view too. Both
//! leave out what cannot matter, by bounds that are rounded outward; every decision about what
//! remains is exact for the given doubles.

mod bins;
mod casters;
mod discs;
mod frustum;
mod seen;

pub(crate) use discs::Disc;
pub(crate) use seen::{Candidate, Seen};

use std::ops::Range;
use std::sync::OnceLock;

use glam::DVec3;

use self::casters::Casters;
use self::discs::Remembered;
use crate::{Ray, Sphere, World};

/// Lengths whose squares are far from over- and underflow.
const MODERATE: Range<f64> = 1e-35..1e35;

/// Answers whether a sphere stands between a point and a light.
#[derive(Clone, Debug)]
pub(crate) struct Visibility<'world> {
    spheres: &'world [Sphere],
    /// For every light what may keep it from a point; nothing in a world without shadows.
    casters: Vec<Casters>,
    /// For every light and sphere what may keep it from that, once it was asked for.
    discs: Vec<Box<[OnceLock<Remembered>]>>,
    /// Whether squares of all lengths are far from over- and underflow.
    is_moderate: bool,
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
        let casters = lights
            .iter()
            .map(|light| Casters::new(spheres, light.toward()))
            .collect();
        let unasked = || spheres.iter().map(|_| OnceLock::new()).collect();
        let is_moderate = spheres.iter().all(|sphere| {
            let largest = sphere.center().abs().max_element();
            MODERATE.contains(&sphere.radius()) && largest < MODERATE.end
        });
        Self {
            spheres,
            casters,
            discs: lights.iter().map(|_| unasked()).collect(),
            is_moderate,
        }
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

    /// Appends the spheres that may keep the light with this index from points that lie within
    /// `around` of the box of `points`, seen along the light.
    pub(crate) fn casters(
        &self,
        light: usize,
        points: &[DVec3],
        around: f64,
        casters: &mut Vec<usize>,
    ) {
        self.casters[light].within(points, around, casters);
    }
}

#[cfg(test)]
pub(crate) mod tests;
