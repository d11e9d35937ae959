//! What a view of very many spheres sees: block by block, from front to back, as far as anything is
//! open.

use std::cmp::Reverse;
use std::collections::BinaryHeap;

use glam::{DMat3, DVec2, DVec3};
use rayon::iter::{IndexedParallelIterator, IntoParallelIterator, ParallelIterator};

use super::coverage::{BLOCK, CELLS, CellRange, Cover, Coverage, Grid};
use super::frustum::InCamera;
use crate::hierarchy::{Boxes, Child, Hierarchy, Node, WIDTH, is_sphere};
use crate::sphere::Ball;
use crate::{Sphere, Tile, View};

/// For every tile the spheres that may be seen in it, those that come nearest first.
#[derive(Clone, Debug)]
pub(super) struct Crowd {
    /// Blocks side by side.
    columns: u32,
    tile_side: u32,
    blocks: Vec<Block>,
}

/// The spheres of a block of pixels. Each tile has a list of places in the order in which they begin;
/// odd balls, of which that is not known, come in the order of boxes around them.
#[derive(Clone, Debug)]
struct Block {
    /// Those of the first tile, those that the second one has besides, and so on: what is read
    /// together lies together.
    balls: Vec<Ball>,
    /// Where the list of each tile starts in `places`; one more for the end.
    starts: Vec<u32>,
    places: Vec<u32>,
}

/// What the search in a block needs to know.
#[derive(Clone, Copy)]
struct Search<'a> {
    spheres: &'a [Sphere],
    hierarchy: &'a Hierarchy,
    view: &'a View,
    /// Lengths of the world times 2 to the power of minus this are those of the balls.
    exponent: i32,
    scale: f64,
    camera_from_world: DMat3,
    tile_side: u32,
}

impl Crowd {
    /// The lists for tiles of this side, a divisor of that of a block.
    pub(super) fn new(
        spheres: &[Sphere],
        hierarchy: &Hierarchy,
        view: &View,
        exponent: i32,
        tile_side: u32,
    ) -> Self {
        assert!(BLOCK.is_multiple_of(tile_side), "tiles fill blocks");
        let search = Search {
            spheres,
            hierarchy,
            view,
            exponent,
            scale: libm::scalbn(1.0, -exponent),
            camera_from_world: view.camera.world_from_camera.transpose(),
            tile_side,
        };
        let (columns, rows) = (view.width.div_ceil(BLOCK), view.height.div_ceil(BLOCK));
        let blocks = (0..columns as usize * rows as usize).into_par_iter();
        let at = |index: usize| (index % columns as usize, index / columns as usize);
        Self {
            columns,
            tile_side,
            blocks: blocks
                .with_max_len(1)
                .map(|index| {
                    let (column, row) = at(index);
                    search.block(column as u32 * BLOCK, row as u32 * BLOCK)
                })
                .collect(),
        }
    }

    /// The balls of a tile's surroundings, and the places of those that may be seen in it, those that
    /// come nearest first.
    #[inline]
    pub(super) fn balls(&self, tile: Tile) -> (&[Ball], &[u32]) {
        let block = &self.blocks[(tile.row / BLOCK * self.columns + tile.col / BLOCK) as usize];
        let (column, row) = (tile.col % BLOCK, tile.row % BLOCK);
        let tiles = BLOCK / self.tile_side;
        let index = (row / self.tile_side * tiles + column / self.tile_side) as usize;
        let (start, end) = (
            block.starts[index] as usize,
            block.starts[index + 1] as usize,
        );
        (&block.balls, &block.places[start..end])
    }
}

/// Something that comes no nearer than the number in front, by its bits: a node or, with
/// [`SPHERE`] for a level, a sphere by its place among the copies.
type Waiting = Reverse<(u64, u32, u32)>;

const SPHERE: u32 = u32::MAX;

/// What is open in a block. Spheres are copied as they are found: in the world they are far apart.
#[derive(Default)]
struct Open {
    waiting: BinaryHeap<Waiting>,
    copies: Vec<(u32, Sphere)>,
}

