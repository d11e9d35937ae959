//! The spheres that may keep a light from a point.
//!
//! Seen from a directional light every sphere is a disc. A grid over the plane across the light
//! lists for each cell the discs that reach into it.

use glam::{DVec2, DVec3};

use crate::Sphere;
use crate::rounding::UNIT_ROUNDOFF;

/// Cells a sphere. More cells would list fewer discs each, and take longer to fill.
const CELLS_PER_SPHERE: f64 = 4.0;

/// Cells along a side of the grid, at most.
const MOST_CELLS_ALONG: f64 = 2048.0;

/// A disc that reaches into more cells than this is asked for at every point instead.
const MOST_CELLS_OF_DISC: usize = 1024;

/// Which discs a point of the plane may lie in.
#[derive(Clone, Debug)]
pub(super) struct Casters {
    /// The coordinates of the plane.
    right: DVec3,
    up: DVec3,
    /// The corner of the first cell, and cells per length.
    corner: DVec2,
    cells_per_length: f64,
    columns: usize,
    rows: usize,
    /// Where the list of each cell starts in `indices`, and one end more.
    starts: Vec<u32>,
    indices: Vec<u32>,
    /// Discs that are too large for lists.
    large: Vec<u32>,
}

/// The cells from `first` to `last`, both included, as (column, row).
struct Cells {
    first: (usize, usize),
    last: (usize, usize),
}

impl Casters {
    /// The discs of the spheres across a light in the unit direction `toward`.
    pub(super) fn new(spheres: &[Sphere], toward: DVec3) -> Self {
        let (right, up) = toward.any_orthonormal_pair();
        let project = |sphere: &Sphere| project(sphere.center(), right, up);
        let centers: Vec<DVec2> = spheres.iter().map(project).collect();
        let low = centers
            .iter()
            .copied()
            .reduce(DVec2::min)
            .unwrap_or_default();
        let high = centers
            .iter()
            .copied()
            .reduce(DVec2::max)
            .unwrap_or_default();
        let size = high - low;
        // Square cells: as many as wanted in a box of this shape, not too many along its length.
        let most_cells = MOST_CELLS_ALONG * MOST_CELLS_ALONG;
        let cells = (CELLS_PER_SPHERE * spheres.len() as f64).min(most_cells);
        let wanted = (cells / (size.x * size.y)).sqrt();
        let most = MOST_CELLS_ALONG / size.max_element();
        let cells_per_length = if wanted < most { wanted } else { most };
        // All centers in one point, or so far apart that their distance overflows: a single cell.
        let cells_per_length = if cells_per_length.is_finite() {
            cells_per_length
        } else {
            0.0
        };
        let along = |size: f64| 1 + (size * cells_per_length) as usize;
        let mut casters = Self {
            right,
            up,
            corner: low,
            cells_per_length,
            columns: along(size.x).min(MOST_CELLS_ALONG as usize),
            rows: along(size.y).min(MOST_CELLS_ALONG as usize),
            starts: Vec::new(),
            indices: Vec::new(),
            large: Vec::new(),
        };
        casters.fill(spheres, &centers);
        casters
    }

    /// The indices of all spheres in whose disc the point may lie, and of some others.
    pub(super) fn near(&self, point: DVec3) -> impl Iterator<Item = usize> {
        let in_cells = (project(point, self.right, self.up) - self.corner) * self.cells_per_length;
        let cell = within(in_cells.y, self.rows) * self.columns + within(in_cells.x, self.columns);
        let listed = self.starts[cell] as usize..self.starts[cell + 1] as usize;
        self.large
            .iter()
            .chain(&self.indices[listed])
            .map(|&index| index as usize)
    }

    /// Lists the discs by cells: counts first, then places.
    fn fill(&mut self, spheres: &[Sphere], centers: &[DVec2]) {
        let slack = slack(spheres);
        let cells: Vec<Option<Cells>> = spheres
            .iter()
            .zip(centers)
            .map(|(sphere, center)| self.cells(*center, sphere.radius() + slack))
            .collect();
        let mut starts = vec![0_u32; self.columns * self.rows + 1];
        for (index, cells) in cells.iter().enumerate() {
            match cells {
                Some(cells) => cells.each(self.columns, |cell| starts[cell + 1] += 1),
                None => self.large.push(index as u32),
            }
        }
        for cell in 1..starts.len() {
            starts[cell] += starts[cell - 1];
        }
        self.indices = vec![0; starts[starts.len() - 1] as usize];
        let mut next = starts.clone();
        for (index, cells) in cells.iter().enumerate() {
            let Some(cells) = cells else { continue };
            cells.each(self.columns, |cell| {
                self.indices[next[cell] as usize] = index as u32;
                next[cell] += 1;
            });
        }
        self.starts = starts;
    }

    /// The cells that a disc reaches into, `None` where they are too many or cannot be told.
    fn cells(&self, center: DVec2, radius: f64) -> Option<Cells> {
        let first = (center - radius - self.corner) * self.cells_per_length;
        let last = (center + radius - self.corner) * self.cells_per_length;
        if !(first.is_finite() && last.is_finite()) {
            return None;
        }
        // A point that rounding moves into the next cell is still found: one more on each side.
        let cells = Cells {
            first: (
                within(first.x - 1.0, self.columns),
                within(first.y - 1.0, self.rows),
            ),
            last: (
                within(last.x + 1.0, self.columns),
                within(last.y + 1.0, self.rows),
            ),
        };
        (cells.count() <= MOST_CELLS_OF_DISC).then_some(cells)
    }
}

impl Cells {
    fn count(&self) -> usize {
        (self.last.0 - self.first.0 + 1) * (self.last.1 - self.first.1 + 1)
    }

    fn each(&self, columns: usize, mut visit: impl FnMut(usize)) {
        for row in self.first.1..=self.last.1 {
            for column in self.first.0..=self.last.0 {
                visit(row * columns + column);
            }
        }
    }
}

/// The cell of a coordinate. What lies beyond the grid belongs to its border, points as discs, so
/// that a disc is listed wherever a point of it is looked for.
fn within(coordinate: f64, count: usize) -> usize {
    coordinate.clamp(0.0, count as f64 - 1.0) as usize
}

fn project(point: DVec3, right: DVec3, up: DVec3) -> DVec2 {
    DVec2::new(point.dot(right), point.dot(up))
}

/// More than rounding can move the projections of a center and of a surface point apart.
///
/// With u the unit roundoff and M the largest |c| + r: every projection is off by 4u M√3, the two
/// axes and the light are orthogonal up to 8u, over which a ray to the light drifts by 8u · 2M at
/// most, and a surface point is known up to 7u · 2M; 64u M covers twice the sum.
fn slack(spheres: &[Sphere]) -> f64 {
    let reach = |sphere: &Sphere| sphere.center().abs().max_element() * 1.75 + sphere.radius();
    128.0 * UNIT_ROUNDOFF * spheres.iter().map(reach).fold(0.0, f64::max)
}
