//! The rays of a tile, eight at a time.

use fearless_simd::Simd;
use glam::{DVec2, DVec3};

use super::bundle::{Bundle, Cone, Lines};
use crate::model::camera::Projection;
use crate::model::ray::Ray;
use crate::model::roughness::noise::{hash, spread};
use crate::model::view::View;
use crate::numeric::lanes::{LANE_NUMBERS, LANES, f64x8};
use crate::numeric::vectors::Vectors;
use crate::picture::tile::Tile;

/// Far above all rounding errors, which are of some units in the last place.
const WIDER: f64 = 1.0 + 1e-9;

/// Sums of squares above this are far from losing digits to underflow: directions are moderate, so
/// that only tiny ones are not.
pub(super) const LEAST_SQUARE: f64 = 1e-60;

/// The places of the samples of a view: those of [`View::cell_center`] to the bit.
#[derive(Clone, Debug)]
pub(super) struct Rays {
    view: View,
    /// Samples on a side of a pixel.
    side: u32,
    /// Half the width and half the height of a cell.
    half_cell: DVec2,
    /// Lengths there for each at the distance of 1, or, through a parallel lens, at any distance.
    magnification: f64,
    /// Directions are divided by two to the power of this, which makes them moderate.
    exponent: i32,
    scale: f64,
    /// Columns and rows on a length of 1 at the distance of 1, or at any.
    pixels_on_unit: DVec2,
    /// Columns and rows in the lens's shift.
    shift: DVec2,
    /// The place of the first sample in a pixel.
    first: f64,
    /// If samples are scattered, the number of strata on a side of a pixel.
    strata: Option<u32>,
}

/// Cells on a side of a pixel, of which a scattered sample takes one at random: so many that the centers of cells are
/// as good as random places.
const FINE: u32 = 1 << 20;

/// The samples that eight rays are.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Spread {
    /// One in each of eight pixels of a row, in the same cell of all of them.
    Pixels,
    /// Those of [`BLOCK_COLS`] × [`BLOCK_ROWS`] cells of one pixel, from the cell on; beyond the last cells these once more.
    Block,
    /// Two random ones in each of four strata of one pixel. The cell is one of the squares of 2 × 2 strata.
    Strata,
}

/// The columns and rows of the cells whose samples are taken together, if these are in one pixel.
pub(super) const BLOCK_COLS: u32 = 4;
pub(super) const BLOCK_ROWS: u32 = LANES as u32 / BLOCK_COLS;

/// The number of samples on a side of a pixel from which on eight of one pixel may be taken together, and the shadows on
/// whole balls are looked up. With fewer, most balls have too few samples in a tile for that: with one, a million balls on
/// 2,400 × 2,400 pixels took a sixth more time.
const LEAST_OF_BLOCKS: u32 = 4;

/// The columns and rows of these cells, from the first.
const BLOCK_STEPS: [[f64; LANES]; 2] = [
    [0.0, 1.0, 2.0, 3.0, 0.0, 1.0, 2.0, 3.0],
    [0.0, 0.0, 0.0, 0.0, 1.0, 1.0, 1.0, 1.0],
];

/// The place of eight samples: the first pixel, and the first cell in it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Place {
    pub(super) col: u32,
    pub(super) row: u32,
    pub(super) cell_col: u32,
    pub(super) cell_row: u32,
    pub(super) spread: Spread,
}

impl Place {
    /// The column of the pixel that a ray belongs to.
    pub(super) fn col_of(&self, lane: usize) -> u32 {
        match self.spread {
            Spread::Pixels => self.col + lane as u32,
            Spread::Block | Spread::Strata => self.col,
        }
    }

    /// The number of different rays among eight, in a tile with this number of columns.
    pub(super) fn lanes(&self, width: u32) -> usize {
        match self.spread {
            Spread::Pixels => (width as usize).min(LANES),
            Spread::Block | Spread::Strata => LANES,
        }
    }
}