impl Search<'_> {
    fn block(&self, col: u32, row: u32) -> Block {
        let grid = Grid::new(self.view, col, row);
        let (width, height) = (self.view.width - col, self.view.height - row);
        let mut coverage = Coverage::new(width.min(BLOCK), height.min(BLOCK));
        let mut open = Open::default();
        // What covers whatever begins behind its farthest point.
        let mut covers: Vec<Cover> = Vec::new();
        let mut pending: BinaryHeap<Reverse<(u64, u32)>> = BinaryHeap::new();
        // The places of copies.
        let mut kept: Vec<u32> = Vec::new();
        // Tile and place.
        let mut listed: Vec<(u32, u32)> = Vec::new();
        if let Some(root) = self.hierarchy.root() {
            open.waiting.push(Reverse((0, root.level, root.index)));
        }
        while let Some(Reverse((nearest, level, index))) = open.waiting.pop() {
            let mut has_grown = false;
            while let Some(&Reverse((farthest, cover))) = pending.peek() {
                if farthest >= nearest {
                    break;
                }
                pending.pop();
                coverage.add(&grid, &covers[cover as usize]);
                has_grown = true;
            }
            // All that waits begins behind all that covers.
            if has_grown && coverage.is_covered(CellRange::ALL) {
                break;
            }
            if level != SPHERE {
                let node = Node { level, index };
                self.open(node, nearest, &grid, &coverage, &mut open);
                continue;
            }
            let sphere = &open.copies[index as usize].1;
            let Some(range) = self.range(sphere, &grid) else {
                continue;
            };
            let place = kept.len() as u32;
            let count = listed.len();
            self.list(range, place, &coverage, &mut listed);
            if listed.len() == count {
                continue;
            }
            kept.push(index);
            let center = self.camera_from_world * self.offset(sphere);
            if let Some(cover) = Cover::new(center, sphere.radius() * self.scale, range) {
                pending.push(Reverse((
                    rising_bits(cover.farthest()),
                    covers.len() as u32,
                )));
                covers.push(cover);
            }
        }
        let viewpoint = self.view.camera.position;
        let (starts, mut places) = self.sorted(&listed);
        let kept = gathered(&mut places, &kept);
        let kept = kept.iter().map(|&copy| {
            let (index, sphere) = &open.copies[copy as usize];
            (*index, sphere)
        });
        Block {
            balls: Ball::all(kept, viewpoint, self.exponent),
            starts,
            places,
        }
    }

    /// From the eye to the center, in the lengths of the balls.
    fn offset(&self, sphere: &Sphere) -> DVec3 {
        (sphere.center() - self.view.camera.position) * self.scale
    }

    /// Puts what a node holds among what waits, as far as it may be seen.
    fn open(&self, node: Node, nearest: u64, grid: &Grid, coverage: &Coverage, open: &mut Open) {
        let boxes = self.hierarchy.boxes(node);
        for place in 0..WIDTH {
            let Some((begin, range)) = self.see(boxes, place, grid) else {
                continue;
            };
            if coverage.is_covered(range) {
                continue;
            }
            match self.hierarchy.child(node, place) {
                Child::Node(child) => {
                    let begin = begin.max(nearest);
                    open.waiting
                        .push(Reverse((begin, child.level, child.index)));
                }
                Child::Spheres(indices) => {
                    let first = open.copies.len();
                    // One after the other they would be waited for one by one.
                    for &index in indices.iter().filter(|&&index| is_sphere(index)) {
                        open.copies.push((index, self.spheres[index as usize]));
                    }
                    for (copy, (_, sphere)) in (first as u32..).zip(&open.copies[first..]) {
                        let radius = sphere.radius() * self.scale;
                        let begin = rising_bits(Ball::nearest(self.offset(sphere), radius));
                        open.waiting.push(Reverse((begin, SPHERE, copy)));
                    }
                }
            }
        }
    }

    /// Where a box begins, and which cells it may be seen in.
    fn see(&self, boxes: &Boxes, place: usize, grid: &Grid) -> Option<(u64, CellRange)> {
        /// More than rounding moves the box by, and the distances to the spheres in it. (Sums of
        /// neighbors in single precision are exact: the middle is rounded where the box is wide.)
        const MARGIN: f64 = 1e-9;
        let low = DVec3::from_array(boxes.low.map(|axis| f64::from(axis[place])));
        let high = DVec3::from_array(boxes.high.map(|axis| f64::from(axis[place])));
        if low.x > high.x {
            return None;
        }
        let middle = 0.5 * (low + high) - self.view.camera.position;
        let center = self.camera_from_world * (middle * self.scale);
        let half = 0.5 * (high - low) * self.scale;
        let turned = self.camera_from_world;
        let half = turned.x_axis.abs() * half.x
            + turned.y_axis.abs() * half.y
            + turned.z_axis.abs() * half.z;
        let size = center.abs().element_sum() + half.element_sum();
        let half = half + MARGIN * size;
        if !size.is_finite() {
            // Whatever single precision cannot hold may be anywhere.
            return Some((0, CellRange::ALL));
        }
        let beyond = (center.abs() - half).max(DVec3::ZERO);
        let begin = rising_bits(beyond.length() - MARGIN * size);
        let (low, high) = (center - half, center + half);
        if high.z < 0.0 {
            return None;
        }
        if low.z <= MARGIN * size {
            return Some((begin, CellRange::ALL));
        }
        let least = |x: f64| x / if x < 0.0 { low.z } else { high.z };
        let most = |x: f64| x / if x > 0.0 { low.z } else { high.z };
        let range = grid.range(
            DVec2::new(least(low.x), least(low.y)),
            DVec2::new(most(high.x), most(high.y)),
        )?;
        Some((begin, range))
    }

    /// The cells that a sphere may be seen in.
    fn range(&self, sphere: &Sphere, grid: &Grid) -> Option<CellRange> {
        let radius = sphere.radius() * self.scale;
        let in_camera = InCamera::new(self.offset(sphere), radius, self.view);
        if in_camera.is_behind() {
            return None;
        }
        match in_camera.outline() {
            Some((low, high)) => grid.range(low, high),
            None => Some(CellRange::ALL),
        }
    }

    /// Lists a sphere in the tiles in which some of its cells are open.
    fn list(
        &self,
        range: CellRange,
        place: u32,
        coverage: &Coverage,
        listed: &mut Vec<(u32, u32)>,
    ) {
        let tiles = BLOCK / self.tile_side;
        let side = CELLS / tiles;
        for row in range.rows.0 / side..=range.rows.1 / side {
            for column in range.columns.0 / side..=range.columns.1 / side {
                let tile = CellRange {
                    columns: (column * side, (column + 1) * side - 1),
                    rows: (row * side, (row + 1) * side - 1),
                };
                if range
                    .and(tile)
                    .is_some_and(|cells| !coverage.is_covered(cells))
                {
                    listed.push((row * tiles + column, place));
                }
            }
        }
    }

    /// Places tile by tile, in their order, and where each tile's start.
    fn sorted(&self, listed: &[(u32, u32)]) -> (Vec<u32>, Vec<u32>) {
        let tiles = BLOCK / self.tile_side;
        let mut starts = vec![0_u32; (tiles * tiles) as usize + 2];
        for &(tile, _) in listed {
            starts[tile as usize + 2] += 1;
        }
        let mut sum = 0;
        for start in &mut starts {
            sum += *start;
            *start = sum;
        }
        let mut places = vec![0; listed.len()];
        for &(tile, place) in listed {
            let next = &mut starts[tile as usize + 1];
            places[*next as usize] = place;
            *next += 1;
        }
        (starts, places)
    }
}

/// Numbers places anew, in the order in which they are first listed; what was at the old ones, in that
/// order.
fn gathered(places: &mut [u32], old: &[u32]) -> Vec<u32> {
    const NONE: u32 = u32::MAX;
    let mut renumbered = vec![NONE; old.len()];
    let mut new = Vec::with_capacity(old.len());
    for place in places {
        let number = &mut renumbered[*place as usize];
        if *number == NONE {
            *number = new.len() as u32;
            new.push(old[*place as usize]);
        }
        *place = *number;
    }
    new
}

/// Bits that rise with the number.
pub(super) fn rising_bits(value: f64) -> u64 {
    const SIGN: u64 = 1 << 63;
    let bits = value.to_bits();
    if bits & SIGN == 0 { bits | SIGN } else { !bits }
}
