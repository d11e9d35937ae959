//! The mask of the cells of a block that spheres cover.

use fearless_simd::{Level, Simd, dispatch};
use glam::DVec3;

use super::frustum::CLEAR;
use super::grid::{BLOCK, CellRange, Grid, MOST_CELLS};
use crate::numeric::lanes::{LANE_NUMBERS, LANES, f64x8, mask64x8};
use crate::numeric::rounding::UNIT_ROUNDOFF;

/// Words of a row of cells.
const WORDS: usize = (MOST_CELLS / u64::BITS) as usize;

/// A silhouette in front of the eye, a little smaller than the sphere's, that hides what is behind
/// it.
#[derive(Clone, Copy, Debug)]
pub(super) struct InnerSilhouette {
    /// In the camera's frame.
    center: DVec3,
    /// The square of its length.
    center_sq: f64,
    /// That less the square of the radius, which is a little smaller than the sphere's.
    outside: f64,
    /// The largest error of a half width, relatively.
    error: f64,
    range: CellRange,
}

impl InnerSilhouette {
    /// The part of a sphere's silhouette that it hides for certain, if that is known well and may be
    /// anything.
    pub(super) fn new(center: DVec3, radius: f64, range: CellRange) -> Option<Self> {
        /// The least K, relative to f·f: below it K has lost three digits to cancellation. Not tuned.
        const LEAST_OUTSIDE: f64 = 1e-3;
        /// Spheres that shrink more than this are not worth their place in the mask. Not tuned.
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
        /// Far above what rounding costs where K has kept its digits.
        const FARTHER: f64 = 1.0 + 1e-9;
        self.outside.sqrt() * FARTHER
    }

    /// Between which places lines across the retina at the heights `v` are covered, where any part
    /// of them is.
    ///
    /// With d = (u, v, 1): (d·c)² ≥ K d·d, of which the terms in u² are negative for a sphere in
    /// front of the eye. A quarter of the discriminant is K (r² (v² + 1) − (c_y − v c_z)²), computed
    /// from terms below 2 c⁴ (v² + 1) with a dozen roundings; v is off by a few units in its last
    /// place, which makes 2 K r c_z √(v² + 1) as much. It is lowered by more: near its top a silhouette
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
pub(super) struct CoverageMask {
    rows: Box<[[u64; WORDS]]>,
    /// The instructions that the processor has.
    level: Level,
}

impl CoverageMask {
    /// Nothing of a grid is covered but what lies outside of a picture that ends after so many
    /// columns and rows of pixels, of which no more than a block's count.
    pub(super) fn new(grid: &Grid, columns: u32, rows: u32) -> Self {
        let cells = grid.cells;
        let mut mask = Self {
            rows: vec![[0; WORDS]; cells as usize].into_boxed_slice(),
            level: Level::new(),
        };
        let cells_a_pixel = cells / BLOCK;
        let columns = columns.min(BLOCK) * cells_a_pixel;
        let rows = rows.min(BLOCK) * cells_a_pixel;
        for row in 0..cells {
            let first = if row < rows { columns } else { 0 };
            mask.cover(row, first, cells);
        }
        mask
    }

    /// True where all of some cells are covered.
    pub(super) fn is_covered(&self, range: CellRange) -> bool {
        let (first, end) = (range.columns.0, range.columns.1 + 1);
        let rows = &self.rows[range.rows.0 as usize..=range.rows.1 as usize];
        (first / u64::BITS..=range.columns.1 / u64::BITS).all(|word| {
            let bits = bits(word, first, end);
            rows.iter().all(|row| bits & !row[word as usize] == 0)
        })
    }

    /// Covers what lies inside a sphere for certain.
    pub(super) fn add(&mut self, grid: &Grid, silhouette: &InnerSilhouette) {
        dispatch!(self.level, simd => self.add_lanes(simd, grid, silhouette));
    }

    #[inline(always)]
    fn add_lanes<S: Simd>(&mut self, simd: S, grid: &Grid, silhouette: &InnerSilhouette) {
        /// In cells: above what their places are off by.
        const MARGIN: f64 = 1e-6;
        /// More than rounding moves places by, relatively.
        const ROUNDING: f64 = 1e-9;
        let zero = f64x8::splat(simd, 0.0);
        let cells = f64x8::splat(simd, f64::from(grid.cells));
        let (margin, middle) = (grid.margin.x + MARGIN, grid.middle);
        // Of cells that stand for their points one line is met, of others both edges.
        let edges = if middle > 0.0 { 0 } else { 1 };
        let (mut row, last) = silhouette.range.rows;
        while row <= last {
            let lines = f64x8::from_array(simd, LANE_NUMBERS) + (f64::from(row) + middle);
            let height = f64x8::splat(simd, grid.corner.y) - lines * grid.cell.y;
            let (low, high, is_met) = silhouette.along(simd, height);
            let low = (low - grid.corner.x) * grid.in_cells.x;
            let high = (high - grid.corner.x) * grid.in_cells.x;
            let size = (low.abs() + high.abs()) * ROUNDING + (margin - middle);
            let is_met = is_met & size.simd_lt(f64::INFINITY);
            let first = is_met.select((low + size).ceil().max(zero).min(cells), cells);
            let end = is_met.select((high - size).floor().max(zero).min(cells), zero);
            let (first, end): ([f64; LANES], [f64; LANES]) = (first.into(), end.into());
            // The silhouette is convex: what is inside at both ends of an upright line is inside.
            for line in 0..LANES - edges {
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
            row[word as usize] |= bits(word, first, end);
        }
    }
}

/// Bits of a word of a row from `first` up to, but without, `end`, which it reaches.
#[inline(always)]
fn bits(word: u32, first: u32, end: u32) -> u64 {
    let from = first.saturating_sub(word * u64::BITS);
    let to = (end - word * u64::BITS).min(u64::BITS);
    u64::MAX << from & u64::MAX >> (u64::BITS - to)
}
