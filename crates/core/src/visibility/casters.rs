//! The spheres that may keep a light from a point.
//!
//! Seen from a directional light every sphere is a disc. Grids over the plane across the light,
//! one for each power of two that discs have as their size, list for each cell the discs that
//! reach into it. A disc is in nine cells at most, whatever the others are like and wherever they
//! lie: a floor, or a speck far away, costs nothing.

use std::collections::HashMap;
use std::hash::{BuildHasherDefault, Hasher};

use glam::{DVec2, DVec3};

use crate::Sphere;
use crate::rounding::UNIT_ROUNDOFF;

/// Which discs a point of the plane may lie in.
#[derive(Clone, Debug)]
pub(super) struct Casters {
    /// The coordinates of the plane.
    right: DVec3,
    up: DVec3,
    /// Unit vector toward the light.
    toward: DVec3,
    grids: Vec<Grid>,
    /// Discs whose size or place is not finite.
    everywhere: Vec<u32>,
}

/// The discs of about one size.
#[derive(Clone, Debug)]
struct Grid {
    /// Side of a cell, a power of two: at least the radius of these discs.
    side: f64,
    /// Where the list of each cell starts and ends in `indices`.
    cells: HashMap<Cell, (u32, u32), BuildHasherDefault<CellHasher>>,
    indices: Vec<u32>,
    /// All of the discs, each once.
    all: Vec<u32>,
}

/// Column and row.
type Cell = (i64, i64);

impl Casters {
    /// The discs of the spheres across a light in the unit direction `toward`.
    pub(super) fn new(spheres: &[Sphere], toward: DVec3) -> Self {
        let (right, up) = toward.any_orthonormal_pair();
        let mut casters = Self {
            right,
            up,
            toward,
            grids: Vec::new(),
            everywhere: Vec::new(),
        };
        let mut by_size: HashMap<i32, Vec<(u32, DVec2, f64)>> = HashMap::new();
        for (index, sphere) in spheres.iter().enumerate() {
            let center = casters.project(sphere.center());
            let radius = sphere.radius() + slack(sphere.center(), sphere.radius());
            if center.is_finite() && radius.is_finite() {
                // The exponent of the power of two above the radius.
                let size = libm::ilogb(radius) + 1;
                by_size
                    .entry(size)
                    .or_default()
                    .push((index as u32, center, radius));
            } else {
                casters.everywhere.push(index as u32);
            }
        }
        casters.grids = by_size
            .iter()
            .map(|(size, discs)| Grid::new(*size, discs))
            .collect();
        // Large discs first: they are few, and hide much.
        casters.grids.sort_by(|a, b| b.side.total_cmp(&a.side));
        casters
    }

    /// Whether something holds for any sphere in whose disc a point may lie that is known up to
    /// a distance of `error`; it is asked for some other spheres too, and for some twice.
    pub(super) fn any(
        &self,
        point: DVec3,
        error: f64,
        mut holds: impl FnMut(usize) -> bool,
    ) -> bool {
        let center = self.project(point);
        let around = DVec2::splat(error + slack(point, 0.0));
        let (low, high) = (center - around, center + around);
        let mut holds = |index: &u32| holds(*index as usize);
        self.everywhere.iter().any(&mut holds)
            || self
                .grids
                .iter()
                .any(|grid| grid.near(low, high).any(|list| list.iter().any(&mut holds)))
    }

    /// Appends the indices of all spheres whose disc may reach into the box of some points, made
    /// larger by `around`; each once.
    pub(super) fn within(&self, points: &[DVec3], around: f64, indices: &mut Vec<usize>) {
        let (mut low, mut high) = (DVec2::INFINITY, DVec2::NEG_INFINITY);
        for &point in points {
            let (center, around) = (self.project(point), around + slack(point, 0.0));
            (low, high) = (low.min(center - around), high.max(center + around));
        }
        indices.extend(self.everywhere.iter().map(|&index| index as usize));
        for grid in &self.grids {
            indices.extend(grid.near(low, high).flatten().map(|&index| index as usize));
        }
        indices.sort_unstable();
        indices.dedup();
    }

    /// The axes of the plane.
    pub(super) fn axes(&self) -> (DVec3, DVec3) {
        (self.right, self.up)
    }

    /// How far toward the light a point lies.
    pub(super) fn height(&self, point: DVec3) -> f64 {
        point.dot(self.toward)
    }

    pub(super) fn project(&self, point: DVec3) -> DVec2 {
        DVec2::new(point.dot(self.right), point.dot(self.up))
    }
}

impl Grid {
    fn new(size: i32, discs: &[(u32, DVec2, f64)]) -> Self {
        let side = libm::scalbn(1.0, size);
        let mut listed: Vec<(Cell, u32)> = Vec::with_capacity(4 * discs.len());
        for &(index, center, radius) in discs {
            let (first, last) = (cell(center - radius, side), cell(center + radius, side));
            let rows = first.1..=last.1;
            listed.extend(
                rows.flat_map(|row| (first.0..=last.0).map(move |col| ((col, row), index))),
            );
        }
        listed.sort_unstable();
        let mut cells = HashMap::default();
        for (place, (cell, _)) in listed.iter().enumerate() {
            let place = place as u32;
            cells.entry(*cell).or_insert((place, place)).1 = place + 1;
        }
        Self {
            side,
            cells,
            indices: listed.into_iter().map(|(_, index)| index).collect(),
            all: discs.iter().map(|disc| disc.0).collect(),
        }
    }