impl Rays {
    pub(super) fn new(view: &View, side: u32) -> Self {
        let width = view.lens.width / (f64::from(view.width) * f64::from(side));
        let cell = DVec2::new(width, width / view.lens.pixel_aspect);
        let magnification = view.magnification();
        let size = DVec2::new(f64::from(view.width), f64::from(view.height));
        let edges = 0.5 * view.pixel_size() * size + view.lens.shift.abs();
        let exponent = match view.lens.projection() {
            Projection::Central => libm::ilogb(edges.max_element().max(magnification)),
            // Directions are unit vectors.
            Projection::Parallel => 0,
        };
        let exponent = exponent.clamp(-1000, 1000);
        Self {
            view: *view,
            side,
            half_cell: 0.5 * cell,
            magnification,
            exponent,
            scale: libm::scalbn(1.0, -exponent),
            pixels_on_unit: magnification / view.pixel_size(),
            shift: view.lens.shift / view.pixel_size(),
            first: 0.5 / f64::from(side),
            strata: None,
        }
    }

    /// The same for random samples in `side` × `side` strata of a pixel, a multiple of 2.
    pub(super) fn scattered(&self, side: u32) -> Self {
        Self {
            strata: Some(side),
            ..Self::new(&self.view, FINE)
        }
    }

    /// True if pixels have so many samples that eight of one pixel may be taken together.
    pub(super) fn are_dense(&self) -> bool {
        self.side >= LEAST_OF_BLOCKS
    }

    /// The exponent of the power of two that directions were divided by.
    pub(super) fn exponent(&self) -> i32 {
        self.exponent
    }

    /// The number of samples side by side on a length of 1 at the distance of 1, or at any: the geometric mean of those
    /// along both axes.
    pub(super) fn cells_on_unit(&self) -> f64 {
        let across = self.magnification / (2.0 * self.half_cell.x);
        let cells = across * self.view.lens.pixel_aspect.sqrt();
        match self.strata {
            Some(side) => cells * f64::from(side) / f64::from(FINE),
            None => cells,
        }
    }

    /// The longer side of a tile at the distance of 1, or at any.
    pub(super) fn tile_side(&self) -> f64 {
        f64::from(Tile::SIDE) / self.pixels_on_unit.min_element()
    }

    /// The places on the retina, to the right, of a sample of eight pixels; pixels after the first
    /// `width` repeat the last of them.
    #[inline(always)]
    pub(super) fn across<S: Simd>(&self, simd: S, place: Place, width: u32) -> f64x8<S> {
        let steps = f64x8::from_array(simd, LANE_NUMBERS);
        let last = f64x8::splat(simd, f64::from(width - 1));
        let steps = steps.simd_lt(last).select(steps, last);
        let first = self.twice(place.col, place.cell_col, self.view.width);
        let across = steps * (2.0 * f64::from(self.side)) + first;
        across * self.half_cell.x + self.view.lens.shift.x
    }

    /// Twice the distance of a cell from the middle, in cells: whole numbers, far below 2⁵³.
    #[inline(always)]
    fn twice(&self, pixel: u32, cell: u32, pixels: u32) -> f64 {
        let index = i64::from(pixel) * i64::from(self.side) + i64::from(cell);
        (2 * index + 1 - i64::from(self.side) * i64::from(pixels)) as f64
    }

    /// The place on the retina, upward, of a sample.
    #[inline(always)]
    pub(super) fn upward(&self, place: Place) -> f64 {
        let twice = self.twice(place.row, place.cell_row, self.view.height);
        -self.half_cell.y * twice + self.view.lens.shift.y
    }

    /// The distance of the retina; of a parallel lens its lengths for each of the world.
    pub(super) fn magnification(&self) -> f64 {
        self.magnification
    }

    pub(super) fn viewpoint(&self) -> DVec3 {
        self.view.camera.position
    }

    pub(super) fn projection(&self) -> Projection {
        self.view.lens.projection()
    }

    /// The directions of a sample in eight pixels that lie so far to the right, divided by that
    /// power.
    #[inline(always)]
    pub(super) fn directions<S: Simd>(&self, u: f64x8<S>, place: Place) -> Vectors<S> {
        let v = self.upward(place);
        let axes = &self.view.camera.world_from_camera;
        let (up, forward) = (axes.y_axis * v, axes.z_axis * self.magnification);
        Vectors {
            x: (u * axes.x_axis.x + up.x + forward.x) * self.scale,
            y: (u * axes.x_axis.y + up.y + forward.y) * self.scale,
            z: (u * axes.x_axis.z + up.z + forward.z) * self.scale,
        }
    }

