//! Which parts of a block of pixels are covered.

use fearless_simd::prelude::*;
use fearless_simd::{Level, Simd, dispatch, f64x8, mask64x8};
use glam::{DVec2, DVec3};

use super::Points;
use crate::model::view::View;
use crate::numeric::rounding::UNIT_ROUNDOFF;

/// Pixels on a side of a block.
pub(super) const BLOCK: u32 = 64;
/// Cells on a side of a pixel, at most: small enough to lie inside of spheres that are seen as large
/// as one.
const CELLS_A_PIXEL: u32 = 4;
/// Cells on a side of a block, at most.
const MOST_CELLS: u32 = BLOCK * CELLS_A_PIXEL;
const WORDS: usize = (MOST_CELLS / u64::BITS) as usize;
/// Lines across the retina side by side.
const LINES: usize = 8;

/// Some cells of a block: columns and rows, ends included.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub(super) struct CellRange {
    pub(super) columns: (u32, u32),
    pub(super) rows: (u32, u32),
}

impl CellRange {
    /// The cells of both, if any.
    pub(super) fn and(self, other: Self) -> Option<Self> {
        let both = |one: (u32, u32), other: (u32, u32)| (one.0.max(other.0), one.1.min(other.1));
        let columns = both(self.columns, other.columns);
        let rows = both(self.rows, other.rows);
        (columns.0 <= columns.1 && rows.0 <= rows.1).then_some(Self { columns, rows })
    }
}

/// The first and the last cells of eight things along an axis.
type Spans = ([u32; LINES], [u32; LINES]);

/// The grid of cells of a block, on the retina at distance 1. Where rays go through few points, a
/// cell stands for the point in its middle.
#[derive(Clone, Copy, Debug)]
pub(super) struct Grid {
    /// The upper left corner.
    corner: DVec2,
    cell: f64,
    /// One over that.
    in_cells: f64,
    /// Cells on a side.
    pub(super) cells: u32,
    /// Where in a cell the line of points lies that rays go through; 0 where they go anywhere.
    middle: f64,
    /// More than places are off by, in cells.
    margin: DVec2,
}

impl Grid {
    /// Far above all rounding errors, in sums of absolute values.
    const MARGIN: f64 = 1e-10;

    /// The grid of the block that begins at a pixel.
    pub(super) fn new(view: &View, points: Points, col: u32, row: u32) -> Self {
        let (cells_a_pixel, middle) = match points {
            Points::Midpoints(samples) if samples.get() <= CELLS_A_PIXEL => (samples.get(), 0.5),
            _ => (CELLS_A_PIXEL, 0.0),
        };
        let distance = view.lens.distance * view.zoom;
        let pixel = view.pixel_size();
        let from_middle = |first: u32, pixels: u32| f64::from(first) - 0.5 * f64::from(pixels);
        let corner = DVec2::new(
            from_middle(col, view.width) * pixel + view.lens.shift.x,
            -from_middle(row, view.height) * pixel + view.lens.shift.y,
        );
        let corner = corner / distance;
        let cell = pixel / distance / f64::from(cells_a_pixel);
        let in_cells = 1.0 / cell;
        Self {
            corner,
            cell,
            // What is not a number reaches all cells and covers none.
            in_cells: if in_cells.is_finite() {
                in_cells
            } else {
                f64::NAN
            },
            cells: BLOCK * cells_a_pixel,
            middle,
            margin: corner.abs() * (Self::MARGIN / cell) + Self::MARGIN,
        }
    }

    /// All cells.
    pub(super) fn all(&self) -> CellRange {
        CellRange {
            columns: (0, self.cells - 1),
            rows: (0, self.cells - 1),
        }
    }

    /// The cells that reach into a rectangle of the retina, or have their points there, and few
    /// others.
    pub(super) fn range(&self, low: DVec2, high: DVec2) -> Option<CellRange> {
        let span = |a: f64, b: f64, margin: f64| {
            let (low, high) = (a * self.in_cells, b * self.in_cells);
            let margin = Self::MARGIN * (low.abs() + high.abs()) + margin - self.middle;
            let (low, high) = (low.min(high) - margin, low.max(high) + margin);
            if high < 0.0 || low >= f64::from(self.cells) {
                return None;
            }
            // The casts saturate, and take what is not a number to the first cell.
            let high = if high.is_nan() { f64::INFINITY } else { high };
            let (first, last) = (low as u32, (high as u32).min(self.cells - 1));
            (first <= last).then_some((first, last))
        };
        let across = (low.x - self.corner.x, high.x - self.corner.x);
        let down = (self.corner.y - high.y, self.corner.y - low.y);
        Some(CellRange {
            columns: span(across.0, across.1, self.margin.x)?,
            rows: span(down.0, down.1, self.margin.y)?,
        })
    }
}