    /// The lists of the cells that a box reaches into, or of all discs where these are many.
    fn near(&self, low: DVec2, high: DVec2) -> impl Iterator<Item = &[u32]> {
        /// More take longer than to ask all discs of their size, unless these are many more.
        const MOST_CELLS: usize = 9;
        const DISCS_PER_CELL: usize = 4;
        let most_cells = MOST_CELLS.max(self.all.len() / DISCS_PER_CELL);
        let (first, last) = (cell(low, self.side), cell(high, self.side));
        let columns = last.0.saturating_sub(first.0).saturating_add(1);
        let rows = last.1.saturating_sub(first.1).saturating_add(1);
        let is_small = columns.saturating_mul(rows) <= most_cells as i64;
        let (last_row, all) = if is_small {
            (last.1, None)
        } else {
            (i64::MIN, Some(&self.all[..]))
        };
        let cells =
            (first.1..=last_row).flat_map(move |row| (first.0..=last.0).map(move |col| (col, row)));
        let lists = cells.filter_map(|cell| {
            let &(start, end) = self.cells.get(&cell)?;
            Some(&self.indices[start as usize..end as usize])
        });
        all.into_iter().chain(lists)
    }
}

/// The cell of a place. The cast saturates: what lies too far out shares its cells, which lists
/// more discs there, and none less.
fn cell(place: DVec2, side: f64) -> Cell {
    let cell = (place / side).floor();
    (cell.x as i64, cell.y as i64)
}

/// More than rounding can move the projection of a sphere's center, or of a point.
///
/// With u the unit roundoff and M = |c| + r: the projection is off by 4u √3 M; the light and the
/// axes are orthogonal up to 8u, over which the ray of light between a point and the sphere drifts
/// by 8u times the sum of both M.
pub(super) fn slack(center: DVec3, radius: f64) -> f64 {
    32.0 * UNIT_ROUNDOFF * (center.abs().element_sum() + radius)
}

/// Mixes the coordinates of a cell: they are no secret, and few.
#[derive(Clone, Debug, Default)]
struct CellHasher(u64);

impl Hasher for CellHasher {
    fn finish(&self) -> u64 {
        self.0 ^ self.0 >> 29
    }

    fn write(&mut self, bytes: &[u8]) {
        for &byte in bytes {
            self.write_i64(i64::from(byte));
        }
    }

    fn write_i64(&mut self, word: i64) {
        const GOLDEN_GAMMA: u64 = 0x9e37_79b9_7f4a_7c15;
        self.0 = (self.0.rotate_left(26) ^ word as u64).wrapping_mul(GOLDEN_GAMMA);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::visibility::tests::Random;

    fn asked(casters: &Casters, point: DVec3, error: f64) -> Vec<usize> {
        let mut asked = Vec::new();
        casters.any(point, error, |index| {
            asked.push(index);
            false
        });
        asked.sort_unstable();
        asked.dedup();
        asked
    }

    /// Points at the very edge of discs of all sizes, and within their error of it.
    #[test]
    fn points_at_the_edge_of_a_disc_ask_its_sphere() {
        let mut random = Random(7);
        for _ in 0..300 {
            let toward = random.point().normalize();
            let spheres: Vec<Sphere> = (0..10)
                .map(|_| {
                    let radius = libm::exp10(-4.0 + 8.0 * random.number());
                    Sphere::new(random.point() * 3.0, radius).unwrap()
                })
                .collect();
            let casters = Casters::new(&spheres, toward);
            for (index, sphere) in spheres.iter().enumerate() {
                let outward = random.point().reject_from_normalized(toward).normalize();
                let below = -20.0 * random.number() * toward;
                let point = sphere.center() + outward * sphere.radius() + below;
                assert!(asked(&casters, point, 0.0).contains(&index));
                for error in [1e-9, 0.1, 100.0] {
                    assert!(asked(&casters, point + outward * error, error).contains(&index));
                }
            }
        }
    }

    /// Counted work: neither a floor nor a stray sphere makes points ask more than a few.
    #[test]
    fn floors_and_outliers_do_not_matter() {
        let mut random = Random(8);
        let balls: Vec<Sphere> = (0..10_000)
            .map(|_| Sphere::new(random.point() * 100.0, 0.9).unwrap())
            .collect();
        let floor = Sphere::new(DVec3::new(0.0, -1e6, 0.0), 1e6).unwrap();
        let speck = Sphere::new(DVec3::splat(1e6), 0.01).unwrap();
        for extra in [vec![], vec![floor], vec![speck], vec![floor, speck]] {
            let spheres = [&balls[..], &extra[..]].concat();
            let casters = Casters::new(&spheres, DVec3::new(0.6, 0.64, -0.48));
            let count: usize = balls
                .iter()
                .map(|ball| asked(&casters, ball.center(), 1e-13).len())
                .sum();
            assert!(count < 4 * balls.len(), "{} a point", count as f64 / 1e4);
        }
    }
}
