//! The places of the samples of a tile.

use glam::DVec2;

use crate::model::view::View;
use crate::numeric::lanes::LANES;
use crate::picture::tile::Tile;

/// The samples of a tile, and one more row or column on every side, on the plane at the distance of 1.
#[derive(Clone, Debug)]
pub(super) struct Plane {
    /// Rows, and samples in each of them.
    pub(super) count: usize,
    /// The places in memory of a row: some more, a multiple of [`LANES`].
    pub(super) stride: usize,
    /// A place near the middle of the tile, from which [`Self::from_middle`] counts.
    pub(super) middle: DVec2,
    /// The first sample, and the way to the next one, which is downward.
    pub(super) first: DVec2,
    pub(super) step: DVec2,
    /// The least and the largest 1 + X² + Y² of its samples, or less and more.
    pub(super) square: [f64; 2],
    /// For each column, and for each row, its place, its square, and its way from the middle; up is positive.
    pub(super) columns: Lines,
    pub(super) rows: Lines,
}

/// Rows or columns.
#[derive(Clone, Debug)]
pub(super) struct Lines {
    pub(super) places: Vec<f32>,
    pub(super) squares: Vec<f32>,
    pub(super) from_middle: Vec<f32>,
}

impl Plane {
    /// The samples of one of the tiles that pictures are divided into.
    pub(super) fn new(view: &View, tile: Tile, side: u32) -> Self {
        let distance = view.magnification();
        let first = |pixel: u32| (i64::from(pixel) * i64::from(side) - 1) as u64;
        let place = |col: u64, row: u64| view.cell_center(col, row, side) / distance;
        let (col, row) = (first(tile.col), first(tile.row));
        let count = (Tile::SIDE * side) as usize + 2;
        // Behind the last sample are others, so that eight may be read from any one on.
        let stride = (count + LANES).next_multiple_of(LANES);
        let corner = place(col, row);
        let half = u64::from(Tile::SIDE * side / 2);
        let middle = place(col.wrapping_add(half), row.wrapping_add(half));
        let columns = Lines::new(stride, middle.x, |number| {
            place(col.wrapping_add(number), row).x
        });
        let rows = Lines::new(count, middle.y, |number| {
            place(col, row.wrapping_add(number)).y
        });
        let step = view.pixel_size() / distance / f64::from(side) * DVec2::new(1.0, -1.0);
        let half = (step * count as f64).abs();
        let [least, most] = [middle.abs() - half, middle.abs() + half];
        let least = least.max(DVec2::ZERO);
        Self {
            count,
            stride,
            middle,
            first: corner,
            step,
            square: [1.0 + least.length_squared(), 1.0 + most.length_squared()],
            columns,
            rows,
        }
    }

    /// True if no sample is so far from the axis of view that single precision knows little of it.
    pub(super) fn is_moderate(&self) -> bool {
        /// In distances of the plane. Not tuned: it is a field of view of 165 degrees.
        const FARTHEST: f64 = 8.0;
        let last = self.first + self.step * self.count as f64;
        self.first.abs().max(last.abs()).max_element() < FARTHEST
    }
}

impl Lines {
    fn new(count: usize, middle: f64, place: impl Fn(u64) -> f64) -> Self {
        let places: Vec<f64> = (0..count as u64).map(place).collect();
        Self {
            squares: places.iter().map(|place| (place * place) as f32).collect(),
            from_middle: places.iter().map(|place| (place - middle) as f32).collect(),
            places: places.into_iter().map(|place| place as f32).collect(),
        }
    }
}