    /// The directions of eight samples of one pixel, divided by that power.
    #[inline(always)]
    pub(super) fn directions_in_pixel<S: Simd>(&self, simd: S, place: Place) -> Vectors<S> {
        let [u, v] = match place.spread {
            Spread::Block => self.twice_in_block(simd, place),
            Spread::Pixels | Spread::Strata => {
                let [u, v] = self.twice_in_pixel(place);
                [f64x8::from_array(simd, u), f64x8::from_array(simd, v)]
            }
        };
        let shift = self.view.lens.shift;
        let u = u * self.half_cell.x + shift.x;
        let v = v * -self.half_cell.y + shift.y;
        let axes = &self.view.camera.world_from_camera;
        let forward = axes.z_axis * self.magnification;
        Vectors {
            x: (u * axes.x_axis.x + v * axes.y_axis.x + forward.x) * self.scale,
            y: (u * axes.x_axis.y + v * axes.y_axis.y + forward.y) * self.scale,
            z: (u * axes.x_axis.z + v * axes.y_axis.z + forward.z) * self.scale,
        }
    }

    /// The same as [`Self::twice_in_pixel`] for a block of cells.
    #[inline(always)]
    fn twice_in_block<S: Simd>(&self, simd: S, place: Place) -> [f64x8<S>; 2] {
        let cols = f64x8::from_array(simd, BLOCK_STEPS[0]);
        let rows = f64x8::from_array(simd, BLOCK_STEPS[1]);
        let last_col = f64::from(self.side - 1 - place.cell_col);
        let last_row = f64::from(self.side - 1 - place.cell_row);
        let first_col = self.twice(place.col, place.cell_col, self.view.width);
        let first_row = self.twice(place.row, place.cell_row, self.view.height);
        [
            cols.min(f64x8::splat(simd, last_col)) * 2.0 + first_col,
            rows.min(f64x8::splat(simd, last_row)) * 2.0 + first_row,
        ]
    }

    /// Twice the distances, in cells, of eight samples of one pixel from the middle, to the right and down.
    #[inline(never)]
    fn twice_in_pixel(&self, place: Place) -> [[f64; LANES]; 2] {
        let (mut u, mut v) = ([0.0; LANES], [0.0; LANES]);
        for lane in 0..LANES {
            let [col, row] = self.cell_of(place, lane);
            u[lane] = self.twice(place.col, col, self.view.width);
            v[lane] = self.twice(place.row, row, self.view.height);
        }
        [u, v]
    }

    /// The column and row, in its pixel, of the cell of a sample.
    fn cell_of(&self, place: Place, lane: usize) -> [u32; 2] {
        let lane = lane as u32;
        match (place.spread, self.strata) {
            (Spread::Block, _) => [
                (place.cell_col + lane % BLOCK_COLS).min(self.side - 1),
                (place.cell_row + lane / BLOCK_COLS).min(self.side - 1),
            ],
            (Spread::Strata, Some(strata)) => cell_of_stratum(place, strata, lane),
            _ => [place.cell_col, place.cell_row],
        }
    }

    /// The ray of one of the eight samples.
    pub(super) fn ray(&self, place: Place, lane: usize) -> Ray {
        let cell =
            |pixel: u32, cell: u32| u64::from(pixel) * u64::from(self.side) + u64::from(cell);
        let [cell_col, cell_row] = self.cell_of(place, lane);
        let center = self.view.cell_center(
            cell(place.col_of(lane), cell_col),
            cell(place.row, cell_row),
            self.side,
        );
        self.view.ray(center)
    }

