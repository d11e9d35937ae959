//! What a view of very many spheres sees: block by block, from front to back, as far as anything is
//! open.

use std::cmp::Reverse;
use std::collections::BinaryHeap;

use glam::DVec3;
use rayon::iter::{IndexedParallelIterator, IntoParallelIterator, ParallelIterator};

use super::Points;
use super::coverage::{BLOCK, CellRange, Cover, Coverage, Grid};
use super::eight::Eye;
use super::frustum::InCamera;
use super::hierarchy::boxes::WIDTH;
use super::hierarchy::{Hierarchy, Node, is_sphere};
use crate::hit::ball::Ball;
use crate::model::sphere::Sphere;
use crate::model::view::View;
use crate::numeric::bits::set_bits;
use crate::picture::tile::Tile;

/// For every tile the spheres that may be seen in it, those that come nearest first.
#[derive(Clone, Debug)]
pub(super) struct Crowd {
    /// Blocks side by side.
    columns: u32,
    tile_side: u32,
    blocks: Vec<Block>,
}

/// The spheres of a block of pixels. Each tile has a list of places in the order in which they begin,
/// by what was known of that when they were found.
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
    eye: Eye,
    tile_side: u32,
    points: Points,
}

impl Crowd {
    /// The lists for tiles of this side, a divisor of that of a block.
    pub(super) fn new(
        spheres: &[Sphere],
        hierarchy: &Hierarchy,
        view: &View,
        exponent: i32,
        (tile_side, points): (u32, Points),
    ) -> Self {
        assert!(BLOCK.is_multiple_of(tile_side), "tiles fill blocks");
        let scale = libm::scalbn(1.0, -exponent);
        let search = Search {
            spheres,
            hierarchy,
            view,
            exponent,
            scale,
            eye: Eye::new(view, scale),
            tile_side,
            points,
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

    /// The memory that it takes, in bytes.
    pub(super) fn bytes(&self) -> usize {
        let of_block = |block: &Block| {
            let listed = block.starts.len() + block.places.len();
            size_of_val(&block.balls[..]) + listed * size_of::<u32>() + size_of::<Block>()
        };
        self.blocks.iter().map(of_block).sum()
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
/// [`GROUP`] for a level, a group of spheres, or with [`SPHERE`] a sphere by its place among those found.
type Waiting = Reverse<(u64, u32, u32)>;

const GROUP: u32 = u32::MAX - 1;
const SPHERE: u32 = u32::MAX;

/// What is open in a block.
#[derive(Default)]
struct Open {
    waiting: BinaryHeap<Waiting>,
    found: Vec<Found>,
}

/// A sphere that may be seen, as far as it is known without the sphere itself: in the world they are
/// far apart, and it takes long to get at one.
struct Found {
    index: u32,
    /// The bits of what it comes no nearer than.
    nearest: u64,
    range: CellRange,
    /// Of a sphere inside of it, in the camera's frame.
    center: DVec3,
    radius: f64,
}

impl Search<'_> {
    fn block(&self, col: u32, row: u32) -> Block {
        let grid = Grid::new(self.view, self.points, col, row);
        let mut coverage = Coverage::new(&grid, self.view.width - col, self.view.height - row);
        let mut open = Open::default();
        // What covers whatever begins behind its farthest point.
        let mut covers: Vec<Cover> = Vec::new();
        let mut pending: BinaryHeap<Reverse<(u64, u32)>> = BinaryHeap::new();
        // The places of those found.
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
            if has_grown && coverage.is_covered(grid.all()) {
                break;
            }
            if level == GROUP {
                self.open_group(index, nearest, &grid, &coverage, &mut open);
                continue;
            }
            if level != SPHERE {
                let node = Node { level, index };
                self.open(node, nearest, &grid, &coverage, &mut open);
                continue;
            }
            let found = &open.found[index as usize];
            let place = kept.len() as u32;
            let count = listed.len();
            self.list(found.range, place, (&grid, &coverage), &mut listed);
            if listed.len() == count {
                continue;
            }
            kept.push(index);
            if let Some(cover) = Cover::new(found.center, found.radius, found.range) {
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
        let kept = kept.iter().map(|&found| &open.found[found as usize]);
        // One after the other they would be waited for one by one.
        let copies = kept.clone().map(|found| self.spheres[found.index as usize]);
        let copies: Vec<Sphere> = copies.collect();
        let spheres = kept.clone().map(|found| found.index).zip(&copies);
        let mut balls = Ball::all(spheres, viewpoint, self.exponent);
        for (ball, found) in balls.iter_mut().zip(kept) {
            ball.nearest = of_rising_bits(found.nearest);
        }
        Block {
            balls,
            starts,
            places,
        }
    }

    /// Puts what a node holds among what waits, as far as it may be seen.
    fn open(&self, node: Node, nearest: u64, grid: &Grid, coverage: &Coverage, open: &mut Open) {
        let eight = self.eye.boxes(self.hierarchy.boxes(node), grid);
        for place in set_bits(eight.may) {
            if coverage.is_covered(eight.range(place)) {
                continue;
            }
            let begin = rising_bits(eight.begin[place]).max(nearest);
            let index = node.index * WIDTH as u32 + place as u32;
            let level = node.level.checked_sub(1).unwrap_or(GROUP);
            open.waiting.push(Reverse((begin, level, index)));
        }
    }

    /// Puts the spheres of a group among what waits, as far as they may be seen.
    fn open_group(
        &self,
        group: u32,
        nearest: u64,
        grid: &Grid,
        coverage: &Coverage,
        open: &mut Open,
    ) {
        /// What a sphere may be smaller by, relatively, to be taken for itself.
        const SMALLER: f64 = 1.0 / 256.0;
        let spheres = self.hierarchy.group(group);
        let eight = self.eye.spheres(spheres, grid);
        let indices = self.hierarchy.indices(group);
        for place in set_bits(eight.may) {
            let index = indices[place];
            if !is_sphere(index) || coverage.is_covered(eight.range(place)) {
                continue;
            }
            let (radius, excess) = (f64::from(spheres.radius[place]), spheres.excess(place));
            let found = if excess < SMALLER * radius {
                Found {
                    index,
                    nearest: rising_bits(eight.begin[place]),
                    range: eight.range(place),
                    center: eight.center(place),
                    radius: (radius - excess) * self.scale,
                }
            } else {
                let Some(found) = self.find(index, grid) else {
                    continue;
                };
                found
            };
            let nearest = found.nearest.max(nearest);
            let number = open.found.len() as u32;
            open.waiting.push(Reverse((nearest, SPHERE, number)));
            open.found.push(Found { nearest, ..found });
        }
    }

    /// A sphere that single precision says too little of, if it may be seen.
    #[cold]
    fn find(&self, index: u32, grid: &Grid) -> Option<Found> {
        let sphere = &self.spheres[index as usize];
        let offset = self.eye.offset(sphere.center());
        let radius = sphere.radius() * self.scale;
        let in_camera = InCamera::new(offset, radius, self.view);
        if in_camera.is_behind() {
            return None;
        }
        let range = match in_camera.outline() {
            Some((low, high)) => grid.range(low, high)?,
            None => grid.all(),
        };
        Some(Found {
            index,
            nearest: rising_bits(Ball::nearest(offset, radius)),
            range,
            center: self.eye.turned(offset),
            radius,
        })
    }

    /// Lists a sphere in the tiles in which some of its cells are open.
    fn list(
        &self,
        range: CellRange,
        place: u32,
        (grid, coverage): (&Grid, &Coverage),
        listed: &mut Vec<(u32, u32)>,
    ) {
        let tiles = BLOCK / self.tile_side;
        let side = grid.cells / tiles;
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

/// The number with such bits.
fn of_rising_bits(bits: u64) -> f64 {
    const SIGN: u64 = 1 << 63;
    f64::from_bits(if bits & SIGN == 0 { !bits } else { bits ^ SIGN })
}

/// Bits that rise with the number.
pub(super) fn rising_bits(value: f64) -> u64 {
    const SIGN: u64 = 1 << 63;
    let bits = value.to_bits();
    if bits & SIGN == 0 { bits | SIGN } else { !bits }
}
