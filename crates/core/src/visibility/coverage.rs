//! Which parts of a block of pixels are covered.

use glam::{DVec2, DVec3};

use crate::View;
use crate::rounding::UNIT_ROUNDOFF;

/// Pixels on a side of a block.
pub(super) const BLOCK: u32 = 64;
/// Cells on a side of a pixel: small enough to lie inside of spheres that are seen as large as one.
const CELLS_A_PIXEL: u32 = 4;
/// Cells on a side of a block.
pub(super) const CELLS: u32 = BLOCK * CELLS_A_PIXEL;
const WORDS: usize = (CELLS / u64::BITS) as usize;

/// Some cells of a block: columns and rows, ends included.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub(super) struct CellRange {
    pub(super) columns: (u32, u32),
    pub(super) rows: (u32, u32),
}

impl CellRange {
    pub(super) const ALL: Self = Self {
        columns: (0, CELLS - 1),
        rows: (0, CELLS - 1),
    };

    /// The cells of both, if any.
    pub(super) fn and(self, other: Self) -> Option<Self> {
        let both = |one: (u32, u32), other: (u32, u32)| (one.0.max(other.0), one.1.min(other.1));
        let columns = both(self.columns, other.columns);
        let rows = both(self.rows, other.rows);
        (columns.0 <= columns.1 && rows.0 <= rows.1).then_some(Self { columns, rows })
    }
}

/// The grid of cells of a block, on the retina at distance 1.
#[derive(Clone, Copy, Debug)]
pub(super) struct Grid {
    /// The upper left corner.
    corner: DVec2,
    cell: f64,
}

impl Grid {
    /// The grid of the block that begins at a pixel.
    pub(super) fn new(view: &View, col: u32, row: u32) -> Self {
        let distance = view.lens.distance * view.zoom;
        let pixel = view.pixel_size();
        let from_middle = |first: u32, pixels: u32| f64::from(first) - 0.5 * f64::from(pixels);
        let corner = DVec2::new(
            from_middle(col, view.width) * pixel + view.lens.shift.x,
            -from_middle(row, view.height) * pixel + view.lens.shift.y,
        );
        Self {
            corner: corner / distance,
            cell: pixel / distance / f64::from(CELLS_A_PIXEL),
        }
    }

    /// The cells that reach into a rectangle of the retina, and few others.
    pub(super) fn range(&self, low: DVec2, high: DVec2) -> Option<CellRange> {
        /// Far above all rounding errors, in sums of absolute values.
        const MARGIN: f64 = 1e-10;
        let span = |a: f64, b: f64, size: f64| {
            let margin = MARGIN * (a.abs() + b.abs() + size / self.cell) + MARGIN;
            let (low, high) = (a.min(b) - margin, a.max(b) + margin);
            if high < 0.0 || low >= f64::from(CELLS) {
                return None;
            }
            // The casts saturate, and take what is not a number to the first cell.
            let high = if high.is_nan() { f64::INFINITY } else { high };
            Some((low as u32, (high as u32).min(CELLS - 1)))
        };
        let across = (low.x - self.corner.x, high.x - self.corner.x);
        let down = (self.corner.y - high.y, self.corner.y - low.y);
        let size = self.corner.abs();
        Some(CellRange {
            columns: span(across.0 / self.cell, across.1 / self.cell, size.x)?,
            rows: span(down.0 / self.cell, down.1 / self.cell, size.y)?,
        })
    }
}

/// A sphere in front of the eye that hides what is behind it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Cover {
    /// In the camera's frame.
    center: DVec3,
    /// The square of its length.
    center_sq: f64,
    /// That less the square of the radius, which is a little smaller than the sphere's.
    outside: f64,
    /// By how much a half width may be off, relatively.
    error: f64,
    range: CellRange,
}

impl Cover {
    /// What a sphere covers, if that is known well and may be anything.
    pub(super) fn new(center: DVec3, radius: f64, range: CellRange) -> Option<Self> {
        const CLEAR: f64 = 1.0 + 1.0 / 64.0;
        const LEAST_OUTSIDE: f64 = 1e-3;
        const MOST_ERROR: f64 = 1e-2;
        // As much smaller as other bounds are larger: what turning it into the camera's frame costs.
        let radius = radius - 128.0 * UNIT_ROUNDOFF * (center.abs().element_sum() + radius);
        let (center_sq, radius_sq) = (center.length_squared(), radius * radius);
        let outside = center_sq - radius_sq;
        // Squares of sums of coordinates cancel down to that of the radius.
        let error = 256.0 * f64::EPSILON * (center_sq / radius_sq);
        let is_known = radius > 0.0
            && center.z > CLEAR * radius
            && outside > LEAST_OUTSIDE * center_sq
            && error < MOST_ERROR;
        is_known.then_some(Self {
            center,
            center_sq,
            outside,
            error,
            range,
        })
    }

