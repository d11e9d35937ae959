//! The spheres that may be seen in a block of pixels, found from front to back as far as anything is
//! open.

use std::cmp::Reverse;
use std::collections::BinaryHeap;

use glam::DVec3;

use super::frustum::CameraSphere;
use super::grid::{BLOCK, CellRange, Grid, RayPoints};
use super::hierarchy::order::WIDTH;
use super::hierarchy::{Hierarchy, Node, is_sphere};
use super::mask::{CoverageMask, InnerSilhouette};
use super::screen_bounds::Projection;
use crate::hit::ball::Ball;
use crate::model::sphere::Sphere;
use crate::model::view::View;
use crate::numeric::bits::{of_rising_bits, rising_bits, set_bits};
use crate::picture::tile::Tile;

/// Tiles on a side of a block.
pub(super) const TILES: u32 = BLOCK / Tile::SIDE;
const _: () = assert!(BLOCK.is_multiple_of(Tile::SIDE));

/// The spheres of a block of pixels. Each tile has a list of places in the order in which they begin,
/// by what was known of that when they were found.
#[derive(Clone, Debug)]
pub(super) struct Block {
    /// Those of the first tile, those that the second one has besides, and so on: what is read
    /// together lies together.
    pub(super) balls: Vec<Ball>,
    /// The start of the list of each tile in `places`; one more for the end.
    pub(super) starts: Vec<u32>,
    pub(super) places: Vec<u32>,
}

/// The search for what a view sees of the spheres of a hierarchy.
#[derive(Clone, Copy)]
pub(super) struct BlockSearch<'a> {
    pub(super) view: &'a View,
    points: RayPoints,
    spheres: &'a [Sphere],
    hierarchy: &'a Hierarchy,
    /// Lengths of the world times 2 to the power of minus this are those of the balls.
    exponent: i32,
    /// Two to the power of minus that.
    scale: f64,
    projection: Projection,
}

/// Something that comes no nearer than the number in front, by its bits: a node or, with
/// [`GROUP`] for a level, a group of spheres, or with [`SPHERE`] a sphere by its place among those found.
type Waiting = Reverse<(u64, u32, u32)>;

const GROUP: u32 = u32::MAX - 1;
const SPHERE: u32 = u32::MAX;

/// The nodes and spheres that are open in a block.
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
    /// The center of a sphere inside of it, in the camera's frame.
    center: DVec3,
    radius: f64,
}

impl<'a> BlockSearch<'a> {
    /// The search in the view, where rays go through such points.
    pub(super) fn new(
        view: &'a View,
        points: RayPoints,
        spheres: &'a [Sphere],
        hierarchy: &'a Hierarchy,
        exponent: i32,
    ) -> Self {
        let scale = libm::scalbn(1.0, -exponent);
        Self {
            view,
            points,
            spheres,
            hierarchy,
            exponent,
            scale,
            projection: Projection::new(view, scale),
        }
    }

