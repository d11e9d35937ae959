//! The grid of cells that a block of pixels is divided into.

use std::num::NonZeroU32;

use fearless_simd::Simd;
use glam::DVec2;

use crate::model::view::View;
use crate::numeric::lanes::{LANES, f64x8, mask64x8};
use crate::picture::pixel::Method;

/// The points of the retina that rays go through.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub(crate) enum RayPoints {
    /// Any.
    All,
    /// The midpoints of an N × N division of every pixel.
    Midpoints(NonZeroU32),
}

impl From<Method> for RayPoints {
    fn from(method: Method) -> Self {
        match method {
            Method::Samples(samples) => Self::Midpoints(samples),
            Method::Tolerance(_) => Self::All,
        }
    }
}

/// Pixels on a side of a block.
pub(super) const BLOCK: u32 = 64;

/// Cells on a side of a pixel, at most: small enough to lie inside of spheres that are seen as large
/// as one.
const CELLS_A_PIXEL: u32 = 4;

/// Cells on a side of a block, at most.
pub(super) const MOST_CELLS: u32 = BLOCK * CELLS_A_PIXEL;

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

/// The ends of eight things on the retina, low and high, along both axes.
pub(super) type Ends<S> = [(f64x8<S>, f64x8<S>); 2];

/// The first and the last cells of eight things along an axis.
pub(super) type Spans = ([u32; LANES], [u32; LANES]);

/// The grid of cells of a block, on the retina at distance 1. Where rays go through few points, a
/// cell stands for the point in its middle.
#[derive(Clone, Copy, Debug)]
pub(super) struct Grid {
    /// The upper left corner.
    pub(super) corner: DVec2,
    /// Width and height of a cell.
    pub(super) cell: DVec2,
    /// One over these.
    pub(super) in_cells: DVec2,
    /// Cells on a side.
    pub(super) cells: u32,
    /// The place in a cell of the line of points that rays go through; 0 where they go anywhere.
    pub(super) middle: f64,
    /// More than places are off by, in cells.
    pub(super) margin: DVec2,
}

impl Grid {
    /// Far above all rounding errors, in sums of absolute values.
    const MARGIN: f64 = 1e-10;

    /// The grid of the block that begins at a pixel.
    pub(super) fn new(view: &View, points: RayPoints, col: u32, row: u32) -> Self {
        let (cells_a_pixel, middle) = match points {
            RayPoints::Midpoints(samples) if samples.get() <= CELLS_A_PIXEL => (samples.get(), 0.5),
            _ => (CELLS_A_PIXEL, 0.0),
        };
        let distance = view.lens.distance * view.zoom;
        let pixel = view.pixel_size();
        let from_middle = |first: u32, pixels: u32| f64::from(first) - 0.5 * f64::from(pixels);
        let corner = DVec2::new(
            from_middle(col, view.width) * pixel.x + view.lens.shift.x,
            -from_middle(row, view.height) * pixel.y + view.lens.shift.y,
        );
        let corner = corner / distance;
        let cell = pixel / distance / f64::from(cells_a_pixel);
        // What is not a number reaches all cells and covers none.
        let in_cells = (1.0 / cell).map(|cells| if cells.is_finite() { cells } else { f64::NAN });
        Self {
            corner,
            cell,
            in_cells,
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
        let span = |(a, b): (f64, f64), in_cells: f64, margin: f64| {
            let (low, high) = (a * in_cells, b * in_cells);
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
            columns: span(across, self.in_cells.x, self.margin.x)?,
            rows: span(down, self.in_cells.y, self.margin.y)?,
        })
    }

    /// The columns and the rows that reach in between the ends of eight things on the retina, or have their
    /// points there, and few others; where the ends are not known, all. Which of the spans are any.
    #[inline(always)]
    pub(super) fn spans<S: Simd>(
        &self,
        simd: S,
        [across, upward]: Ends<S>,
        is_known: mask64x8<S>,
    ) -> (Spans, Spans, mask64x8<S>) {
        let across = (across.0 - self.corner.x, across.1 - self.corner.x);
        let top = f64x8::splat(simd, self.corner.y);
        let down = (top - upward.1, top - upward.0);
        let (right, below) = (
            (self.in_cells.x, self.margin.x),
            (self.in_cells.y, self.margin.y),
        );
        let (columns, are_columns) = self.spans_along(simd, across, right, is_known);
        let (rows, are_rows) = self.spans_along(simd, down, below, is_known);
        (columns, rows, are_columns & are_rows)
    }

    /// As in [`Grid::range`].
    #[inline(always)]
    fn spans_along<S: Simd>(
        &self,
        simd: S,
        (low, high): (f64x8<S>, f64x8<S>),
        (in_cells, margin): (f64, f64),
        is_known: mask64x8<S>,
    ) -> (Spans, mask64x8<S>) {
        let (zero, last) = (
            f64x8::splat(simd, 0.0),
            f64x8::splat(simd, f64::from(self.cells - 1)),
        );
        let (low, high) = (low * in_cells, high * in_cells);
        let margin = (low.abs() + high.abs()) * Self::MARGIN + (margin - self.middle);
        let (low, high) = ((low - margin).floor(), (high + margin).floor());
        let is_out = high.simd_lt(zero) | low.simd_gt(last) | low.simd_gt(high);
        // What is not a number reaches from the first cell to the last.
        let low = (low.simd_gt(zero) & is_known).select(low, zero);
        let high = (high.simd_lt(last) & is_known).select(high, last);
        let (low, high): ([f64; LANES], [f64; LANES]) = (low.into(), high.into());
        let (mut first, mut end) = ([0; LANES], [0; LANES]);
        for lane in 0..LANES {
            (first[lane], end[lane]) = (low[lane] as u32, high[lane] as u32);
        }
        ((first, end), !(is_out & is_known))
    }
}
