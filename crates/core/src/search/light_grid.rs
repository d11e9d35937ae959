//! The spheres of a crowd in cells across a light, to find what may darken a point, or a small sphere.
//!
//! Each sphere is listed once, in the cell of its center, with its numbers beside it in single precision: what may darken
//! a sphere lies in the few cells around its own, and is read in the order of memory. The spheres of a cell are listed by
//! layers, the highest toward the light first. A few of the largest are in a list of their own, so that cells are as large
//! as the others ask for. [`fill`] lists them, [`points`] asks for points, and [`around`] for whole spheres.

mod around;
mod fill;
mod points;

use fearless_simd::Level;
use glam::DVec3;

pub(crate) use self::around::{Asked, Found, Higher};
use super::occluders::slack;
use crate::model::sphere::Sphere;
use crate::numeric::lanes::LANES;
use crate::numeric::pair::both;

/// Worlds of fewer spheres need no cells, and in those of more the cells take too much memory: 20 bytes a sphere, and 48 more
/// while they are filled.
const COUNTS: std::ops::RangeInclusive<usize> = 256..=1 << 24;

/// The most spheres that are too large for the cells. Not tuned.
const MOST_LARGE: usize = 16;

/// The spheres of a sphere's own cell, on the average over spheres, of which more take too long to go through. Not tuned: a
/// million that fill a ninth of a cube have 36.
const MOST_IN_CELL: u64 = 256;

/// The most layers of a cell. Not tuned.
const MOST_LAYERS: usize = 64;

/// The spheres as a directional light sees them, cell by cell.
#[derive(Debug)]
pub(crate) struct LightGrid {
    /// The axes across the light and toward it.
    axes: [DVec3; 3],
    /// The corner of the first cell, at the height of the highest center.
    low: DVec3,
    /// The side of a cell, twice the largest radius of the spheres in them or more, and the height of a layer.
    side: f64,
    height: f64,
    /// Cells side by side, and layers of each.
    columns: usize,
    layers: usize,
    /// The first sphere of each layer, cell by cell, and row by row; one more for the end.
    starts: Vec<u32>,
    blocks: Vec<Block>,
    /// The indices of the spheres of the blocks.
    indices: Vec<u32>,
    /// The indices of those that are too large.
    large: Vec<u32>,
    /// The least radius of a sphere whose occluders are known well enough.
    least: f64,
    /// More than rounding moves the numbers of a block by, and points and spheres across the light.
    rounding: f64,
    level: Level,
}

/// Eight spheres: the places of their centers in their cells, to the right and up, their heights, and their radii.
type Block = [[f32; LANES]; 4];

impl LightGrid {
    /// The cells of spheres of moderate lengths, if they serve; the light's axes are those across it and toward it.
    pub(super) fn new(spheres: &[Sphere], axes: [DVec3; 3]) -> Option<Self> {
        if !COUNTS.contains(&spheres.len()) {
            return None;
        }
        let reach = largest_of_many(spheres);
        let place = |sphere: &Sphere| place(&axes, sphere.center());
        let (mut low, mut high) = (DVec3::INFINITY, DVec3::NEG_INFINITY);
        for sphere in spheres.iter().filter(|sphere| sphere.radius() <= reach) {
            let place = place(sphere);
            (low, high) = (low.min(place), high.max(place));
        }
        // No more cells than some three times the spheres.
        let (size, count) = (high - low, spheres.len() as f64);
        let least = (size.x * size.y / count).sqrt();
        let side = (2.0 * reach).max(least).max(size.x.max(size.y) / count);
        let [columns, rows] = both([size.x, size.y], |size| (size / side) as usize + 1);
        let layers = (spheres.len() / (columns * rows)).clamp(1, MOST_LAYERS);
        let mut grid = Self {
            axes,
            low: DVec3::new(low.x, low.y, high.z),
            side,
            height: size.z.max(f64::MIN_POSITIVE) / layers as f64,
            columns,
            layers,
            starts: vec![0; columns * rows * layers + 1],
            blocks: Vec::new(),
            indices: Vec::new(),
            large: Vec::new(),
            least: least_radius(low, high, side),
            rounding: rounding(low, high, side),
            level: Level::new(),
        };
        grid.fill(spheres, reach);
        (!grid.is_crowded()).then_some(grid)
    }

    /// A point across the light and toward it, from the corner of the first cell.
    fn place(&self, point: DVec3) -> DVec3 {
        place(&self.axes, point) - self.low
    }

    /// The layer that a height lies in, the highest one first.
    fn layer(&self, height: f64) -> usize {
        ((-height / self.height) as usize).min(self.layers - 1)
    }