    /// No ray that meets the sphere goes on farther than this: the length of a tangent.
    pub(super) fn farthest(&self) -> f64 {
        self.outside.sqrt() * (1.0 + 1e-9)
    }

    /// Between which places a line across the retina at the height `v` is covered.
    ///
    /// With d = (u, v, 1): (d·c)² ≥ K d·d, of which the terms in u² are negative for a sphere in
    /// front of the eye. A quarter of the discriminant is K (r² (v² + 1) − (c_y − v c_z)²), computed
    /// from terms below 2 c⁴ (v² + 1) with a dozen roundings; v is off by a few units in its last
    /// place, which makes 2 K r c_z √(v² + 1) as much. It is lowered by more: near its top an outline
    /// is as wide as the root of what it is too high by.
    fn along(&self, v: f64) -> Option<(f64, f64)> {
        let (c, k) = (self.center, self.outside);
        let square = c.x * c.x - k;
        let rest = v * c.y + c.z;
        let linear = c.x * rest;
        let line_sq = v * v + 1.0;
        let slack = 128.0 * UNIT_ROUNDOFF * self.center_sq * self.center_sq * line_sq;
        let discriminant = linear * linear - square * (rest * rest - line_sq * k) - slack;
        if !(square < 0.0 && discriminant > 0.0 && discriminant < f64::INFINITY) {
            return None;
        }
        let half = discriminant.sqrt() / -square;
        let middle = linear / -square;
        let inner = half * (1.0 - self.error) - f64::EPSILON * 16.0 * middle.abs();
        Some((middle - inner, middle + inner))
    }
}

/// The covered cells of a block.
#[derive(Clone, Debug)]
pub(super) struct Coverage {
    rows: Box<[[u64; WORDS]]>,
}

impl Coverage {
    /// Nothing is covered but what lies outside of a picture that ends after so many columns and
    /// rows of pixels.
    pub(super) fn new(columns: u32, rows: u32) -> Self {
        let mut coverage = Self {
            rows: vec![[0; WORDS]; CELLS as usize].into_boxed_slice(),
        };
        let (columns, rows) = (columns * CELLS_A_PIXEL, rows * CELLS_A_PIXEL);
        for row in 0..CELLS {
            let first = if row < rows { columns } else { 0 };
            coverage.cover(row, first, CELLS);
        }
        coverage
    }

    /// Whether all of some cells are covered.
    pub(super) fn is_covered(&self, range: CellRange) -> bool {
        let masks = masks(range.columns.0, range.columns.1 + 1);
        let words = range.columns.0 / u64::BITS..=range.columns.1 / u64::BITS;
        self.rows[range.rows.0 as usize..=range.rows.1 as usize]
            .iter()
            .all(|row| {
                words
                    .clone()
                    .all(|word| masks[word as usize] & !row[word as usize] == 0)
            })
    }

    /// Covers what lies inside a sphere for certain.
    pub(super) fn add(&mut self, grid: &Grid, cover: &Cover) {
        /// In cells: above what their places are off by.
        const MARGIN: f64 = 1e-6;
        let height = |row: u32| grid.corner.y - f64::from(row) * grid.cell;
        let (first, last) = cover.range.rows;
        let mut above = cover.along(height(first));
        for row in first..=last {
            let below = cover.along(height(row + 1));
            if let (Some(above), Some(below)) = (above, below) {
                // The outline is convex: what is inside at both ends of an upright line is inside.
                let low = (above.0.max(below.0) - grid.corner.x) / grid.cell;
                let high = (above.1.min(below.1) - grid.corner.x) / grid.cell;
                let size = (low.abs() + high.abs()) * 1e-9;
                let is_finite = size < f64::INFINITY;
                let first = (low + size + MARGIN).ceil().max(0.0);
                let end = (high - size - MARGIN).floor().min(f64::from(CELLS));
                if is_finite && first < end {
                    self.cover(row, first as u32, end as u32);
                }
            }
            above = below;
        }
    }

    /// Covers the cells of a row from `first` up to, but without, `end`.
    fn cover(&mut self, row: u32, first: u32, end: u32) {
        let masks = masks(first, end);
        for (word, mask) in self.rows[row as usize].iter_mut().zip(masks) {
            *word |= mask;
        }
    }
}

/// Bits of a row from `first` up to, but without, `end`.
fn masks(first: u32, end: u32) -> [u64; WORDS] {
    let mut masks = [0; WORDS];
    for (word, mask) in (0..).zip(&mut masks) {
        let from = first.saturating_sub(word * u64::BITS).min(u64::BITS);
        let to = end.saturating_sub(word * u64::BITS).min(u64::BITS);
        if from < to {
            *mask = u64::MAX << from & u64::MAX >> (u64::BITS - to);
        }
    }
    masks
}
