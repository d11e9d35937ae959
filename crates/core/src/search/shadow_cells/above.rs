//! The discs above a whole sphere, from the cells of shadow rays.
//!
//! In a crowd that is too large to keep the occluders of its spheres, a tile sees many points of some spheres. What may
//! darken any of them is found once, and then tested for eight points side by side.

use fearless_simd::{Level, dispatch};
use glam::DVec2;

use super::{FEW_DISCS, Key, MOST_PASSED, ShadowCells, key};
use crate::model::sphere::Sphere;
use crate::search::disc_grid::{DiscGrid, PointBelow, SphereBelow};
use crate::search::discs::{Disc, point_allowance};
use crate::search::occluders::slack;
use crate::search::visibility::Visibility;

/// Spheres with more discs above them are asked about point by point: most of their points find one soon. Not tuned.
const MOST_OVER_SPHERE: usize = 96;

/// More than the rounding of a sum of squares and of a square.
const WIDER: f64 = 1.0 + 16.0 * f64::EPSILON;

/// The distance of centers across the light, in radii, from which on spheres do not coincide, though single precision
/// may move them. Not tuned.
const ALIKE: f64 = 1e-2;

impl ShadowCells {
    /// Appends the discs that may keep a light from points of a sphere's outer side, which are known up to
    /// [`point_allowance`]; false, with any discs, if they are too many or those of several cells.
    ///
    /// `side` is about that of the region of points that are going to be asked about.
    pub(crate) fn discs_before(
        &mut self,
        visibility: &Visibility<'_>,
        (light, sphere, side): (usize, usize, f64),
        discs: &mut Vec<Disc>,
    ) -> bool {
        let occluders = visibility.light(light).occluders();
        let own = &visibility.spheres()[sphere];
        let (center, radius) = (own.center(), own.radius());
        let around = point_allowance(own) + slack(center, 2.0 * radius);
        let below = SphereBelow {
            place: occluders.project(center),
            reach: radius + around,
            lowest: occluders.height(center) - radius - around,
        };
        let lowest = PointBelow {
            place: below.place,
            height: below.lowest,
            around,
            is_above_own: false,
        };
        let Some(mut key) = key(occluders.name(), side, &lowest) else {
            return false;
        };
        let mut above = Above {
            spheres: visibility.spheres(),
            own: sphere,
            place: below.place,
            around,
            level: occluders.level(),
            first: discs.len(),
            discs,
        };
        // As for single points, but that cells are never divided.
        let (mut rises, mut passed) = (false, 0);
        let highest = occluders.highest();
        loop {
            if !key.contains(&below) {
                return false;
            }
            let mut asked = key;
            if rises && key.is_low() {
                asked = self.rise(occluders, &mut key);
                passed = 0;
            }
            let cell = self.cell(occluders, asked);
            if cell.is_crowded {
                return false;
            }
            let is_sparse = cell.count <= FEW_DISCS;
            above.add(&cell.grid, &below);
            key.place[2] += 1;
            let is_last = asked.is_column || key.place[2] as f64 * key.side() > highest;
            if is_last || above.is_crowd() {
                return !above.is_crowd();
            }
            passed += 1;
            rises = is_sparse || passed >= MOST_PASSED;
        }
    }
}

impl Key {
    /// True if a sphere lies in the cell, seen along the light.
    fn contains(&self, sphere: &SphereBelow) -> bool {
        let corner = DVec2::new(self.place[0] as f64, self.place[1] as f64) * self.side();
        let place = sphere.place - corner;
        (place - sphere.reach).min_element() >= 0.0
            && (place + sphere.reach).max_element() <= self.side()
    }
}

/// The discs above a sphere that are found in cells.
struct Above<'a> {
    spheres: &'a [Sphere],
    /// The sphere, and the place of its center across the light.
    own: usize,
    place: DVec2,
    /// How far its points are off.
    around: f64,
    /// The instructions that the processor has.
    level: Level,
    /// Those of the sphere, from the first.
    discs: &'a mut Vec<Disc>,
    first: usize,
}

impl Above<'_> {
    /// True if there are too many.
    fn is_crowd(&self) -> bool {
        self.discs.len() - self.first > MOST_OVER_SPHERE
    }

    /// Adds those of a cell.
    fn add(&mut self, grid: &DiscGrid, below: &SphereBelow) {
        dispatch!(self.level, simd => grid.each_before(simd, below, |center, radius, sphere| {
            self.take(center, radius, sphere);
        }));
    }

    /// Adds a disc once, unless there are too many; not that of the sphere or of one that coincides with it, which n·l
    /// settles as for the sphere.
    #[inline(never)]
    fn take(&mut self, center: DVec2, radius: f64, sphere: u32) {
        if self.is_crowd() {
            return;
        }
        let own = &self.spheres[self.own];
        let is_known = |disc: &Disc| disc.sphere == sphere;
        if sphere as usize == self.own || self.discs[self.first..].iter().any(is_known) {
            return;
        }
        let is_alike = (center - self.place).abs().max_element() <= ALIKE * own.radius();
        if is_alike && self.spheres[sphere as usize] == *own {
            return;
        }
        self.discs.push(Disc {
            center,
            radius: (radius + self.around) * WIDER,
            sphere,
        });
    }
}