    /// The first and the last column and row of the cells within a distance of a place.
    #[inline(always)]
    fn cells(&self, at: DVec3, reach: f64) -> [(usize, usize); 2] {
        let rows = self.starts.len() / (self.columns * self.layers);
        let along = |place: f64, count: usize| {
            let cell = |place: f64| ((place / self.side).max(0.0) as usize).min(count - 1);
            (cell(place - reach), cell(place + reach))
        };
        [along(at.x, self.columns), along(at.y, rows)]
    }

    /// The places of a cell's spheres down to a layer, and the cell's corner.
    #[inline(always)]
    fn cell(&self, (column, row): (usize, usize), last: usize) -> (Places, DVec3) {
        let first = (row * self.columns + column) * self.layers;
        let places = Places {
            start: self.starts[first] as usize,
            end: self.starts[first + last + 1] as usize,
        };
        (
            places,
            DVec3::new(column as f64, row as f64, 0.0) * self.side,
        )
    }

    /// True if it takes too long to go through the cells.
    fn is_crowded(&self) -> bool {
        let cells = self
            .starts
            .chunks(self.layers)
            .zip(self.starts[self.layers..].chunks(self.layers));
        let squares = cells.map(|(start, end)| u64::from(end[0] - start[0]));
        squares.map(|count| count * count).sum::<u64>() > MOST_IN_CELL * self.indices.len() as u64
    }
}

/// Places in blocks, one after the other.
#[derive(Clone, Copy)]
struct Places {
    start: usize,
    end: usize,
}

impl Places {
    /// The blocks in which they lie.
    #[inline(always)]
    fn blocks(self) -> std::ops::Range<usize> {
        self.start / LANES..self.end.div_ceil(LANES)
    }

    /// Those that lie in a block, as bits.
    #[inline(always)]
    fn of_block(self, block: usize) -> u64 {
        const ALL: u64 = (1 << LANES) - 1;
        let first = block * LANES;
        let before = self.start.saturating_sub(first);
        let behind = (first + LANES).saturating_sub(self.end);
        ALL >> behind & ALL << before
    }
}

/// The least radius beside which roundings are small, of spheres between these places in cells with this side.
fn least_radius(low: DVec3, high: DVec3, side: f64) -> f64 {
    /// The largest shift of a shadow across the light, in radii: a twentieth of a sample of the largest balls of a raster.
    const ACROSS: f64 = 5e-5;
    /// The largest error of a height, in radii: no light of a larger cosine is taken for dark, or for lit.
    const ALONG: f64 = 1e-3;
    let single = f64::from(f32::EPSILON);
    let of_place = slack(low.abs().max(high.abs()), 0.0);
    let (across, along) = (
        of_place + single * side,
        of_place + single * (high.z - low.z),
    );
    (across / ACROSS).max(along / ALONG)
}

/// More than rounding moves places in cells of this side by, heights, and radii, of spheres between these places: of the
/// spheres and of a point among them.
///
/// Single precision rounds by half of its epsilon e, relatively. A place in a cell is off by e/2 sides, that of a point in a
/// cell beside it and their difference by e sides each, a radius by e/4 sides, a height by e/2 depths, and the sum of a height
/// and a radius by e/2 of both: less than 4 e sides and 2 e depths, and it is twice as much. A point farther away
/// is off by more, but by far less than what it is beyond reach. For double precision see [`slack`]: of places along the
/// axes, whose sum is at least the distance from the origin, it is taken twice, as √3 would do.
fn rounding(low: DVec3, high: DVec3, side: f64) -> f64 {
    let of_single = 4.0 * f64::from(f32::EPSILON) * (2.0 * side + high.z - low.z);
    2.0 * slack(low.abs().max(high.abs()) + side, side) + of_single
}

/// The places of a point along axes.
fn place(axes: &[DVec3; 3], point: DVec3) -> DVec3 {
    DVec3::new(axes[0].dot(point), axes[1].dot(point), axes[2].dot(point))
}

/// The largest radius of which no more than [`MOST_LARGE`] spheres are larger, in steps of powers of two.
fn largest_of_many(spheres: &[Sphere]) -> f64 {
    const OCTAVES: usize = 64;
    let mut counts = [0_usize; OCTAVES];
    let mut largest = [0.0_f64; OCTAVES];
    let radii = spheres.iter().map(Sphere::radius);
    let exponent = |radius: f64| (radius.to_bits() >> (f64::MANTISSA_DIGITS - 1)) as usize;
    let highest = exponent(radii.clone().fold(0.0, f64::max));
    for radius in radii {
        let octave = (highest - exponent(radius)).min(OCTAVES - 1);
        counts[octave] += 1;
        largest[octave] = largest[octave].max(radius);
    }
    let mut sum = 0;
    for (count, largest) in counts.into_iter().zip(largest) {
        sum += count;
        if sum > MOST_LARGE {
            return largest;
        }
    }
    0.0
}

#[cfg(test)]
mod tests;
