//! The spheres of a crowd in cells across a light, to find what may darken a small one.
//!
//! Each sphere is listed once, in the cell of its center, with its numbers beside it in single precision: what may darken
//! a sphere lies in the few cells around its own, and is read in the order of memory. The spheres of a cell are listed by
//! layers, the highest toward the light first. A few of the largest are in a list of their own, so that cells are as large
//! as the others ask for.

use fearless_simd::{Level, Simd, dispatch};
use glam::{DVec3, Vec3};

use super::occluders::slack;
use crate::model::sphere::Sphere;
use crate::numeric::bits::set_bits;
use crate::numeric::lanes::{LANES, f32x8};
use crate::numeric::pair::both;

/// Worlds of fewer spheres need no cells, and in those of more the cells take too much memory: 20 bytes a sphere.
const COUNTS: std::ops::RangeInclusive<usize> = 256..=1 << 23;

/// The most spheres that are too large for the cells. Not tuned.
const MOST_LARGE: usize = 16;

/// The spheres of a sphere's own cell, on the average over spheres, of which more take too long to go through. Not tuned: a
/// million that fill a ninth of a cube have 36.
const MOST_IN_CELL: u64 = 256;

/// The place of a sphere that is in no cell.
const NOWHERE: u32 = u32::MAX;

/// The most layers of a cell. Not tuned.
const MOST_LAYERS: usize = 64;

/// The cells that a search may take: nine where a sphere is no larger than those of the cells. Not tuned.
const MOST_CELLS: usize = 64;

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
    /// The places of the centers in their cells, their heights, and the radii; some more than there are spheres.
    places: [Vec<f32>; 2],
    heights: Vec<f32>,
    radii: Vec<f32>,
    indices: Vec<u32>,
    /// The indices of those that are too large.
    large: Vec<u32>,
    /// The least radius of a sphere whose occluders are known well enough.
    least: f64,
    level: Level,
}

/// The sphere that is asked about; its center may be off by a rounding.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Asked {
    pub(crate) center: DVec3,
    pub(crate) radius: f64,
    pub(crate) index: u32,
}

/// A sphere that lies higher than the asked one, and may darken it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Higher {
    /// The way to it from center to center: to the right and up across the light, and toward it.
    pub(crate) way: DVec3,
    pub(crate) radius: f64,
    /// The sphere's index.
    pub(crate) index: u32,
}