    /// The block that begins at a pixel.
    pub(super) fn block(&self, col: u32, row: u32) -> Block {
        let grid = Grid::new(self.view, self.points, col, row);
        let mut mask = CoverageMask::new(&grid, self.view.width - col, self.view.height - row);
        let mut open = Open::default();
        // Each covers whatever begins behind its farthest point.
        let mut silhouettes: Vec<InnerSilhouette> = Vec::new();
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
            while let Some(&Reverse((farthest, silhouette))) = pending.peek() {
                if farthest >= nearest {
                    break;
                }
                pending.pop();
                mask.add(&grid, &silhouettes[silhouette as usize]);
                has_grown = true;
            }
            // All that waits begins behind all that covers.
            if has_grown && mask.is_covered(grid.all()) {
                break;
            }
            if level == GROUP {
                self.open_group(index, nearest, &grid, &mask, &mut open);
                continue;
            }
            if level != SPHERE {
                let node = Node { level, index };
                self.open(node, nearest, &grid, &mask, &mut open);
                continue;
            }
            let found = &open.found[index as usize];
            let place = kept.len() as u32;
            let count = listed.len();
            self.list(found.range, place, (&grid, &mask), &mut listed);
            if listed.len() == count {
                continue;
            }
            kept.push(index);
            if let Some(silhouette) = InnerSilhouette::new(found.center, found.radius, found.range)
            {
                pending.push(Reverse((
                    rising_bits(silhouette.farthest()),
                    silhouettes.len() as u32,
                )));
                silhouettes.push(silhouette);
            }
        }
        self.gather(&open.found, &kept, &listed)
    }

    /// The block of the kept ones of what was found, listed by tile and place.
    fn gather(&self, found: &[Found], kept: &[u32], listed: &[(u32, u32)]) -> Block {
        let viewpoint = self.view.camera.position;
        let (starts, mut places) = sorted(listed);
        let kept = gathered(&mut places, kept);
        let kept = kept.iter().map(|&place| &found[place as usize]);
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
    fn open(&self, node: Node, nearest: u64, grid: &Grid, mask: &CoverageMask, open: &mut Open) {
        let bounds = self.projection.boxes(self.hierarchy.boxes(node), grid);
        for place in set_bits(bounds.may) {
            if mask.is_covered(bounds.range(place)) {
                continue;
            }
            let begin = rising_bits(bounds.begin[place]).max(nearest);
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
        mask: &CoverageMask,
        open: &mut Open,
    ) {
        /// A sphere that is smaller by no more than this, relatively, is taken for itself. Not tuned:
        /// smaller spheres hide less, and it takes long to get at the sphere itself.
        const SMALLER: f64 = 1.0 / 256.0;
        let spheres = &self.hierarchy.group(group, self.spheres);
        let bounds = self.projection.spheres(spheres, grid);
        let indices = self.hierarchy.indices(group);
        for place in set_bits(bounds.may) {
            let index = indices[place];
            if !is_sphere(index) || mask.is_covered(bounds.range(place)) {
                continue;
            }
            let (radius, excess) = (spheres.radius[place], spheres.excess(place));
            let found = if excess < SMALLER * radius {
                Found {
                    index,
                    nearest: rising_bits(bounds.begin[place]),
                    range: bounds.range(place),
                    center: bounds.center(place),
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
        let offset = self.projection.offset(sphere.center());
        let radius = sphere.radius() * self.scale;
        let in_camera = CameraSphere::new(offset, radius, self.view);
        if in_camera.is_behind() {
            return None;
        }
        let range = match in_camera.silhouette_box() {
            Some((low, high)) => grid.range(low, high)?,
            None => grid.all(),
        };
        Some(Found {
            index,
            nearest: rising_bits(Ball::nearest(offset, radius)),
            range,
            center: self.projection.turned(offset),
            radius,
        })
    }

    /// Lists a sphere in the tiles in which some of its cells are open.
    fn list(
        &self,
        range: CellRange,
        place: u32,
        (grid, mask): (&Grid, &CoverageMask),
        listed: &mut Vec<(u32, u32)>,
    ) {
        let side = grid.cells / TILES;
        for row in range.rows.0 / side..=range.rows.1 / side {
            for column in range.columns.0 / side..=range.columns.1 / side {
                let tile = CellRange {
                    columns: (column * side, (column + 1) * side - 1),
                    rows: (row * side, (row + 1) * side - 1),
                };
                if range.and(tile).is_some_and(|cells| !mask.is_covered(cells)) {
                    listed.push((row * TILES + column, place));
                }
            }
        }
    }
}

/// Places tile by tile, in their order, and the start of each tile's.
fn sorted(listed: &[(u32, u32)]) -> (Vec<u32>, Vec<u32>) {
    let mut starts = vec![0_u32; (TILES * TILES) as usize + 2];
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