impl Grid {
    /// The columns that reach in between places on the retina, or have their points there, and few
    /// others; where the places are not known, all. Which of the spans are any.
    #[inline(always)]
    pub(super) fn columns<S: Simd>(
        &self,
        simd: S,
        low: f64x8<S>,
        high: f64x8<S>,
        is_known: mask64x8<S>,
    ) -> (Spans, mask64x8<S>) {
        let ends = (low - self.corner.x, high - self.corner.x);
        self.spans(simd, ends, self.margin.x, is_known)
    }

    /// The rows in the same way.
    #[inline(always)]
    pub(super) fn rows<S: Simd>(
        &self,
        simd: S,
        low: f64x8<S>,
        high: f64x8<S>,
        is_known: mask64x8<S>,
    ) -> (Spans, mask64x8<S>) {
        let top = f64x8::splat(simd, self.corner.y);
        self.spans(simd, (top - high, top - low), self.margin.y, is_known)
    }

    /// As in [`Grid::range`].
    #[inline(always)]
    fn spans<S: Simd>(
        &self,
        simd: S,
        (low, high): (f64x8<S>, f64x8<S>),
        margin: f64,
        is_known: mask64x8<S>,
    ) -> (Spans, mask64x8<S>) {
        let (zero, last) = (
            f64x8::splat(simd, 0.0),
            f64x8::splat(simd, f64::from(self.cells - 1)),
        );
        let (low, high) = (low * self.in_cells, high * self.in_cells);
        let margin = (low.abs() + high.abs()) * Self::MARGIN + (margin - self.middle);
        let (low, high) = ((low - margin).floor(), (high + margin).floor());
        let is_out = high.simd_lt(zero) | low.simd_gt(last) | low.simd_gt(high);
        // What is not a number reaches from the first cell to the last.
        let low = (low.simd_gt(zero) & is_known).select(low, zero);
        let high = (high.simd_lt(last) & is_known).select(high, last);
        let (low, high): ([f64; LINES], [f64; LINES]) = (low.into(), high.into());
        let (mut first, mut end) = ([0; LINES], [0; LINES]);
        for lane in 0..LINES {
            (first[lane], end[lane]) = (low[lane] as u32, high[lane] as u32);
        }
        ((first, end), !(is_out & is_known))
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

    /// Between which places lines across the retina at the heights `v` are covered, where any part
    /// of them is.
    ///
    /// With d = (u, v, 1): (d·c)² ≥ K d·d, of which the terms in u² are negative for a sphere in
    /// front of the eye. A quarter of the discriminant is K (r² (v² + 1) − (c_y − v c_z)²), computed
    /// from terms below 2 c⁴ (v² + 1) with a dozen roundings; v is off by a few units in its last
    /// place, which makes 2 K r c_z √(v² + 1) as much. It is lowered by more: near its top an outline
    /// is as wide as the root of what it is too high by.
    #[inline(always)]
    fn along<S: Simd>(&self, simd: S, v: f64x8<S>) -> (f64x8<S>, f64x8<S>, mask64x8<S>) {
        let (c, k) = (self.center, self.outside);
        let zero = f64x8::splat(simd, 0.0);
        let square = c.x * c.x - k;
        let rest = v * c.y + c.z;
        let linear = rest * c.x;
        let line_sq = v * v + 1.0;
        let slack = line_sq * (128.0 * UNIT_ROUNDOFF * self.center_sq * self.center_sq);
        let discriminant = linear * linear - (rest * rest - line_sq * k) * square - slack;
        let is_ahead = f64x8::splat(simd, square).simd_lt(zero);
        let is_finite = discriminant.simd_lt(f64::INFINITY);
        let is_met = discriminant.simd_gt(zero) & is_finite & is_ahead;
        let half = is_met.select(discriminant, zero).sqrt() / -square;
        let middle = linear / -square;
        let inner = half * (1.0 - self.error) - middle.abs() * (f64::EPSILON * 16.0);
        (middle - inner, middle + inner, is_met)
    }
}

/// The covered cells of a block.
#[derive(Clone, Debug)]
pub(super) struct Coverage {
    rows: Box<[[u64; WORDS]]>,
    /// What the processor can do.
    level: Level,
}

impl Coverage {
    /// Nothing of a grid is covered but what lies outside of a picture that ends after so many
    /// columns and rows of pixels, of which no more than a block's count.
    pub(super) fn new(grid: &Grid, columns: u32, rows: u32) -> Self {
        let cells = grid.cells;
        let mut coverage = Self {
            rows: vec![[0; WORDS]; cells as usize].into_boxed_slice(),
            level: Level::new(),
        };
        let cells_a_pixel = cells / BLOCK;
        let columns = columns.min(BLOCK) * cells_a_pixel;
        let rows = rows.min(BLOCK) * cells_a_pixel;
        for row in 0..cells {
            let first = if row < rows { columns } else { 0 };
            coverage.cover(row, first, cells);
        }
        coverage
    }

