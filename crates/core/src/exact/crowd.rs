//! The work that crowds may cost: so much that a picture ends, however many spheres its pixels see.
//!
//! A pixel's own budget is far more than a picture has time for in each of its pixels. Few pictures have many pixels that
//! cost so much; in one of a crowd that nearly coincides all do. So the work on pixels that see many spheres is limited a
//! second time, in their tile: so is the work on the shadows of many.

use super::budget::{Budget, MOST_SPHERES};
use crate::model::view::View;
use crate::model::world::World;
use crate::search::view_index::ViewIndex;

/// The spheres that a pixel may see of which more are a crowd.
pub(crate) const FEWEST: usize = 64;

/// The units that crowds may cost, for each pixel of a picture, and the pixels that a smaller picture counts as: one of
/// these, 600 × 400, of a hundred thousand spheres that nearly coincide, ends after 9 s on two threads, of which about half
/// find what its tiles see.
const OF_PIXEL: u64 = 1024;
const LEAST_PIXELS: u64 = 240_000;

/// The share of a tile's units that one pixel may take.
const OF_TILE: u64 = 4;

/// The units that the crowds of a tile may cost: those that it sees, and those in whose shadows it lies.
#[derive(Clone, Copy, Debug)]
pub(crate) struct UnitsOfTile {
    /// For a tile that may see a crowd.
    crowded: u64,
    /// For any other tile.
    other: u64,
}

impl UnitsOfTile {
    /// As many as there are.
    pub(crate) const ALL: Self = Self {
        crowded: u64::MAX,
        other: u64::MAX,
    };

    /// The shares of the tiles of a picture of the view, under each group of lights: each kind of tile has the same for all
    /// of its tiles together.
    pub(crate) fn new(world: &World, view: &View, index: &ViewIndex<'_>) -> Self {
        let count = world.spheres().len();
        let tiles_of_more = |most: usize| {
            if count > most {
                index.tiles_of_more(view, most)
            } else {
                0
            }
        };
        let pixels = u64::from(view.width) * u64::from(view.height);
        let of_picture = OF_PIXEL * pixels.max(LEAST_PIXELS);
        // Each sphere may be shaded by all.
        let are_shaded = world.shadows && count > MOST_SPHERES;
        let others = if are_shaded { tiles_of_more(0) } else { 0 };
        Self {
            crowded: of_picture / tiles_of_more(FEWEST).max(1),
            other: of_picture / others.max(1),
        }
    }

    /// The same of a picture that has so many times less.
    pub(crate) fn divided_by(self, share: u64) -> Self {
        Self {
            crowded: self.crowded / share,
            other: self.other / share,
        }
    }

    /// The units of a tile that may see so many spheres.
    pub(crate) fn of(&self, candidates: usize) -> u64 {
        if candidates > FEWEST {
            self.crowded
        } else {
            self.other
        }
    }
}

/// The work on a pixel that told what it sees.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Looks {
    /// Spheres that were asked whether they matter.
    pub(crate) asked: u64,
    /// The units that its occluders took.
    pub(crate) units: u64,
    /// Whether the pixel may see a crowd.
    pub(crate) is_crowd: bool,
}

/// The work on the crowds of a tile, in the units of [`Budget`].
///
/// It is counted in the order of the pixels, so that threads cannot change which ones are given up.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct CrowdWork {
    spent: u64,
    most: u64,
}

impl CrowdWork {
    /// Begins with a tile whose crowds may cost so much.
    pub(crate) fn new(most: u64) -> Self {
        Self { spent: 0, most }
    }

    /// The units that are left.
    pub(crate) fn left(&self) -> u64 {
        self.most.saturating_sub(self.spent)
    }

    /// The units that the next pixel may take.
    pub(crate) fn of_pixel(&self) -> u64 {
        self.left().min(self.most / OF_TILE)
    }

    /// The units that were spent.
    #[cfg(test)]
    pub(crate) fn spent(&self) -> u64 {
        self.spent
    }

    /// Counts so many units.
    pub(crate) fn spend(&mut self, units: u64) {
        self.spent = self.spent.saturating_add(units);
    }

    /// Counts the work on a pixel: all of that on a crowd, and otherwise what told what the pixel sees, if it is more than
    /// with ordinary edges.
    pub(crate) fn spend_on_pixel(&mut self, budget: &Budget, looks: Looks) {
        /// The units of a sphere that is asked.
        const OF_SPHERE: u64 = 2;
        const ORDINARY: u64 = 512;
        let asked = OF_SPHERE * looks.asked + looks.units;
        let looked = budget.looked() + asked;
        if looks.is_crowd {
            self.spend(budget.spent() + asked);
        } else if looked > ORDINARY {
            self.spend(looked);
        }
    }

    /// Counts so many units if they are left, and returns whether they are.
    pub(crate) fn affords(&mut self, units: u64) -> bool {
        let is_left = units <= self.left();
        if is_left {
            self.spend(units);
        }
        is_left
    }
}
