//! The spheres that keep light from a ball.

use super::ball::RasterBall;
use super::lit::Sun;
use crate::search::discs::Disc;
use crate::search::light_grid::{self, Asked, Higher};
use crate::search::visibility::Visibility;

/// More occluders are left to others.
const MOST: usize = 512;

/// Larger ones, in radii of the ball, have edges that single precision does not place well.
const LARGEST: f64 = 1024.0;

/// The spheres that may keep light from one ball.
#[derive(Debug, Default)]
pub(super) struct Occluders {
    found: Vec<Disc>,
    higher: light_grid::Found,
    /// For each light the end of its occluders.
    pub(super) ends: Vec<usize>,
    pub(super) list: Vec<Occluder>,
}

/// A sphere that may keep a light from a ball, with lengths in radii of the ball, from its center.
#[derive(Clone, Copy, Debug)]
pub(super) struct Occluder {
    /// Its center, across the light and toward it.
    pub(super) right: f32,
    pub(super) up: f32,
    pub(super) above: f32,
    pub(super) radius_square: f32,
    /// A number from 0 to 1 that tells it from most others.
    pub(super) name: f32,
}

impl Occluders {
    pub(super) fn reset(&mut self) {
        self.ends.clear();
        self.list.clear();
    }

    /// Finds those of a ball under all lights; false if they are too many or too large.
    pub(super) fn find(
        &mut self,
        suns: &[Sun],
        visibility: &Visibility<'_>,
        ball: &RasterBall,
    ) -> bool {
        self.reset();
        let Asked { radius, index, .. } = ball.in_world;
        for sun in suns {
            if sun.has_shadows {
                self.higher.list.clear();
                let light = visibility.light(sun.light);
                let is_found = light.grid().is_some_and(|grid| {
                    grid.find(visibility.spheres(), &ball.in_world, &mut self.higher)
                });
                if !is_found {
                    self.look_up(sun, visibility, index as usize);
                }
                if self.higher.list.len() > MOST {
                    return false;
                }
                for higher in &self.higher.list {
                    let size = higher.radius / radius;
                    if size > LARGEST {
                        return false;
                    }
                    let way = higher.way / radius;
                    self.list.push(Occluder {
                        right: way.x as f32,
                        up: way.y as f32,
                        above: way.z as f32,
                        radius_square: (size * size) as f32,
                        name: name(higher.index),
                    });
                }
            }
            self.ends.push(self.list.len());
        }
        true
    }

    /// Looks up what may darken a sphere, where no cells serve.
    fn look_up(&mut self, sun: &Sun, visibility: &Visibility<'_>, index: usize) {
        let spheres = visibility.spheres();
        let own = &spheres[index];
        let light = visibility.light(sun.light);
        let discs = if let Some(kept) = light.of_sphere(index) {
            kept
        } else {
            self.found.clear();
            light.find(index, &[own.center()], own.radius(), &mut self.found);
            &self.found
        };
        self.higher.list.extend(discs.iter().map(|disc| {
            let sphere = &spheres[disc.sphere as usize];
            let way = sphere.center() - own.center();
            Higher {
                way: sun.project(way),
                radius: sphere.radius(),
                index: disc.sphere,
            }
        }));
    }
}

/// A number from 0 to 1 for a sphere.
fn name(sphere: u32) -> f32 {
    /// Odd, and near 2³² over the golden ratio.
    const FACTOR: u32 = 0x9e37_79b1;
    /// Bits that single precision holds.
    const BITS: u32 = f32::MANTISSA_DIGITS;
    let hash = sphere.wrapping_add(1).wrapping_mul(FACTOR) >> (u32::BITS - BITS);
    hash as f32 / (1_u32 << BITS) as f32
}