    /// Whether all of some cells are covered.
    pub(super) fn is_covered(&self, range: CellRange) -> bool {
        let (first, end) = (range.columns.0, range.columns.1 + 1);
        let rows = &self.rows[range.rows.0 as usize..=range.rows.1 as usize];
        (first / u64::BITS..=range.columns.1 / u64::BITS).all(|word| {
            let mask = mask(word, first, end);
            rows.iter().all(|row| mask & !row[word as usize] == 0)
        })
    }

    /// Covers what lies inside a sphere for certain.
    pub(super) fn add(&mut self, grid: &Grid, cover: &Cover) {
        dispatch!(self.level, simd => self.add_lanes(simd, grid, cover));
    }

    #[inline(always)]
    fn add_lanes<S: Simd>(&mut self, simd: S, grid: &Grid, cover: &Cover) {
        /// In cells: above what their places are off by.
        const MARGIN: f64 = 1e-6;
        const STEPS: [f64; LINES] = [0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0];
        let zero = f64x8::splat(simd, 0.0);
        let cells = f64x8::splat(simd, f64::from(grid.cells));
        let (margin, middle) = (grid.margin.x + MARGIN, grid.middle);
        // Of cells that stand for their points one line is met, of others both edges.
        let edges = if middle > 0.0 { 0 } else { 1 };
        let (mut row, last) = cover.range.rows;
        while row <= last {
            let lines = f64x8::simd_from(simd, STEPS) + (f64::from(row) + middle);
            let height = f64x8::splat(simd, grid.corner.y) - lines * grid.cell;
            let (low, high, is_met) = cover.along(simd, height);
            let low = (low - grid.corner.x) * grid.in_cells;
            let high = (high - grid.corner.x) * grid.in_cells;
            let size = (low.abs() + high.abs()) * 1e-9 + (margin - middle);
            let is_met = is_met & size.simd_lt(f64::INFINITY);
            let first = is_met.select((low + size).ceil().max(zero).min(cells), cells);
            let end = is_met.select((high - size).floor().max(zero).min(cells), zero);
            let (first, end): ([f64; LINES], [f64; LINES]) = (first.into(), end.into());
            // The outline is convex: what is inside at both ends of an upright line is inside.
            for line in 0..LINES - edges {
                if row > last {
                    break;
                }
                let first = first[line].max(first[line + edges]) as u32;
                let end = end[line].min(end[line + edges]) as u32;
                if first < end {
                    self.cover(row, first, end);
                }
                row += 1;
            }
        }
    }

    /// Covers the cells of a row from `first` up to, but without, `end`.
    #[inline(always)]
    fn cover(&mut self, row: u32, first: u32, end: u32) {
        let row = &mut self.rows[row as usize];
        for word in first / u64::BITS..end.div_ceil(u64::BITS) {
            row[word as usize] |= mask(word, first, end);
        }
    }
}

/// Bits of a word of a row from `first` up to, but without, `end`, which it reaches.
#[inline(always)]
fn mask(word: u32, first: u32, end: u32) -> u64 {
    let from = first.saturating_sub(word * u64::BITS);
    let to = (end - word * u64::BITS).min(u64::BITS);
    u64::MAX << from & u64::MAX >> (u64::BITS - to)
}