/// What was found, and memory to work in.
#[derive(Debug, Default)]
pub(crate) struct Found {
    pub(crate) list: Vec<Higher>,
    masks: Vec<u8>,
}

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
            starts: vec![0; columns * rows * layers + 2],
            places: [Vec::new(), Vec::new()],
            heights: Vec::new(),
            radii: Vec::new(),
            indices: Vec::new(),
            large: Vec::new(),
            least: least_radius(low, high, side),
            level: Level::new(),
        };
        grid.list(spheres, reach);
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

    /// Lists the spheres up to a radius cell by cell, and the others one by one.
    fn list(&mut self, spheres: &[Sphere], reach: f64) {
        // How many there are, one layer further on; then where each layer begins, by counting up.
        let mut listed = Vec::with_capacity(spheres.len());
        for (index, sphere) in spheres.iter().enumerate() {
            if sphere.radius() > reach {
                self.large.push(index as u32);
                listed.push(NOWHERE);
                continue;
            }
            let place = self.place(sphere.center());
            let (column, row) = (
                (place.x / self.side) as usize,
                (place.y / self.side) as usize,
            );
            let cell = row * self.columns + column;
            let layer = cell * self.layers + self.layer(place.z);
            listed.push(layer as u32);
            self.starts[layer + 2] += 1;
        }
        let mut sum = 0;
        for start in &mut self.starts {
            sum += *start;
            *start = sum;
        }
        self.indices.resize(sum as usize, 0);
        for (index, listed) in listed.iter_mut().enumerate() {
            if *listed != NOWHERE {
                let next = &mut self.starts[*listed as usize + 1];
                self.indices[*next as usize] = index as u32;
                *listed = *next;
                *next += 1;
            }
        }
        self.starts.pop();
        // Number by number: what is written here and there fits into nearer memory.
        let numbers = |axis: usize| {
            // Behind the last are others, so that eight may be read from any one on.
            let mut numbers = vec![0.0; self.indices.len() + LANES];
            for (sphere, &listed) in spheres.iter().zip(&listed) {
                if listed != NOWHERE {
                    numbers[listed as usize] = self.number(sphere, axis) as f32;
                }
            }
            numbers
        };
        let across = || [numbers(0), numbers(1)];
        (self.places, [self.heights, self.radii]) =
            rayon::join(across, || [numbers(2), numbers(3)]);
    }

    /// The place in its cell of the center of a sphere along one of the axes across the light, its height, or its radius.
    fn number(&self, sphere: &Sphere, axis: usize) -> f64 {
        let Some(along) = self.axes.get(axis) else {
            return sphere.radius();
        };
        let place = along.dot(sphere.center()) - self.low[axis];
        if axis == 2 {
            place
        } else {
            place - (place / self.side).floor() * self.side
        }
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

    /// Finds the spheres that lie higher than one of them and may darken it, as far as single precision tells; false if that
    /// is too little, or they lie in too many cells.
    pub(crate) fn find(&self, spheres: &[Sphere], asked: &Asked, memory: &mut Found) -> bool {
        if asked.radius < self.least {
            return false;
        }
        let at = self.place(asked.center);
        let reach = asked.radius + 0.5 * self.side;
        let rows = self.starts.len() / (self.columns * self.layers);
        let along = |place: f64, count: usize| {
            let cell = |place: f64| ((place / self.side).max(0.0) as usize).min(count - 1);
            (cell(place - reach), cell(place + reach))
        };
        let (columns, rows) = (along(at.x, self.columns), along(at.y, rows));
        if (columns.1 - columns.0 + 1) * (rows.1 - rows.0 + 1) > MOST_CELLS {
            return false;
        }
        for row in rows.0..=rows.1 {
            for column in columns.0..=columns.1 {
                self.find_in((column, row), (at, asked), memory);
            }
        }
        for &index in &self.large {
            let sphere = &spheres[index as usize];
            let way = self.place(sphere.center()) - at;
            let is_near = way.truncate().length() < sphere.radius() + asked.radius;
            if is_near && way.z > 0.0 && index != asked.index {
                memory.list.push(Higher {
                    way,
                    radius: sphere.radius(),
                    index,
                });
            }
        }
        true
    }

    /// Finds those of a cell.
    fn find_in(
        &self,
        (column, row): (usize, usize),
        (at, asked): (DVec3, &Asked),
        memory: &mut Found,
    ) {
        let first = (row * self.columns + column) * self.layers;
        let start = self.starts[first] as usize;
        let end = self.starts[first + self.layer(at.z) + 1] as usize;
        let at = at - DVec3::new(column as f64, row as f64, 0.0) * self.side;
        let numbers = (at.as_vec3(), asked.radius as f32);
        let eights = (end - start).div_ceil(LANES);
        if memory.masks.len() < eights {
            memory.masks.resize(eights, 0);
        }
        let masks = &mut memory.masks[..eights];
        dispatch!(self.level, simd => self.near(simd, start, numbers, masks));
        for (number, &mask) in masks.iter().enumerate() {
            let first = start + number * LANES;
            let there = (1_u64 << (end - first).min(LANES)) - 1;
            for place in set_bits(u64::from(mask) & there) {
                let place = first + place;
                let index = self.indices[place];
                if index != asked.index {
                    let [x, y] = &self.places;
                    let way = Vec3::new(x[place], y[place], self.heights[place]);
                    memory.list.push(Higher {
                        way: way.as_dvec3() - at,
                        radius: self.radii[place].into(),
                        index,
                    });
                }
            }
        }
    }

    /// For each eight spheres from a place on whether they lie higher and near the asked one, bit by bit.
    #[inline(always)]
    fn near<S: Simd>(&self, simd: S, start: usize, (at, radius): (Vec3, f32), masks: &mut [u8]) {
        for (number, mask) in masks.iter_mut().enumerate() {
            let first = start + number * LANES;
            let aside = f32x8::read(simd, &self.places[0], first) - at.x;
            let away = f32x8::read(simd, &self.places[1], first) - at.y;
            let both = f32x8::read(simd, &self.radii, first) + radius;
            let is_near = (aside * aside + away * away).simd_lt(both * both);
            let heights = f32x8::read(simd, &self.heights, first);
            let is_higher = heights.simd_gt(f32x8::splat(simd, at.z));
            *mask = (is_higher & is_near).to_bitmask() as u8;
        }
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