    /// The bounds of all rays of a tile.
    pub(super) fn bundle(&self, tile: Tile) -> Bundle {
        if self.projection() == Projection::Parallel {
            return Bundle {
                projection: Projection::Parallel,
                cone: None,
                rows: self.rows(tile),
                columns: self.columns(tile),
                shortest: 1.0,
                longest: 1.0,
            };
        }
        let pixel = self.view.pixel_size();
        let middle = |first: u32, count: u32, pixels: u32| {
            f64::from(first) + 0.5 * (f64::from(count) - f64::from(pixels))
        };
        let center = DVec3::new(
            middle(tile.col, tile.width, self.view.width) * pixel.x + self.view.lens.shift.x,
            -middle(tile.row, tile.height, self.view.height) * pixel.y + self.view.lens.shift.y,
            self.magnification,
        ) * self.scale;
        let half = DVec2::new(f64::from(tile.width), f64::from(tile.height)) * (0.5 * pixel);
        let half = half * self.scale;
        let (center_length, reach) = (center.length(), half.length());
        let (shortest, longest) = (center_length - reach, center_length + reach);
        Bundle {
            projection: Projection::Central,
            cone: self.cone(center, center_length, reach),
            rows: self.rows(tile),
            columns: self.columns(tile),
            shortest: shortest.max(center.z) * (1.0 / WIDER),
            longest: longest * WIDER,
        }
    }

    /// The rows of a tile.
    fn rows(&self, tile: Tile) -> Lines {
        let axes = &self.view.camera.world_from_camera;
        let middle = 0.5 * f64::from(self.view.height) - f64::from(tile.row);
        Lines {
            up: axes.y_axis,
            forward: axes.z_axis,
            on_unit: self.pixels_on_unit.y,
            origin: middle + self.shift.y,
            size: f64::from(self.view.height) + self.shift.y.abs(),
            first: self.first,
            last: 1.0 - self.first,
            count: tile.height,
        }
    }

    /// The columns of a tile.
    fn columns(&self, tile: Tile) -> Lines {
        let axes = &self.view.camera.world_from_camera;
        let middle = 0.5 * f64::from(self.view.width) - f64::from(tile.col);
        Lines {
            up: -axes.x_axis,
            forward: axes.z_axis,
            on_unit: self.pixels_on_unit.x,
            origin: middle - self.shift.x,
            size: f64::from(self.view.width) + self.shift.x.abs(),
            first: self.first,
            last: 1.0 - self.first,
            count: tile.width,
        }
    }

    /// A circular cone around the rays through what is no farther than `reach` from a point in camera
    /// axes, whose length is given.
    ///
    /// No point of a ball is seen from outside at a larger angle than that whose sine is the radius over
    /// the center's distance.
    fn cone(&self, center: DVec3, center_length: f64, reach: f64) -> Option<Cone> {
        /// Wider cones hold so much beside the tile that they leave out little. Not tuned.
        const WIDEST_SINE: f64 = 0.7;
        let inverse = 1.0 / center_length;
        let sine = reach * inverse * WIDER;
        let is_sane = sine < WIDEST_SINE && center_length * center_length > LEAST_SQUARE;
        is_sane.then(|| Cone {
            axis: self.view.camera.world_from_camera * (center * inverse),
            sine,
            cosine: ((1.0 - sine) * (1.0 + sine)).sqrt(),
        })
    }
}

/// The cell of a random sample: one of two in each of four strata of a pixel, which has this number of strata on a side.
fn cell_of_stratum(place: Place, side: u32, lane: u32) -> [u32; 2] {
    let stratum = [
        2 * place.cell_col + (lane & 1),
        2 * place.cell_row + (lane >> 1 & 1),
    ];
    // Both samples of a stratum have numbers of their own, in any division of the pixel.
    let pixel = hash(
        u64::from(place.col) << 32 | u64::from(place.row),
        u64::from(side),
    );
    let name = u64::from(stratum[0]) << 32 | u64::from(stratum[1]) << 1;
    let [x, y, _] = spread(hash(pixel, name | u64::from(lane >> 2)));
    let size = f64::from(FINE) / f64::from(side);
    let cell = |stratum: u32, offset: f64| {
        let place = (f64::from(stratum) + 0.5 + 0.5 * offset) * size;
        (place as u32).min(FINE - 1)
    };
    [cell(stratum[0], x), cell(stratum[1], y)]
}
