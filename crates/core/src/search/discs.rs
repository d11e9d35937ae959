//! The spheres that may keep a light from one sphere, as discs across the light.

use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, OnceLock};

use glam::{DVec2, DVec3};

use super::light_grid::LightGrid;
use super::occluders::{Occluders, slack};
use crate::model::sphere::Sphere;

/// A sphere as the light sees it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Disc {
    /// Across the light.
    pub(crate) center: DVec2,
    /// Larger by more than what rounding moves it and the points that it may darken.
    pub(crate) radius: f64,
    /// The sphere's index.
    pub(crate) sphere: u32,
}

/// In worlds with more spheres nothing is kept: most of them are a pixel or less. Not tuned: it
/// bounds the memory by 2 MiB a light before the first is kept.
const MOST_KEEPING: usize = 1 << 17;

/// More discs than this are looked up for every patch of a surface. Not tuned: more take longer to
/// go through than fewer take to look up.
const MOST_KEPT: usize = 64;

/// The discs of what may darken a sphere; nothing where they are too many.
type Kept = Option<Box<[Disc]>>;

/// The occluders of a light, and the discs of those that may darken a sphere, kept once they were
/// asked for.
#[derive(Clone, Debug)]
pub(crate) struct DiscCache<'world> {
    occluders: Occluders<'world>,
    /// One for each sphere, or none in worlds of very many; copies share what they find.
    kept: Arc<[OnceLock<Kept>]>,
    grid: Arc<Cells>,
}

/// The spheres in cells, once enough rays ask for them; copies share them.
#[derive(Debug, Default)]
struct Cells {
    /// The rows of samples, one for each pixel, that were to be asked for so far.
    rows: AtomicU64,
    /// None where they do not serve.
    grid: OnceLock<Option<LightGrid>>,
}

/// The largest error of points of a sphere where its discs are asked for.
pub(crate) fn point_allowance(sphere: &Sphere) -> f64 {
    /// Far more than points are off, unless the viewpoint is farther away than anything is to be seen.
    const ALLOWANCE: f64 = 1e-9;
    ALLOWANCE * sphere.radius()
}

impl<'world> DiscCache<'world> {
    pub(super) fn new(occluders: Occluders<'world>) -> Self {
        let count = occluders.spheres().len();
        let count = if count <= MOST_KEEPING { count } else { 0 };
        Self {
            occluders,
            kept: (0..count).map(|_| OnceLock::new()).collect(),
            grid: Arc::default(),
        }
    }

    pub(super) fn occluders(&self) -> &Occluders<'world> {
        &self.occluders
    }

    /// The discs of what may keep the light from the outer side of a sphere, if they are few.
    pub(crate) fn of_sphere(&self, sphere: usize) -> Option<&[Disc]> {
        let find = || {
            let own = &self.occluders.spheres()[sphere];
            let mut discs = Vec::new();
            self.find(sphere, &[own.center()], own.radius(), &mut discs);
            (discs.len() <= MOST_KEPT).then(|| discs.into_boxed_slice())
        };
        self.kept.get(sphere)?.get_or_init(find).as_deref()
    }

    /// True in worlds that are small enough to keep anything.
    pub(crate) fn keeps(&self) -> bool {
        !self.kept.is_empty()
    }

    /// True where [`DiscCache::of_sphere`] was asked for before.
    pub(crate) fn knows(&self, sphere: usize) -> bool {
        let kept = self.kept.get(sphere);
        kept.is_some_and(|kept| kept.get().is_some())
    }

    /// Appends the discs of what may keep the light from points of a sphere that lie within `around`
    /// of the box of `points`, seen along the light.
    pub(crate) fn find(&self, sphere: usize, points: &[DVec3], around: f64, discs: &mut Vec<Disc>) {
        /// More than the rounding of a sum of squares and of a square.
        const WIDER: f64 = 1.0 + 16.0 * f64::EPSILON;
        let occluders = &self.occluders;
        let spheres = occluders.spheres();
        let own = &spheres[sphere];
        let error = point_allowance(own) + slack(own.center(), 2.0 * own.radius());
        let (mut low, mut high) = (DVec2::INFINITY, DVec2::NEG_INFINITY);
        for &point in points {
            let place = occluders.project(point);
            (low, high) = (low.min(place), high.max(place));
        }
        let mut indices = Vec::new();
        // From the lowest point that may be lit.
        let bottom = occluders.height(own.center()) - own.radius() - error;
        occluders.any_within(points, around + error, bottom, |index| {
            indices.push(index);
            false
        });
        indices.sort_unstable();
        discs.extend(indices.into_iter().filter_map(|index| {
            let occluder = &spheres[index];
            if index == sphere || occluder == own {
                return None;
            }
            let radius = occluder.radius() + slack(occluder.center(), occluder.radius()) + error;
            let center = occluders.project(occluder.center());
            let is_beyond = center.distance(center.clamp(low, high)) > (radius + around) * WIDER;
            let is_below = occluders.height(occluder.center()) + radius < bottom;
            (!is_beyond && !is_below).then_some(Disc {
                center,
                radius: radius * WIDER,
                sphere: index as u32,
            })
        }));
    }

    /// The spheres in cells across the light, where that serves, and once it pays.
    pub(crate) fn grid(&self) -> Option<&LightGrid> {
        self.grid.grid.get()?.as_ref()
    }

    /// Lists the spheres in cells across the light, if so many more rows of samples, one for each pixel, make up for it; the
    /// spheres' lengths have to be moderate.
    ///
    /// That was measured with a million: cells save a row as much time as they cost a sphere, by and large. So they never cost
    /// much more than they save.
    ///
    /// Not on the first demand: other threads would wait for the one that is asked first, and tasks that this one takes
    /// over while it waits for others would ask again.
    pub(super) fn expect(&self, rows: u64) {
        let cells = &*self.grid;
        let spheres = self.occluders.spheres();
        let before = cells.rows.fetch_add(rows, Ordering::Relaxed);
        let pays = before.saturating_add(rows) >= spheres.len() as u64;
        if pays && cells.grid.get().is_none() {
            let (right, up) = self.occluders.axes();
            let grid = LightGrid::new(spheres, [right, up, self.occluders.toward()]);
            // Somebody else may have been faster.
            let _ = cells.grid.set(grid);
        }
    }

    /// The axes of the plane across the light.
    pub(crate) fn axes(&self) -> (DVec3, DVec3) {
        self.occluders.axes()
    }
}
