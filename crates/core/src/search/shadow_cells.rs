//! Cells of space below a light, each with the spheres that end in it toward the light.
//!
//! Points that lie together share what may darken them. Cells are cubes along the light, in layers whose sides
//! are powers of two. From a point's cell, as large as some tiles are where it lies, the way to the light
//! leads through cells that become larger as soon as they fit, until nothing is above or the point is found
//! to be in the dark. What ends in a cell is looked up when the first point comes along: where few ask, that takes less time than
//! to list all spheres in a [`LightGrid`](super::light_grid::LightGrid), which answers where there is one.

use glam::{DVec2, DVec3};

use super::disc_grid::{DiscGrid, HighDisc, PointBelow, Square};
use super::occluders::{Occluders, slack};
use super::visibility::Visibility;
use crate::model::ray::Ray;
use crate::numeric::pair::three;

/// The part of a cell's side up to which points may be off. Not tuned: points are off by far less, unless
/// they cannot be told apart.
const MARGIN: f64 = 1.0 / 256.0;

/// Cells with more discs are left to smaller ones. Tuned for a million spheres alone: it bounds the memory of a cell, and
/// what is in vain where points lie in few of its parts.
const MOST_DISCS: usize = 1024;

/// As much for columns: most points that come so far are not in the dark, and go through all of it.
const MOST_IN_COLUMN: usize = 512;

/// After a cell with so few discs, larger ones are tried: they hold some eight times as many. Not tuned.
const FEW_DISCS: usize = 64;

/// After so many cells of a layer, larger ones are tried all the same. Not tuned: it keeps long ways short.
const MOST_PASSED: u32 = 4;

/// The number of layers by which a point's cell may lie too low; points that find too much in all of
/// them are looked up alone. Not tuned: in the last one cells are about a pixel.
const MOST_HALVINGS: i32 = 6;

/// The binary logarithm of how many times a cell's side is that of the region of points that are going to be
/// asked about, rounded down to a power of two. Tuned for a million spheres alone: larger cells hold more that lies too far
/// from their points, smaller ones are looked up more often.
const LARGER_EXPONENT: i32 = 3;

/// The binary logarithm of the number of cells that are remembered. Not tuned: a strip of a picture
/// takes a few hundred.
const SLOTS_EXPONENT: u32 = 12;

/// Places for discs that are remembered in all cells: 20 MiB. Not tuned.
const MOST_PLACES: usize = 1 << 20;

/// A cell: a light, the binary logarithm of its side, and its place in its sides.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
struct Key {
    /// The name of the light's occluders: memory may serve pictures under one light after the other.
    light: u32,
    /// Whether it is a column that ends nowhere.
    is_column: bool,
    exponent: i32,
    place: [i64; 3],
}

impl Key {
    /// The slot in which the cell is remembered.
    #[inline(always)]
    fn slot(&self) -> usize {
        /// Odd, and near 2⁶⁴ over the golden ratio.
        const FACTOR: u64 = 0x9e37_79b9_7f4a_7c15;
        let mut hash = u64::from(self.light) << 32 ^ self.exponent as u64;
        hash ^= u64::from(self.is_column) << 31;
        for place in self.place {
            hash = (hash.rotate_left(5) ^ place as u64).wrapping_mul(FACTOR);
        }
        (hash >> (u64::BITS - SLOTS_EXPONENT)) as usize
    }

    #[inline(always)]
    fn side(&self) -> f64 {
        power(self.exponent)
    }

    /// The cell of the layer above that this one is in.
    fn parent(&self) -> Self {
        Self {
            exponent: self.exponent + 1,
            place: self.place.map(|place| place >> 1),
            ..*self
        }
    }

    /// The column that begins where the cell does.
    fn column(&self) -> Self {
        Self {
            is_column: true,
            ..*self
        }
    }

    /// True if the cell begins at the height at which that of the layer above does.
    fn is_low(&self) -> bool {
        self.place[2] & 1 == 0
    }
}

/// The facts known about a cell.
#[derive(Clone, Debug)]
struct Cell {
    key: Key,
    grid: DiscGrid,
    /// The number of discs.
    count: usize,
    /// True if there are too many discs to be listed.
    is_crowded: bool,
}

/// The cells that were asked for last, of any lights.
#[derive(Clone, Debug, Default)]
pub(crate) struct ShadowCells {
    slots: Vec<Option<Box<Cell>>>,
    /// Places for discs in all of them.
    places: usize,
    /// Memory to work in.
    discs: Vec<HighDisc>,
}

/// A point of a sphere that is asked about.
#[derive(Clone, Copy, Debug)]
pub(crate) struct SurfacePoint {
    pub(crate) point: DVec3,
    /// A bound of how far it is off.
    pub(crate) error: f64,
    /// The sphere's index.
    pub(crate) sphere: usize,
    /// The sphere's center, rounded as a sum with the viewpoint.
    pub(crate) center: DVec3,
    /// About the side of the region of points that are going to be asked about.
    pub(crate) side: f64,
}

impl ShadowCells {
    /// The answer of [`Visibility::is_blocked`] for a point of a sphere and a light.
    pub(crate) fn is_blocked(
        &mut self,
        visibility: &Visibility<'_>,
        light: usize,
        asked: &SurfacePoint,
    ) -> bool {
        let occluders = visibility.light(light).occluders();
        let to_light = Ray {
            origin: asked.point,
            direction: occluders.toward(),
        };
        let around = asked.error + slack(asked.point, 0.0);
        let height = occluders.height(asked.point);
        // Neither its own sphere nor one that coincides with it is taken for an occluder without being
        // asked: their center lies below. The point's error is more than that of the viewpoint's part.
        let center = occluders.height(asked.center) + slack(asked.center, 0.0) + 4.0 * asked.error;
        let point = PointBelow {
            place: occluders.project(asked.point),
            height,
            around,
            is_above_own: center < height - around,
        };
        let mut hides =
            |index: usize| visibility.hides(index, &to_light, asked.error, asked.sphere);
        if let Some(grid) = visibility.light(light).grid()
            && let Some(is_blocked) = grid.any(&point, &mut hides)
        {
            return is_blocked;
        }
        let first = key(occluders.name(), asked.side, &point);
        if let Some(key) = first.filter(|_| visibility.is_moderate())
            && let Some(is_blocked) = self.walk(occluders, key, &point, &mut hides)
        {
            return is_blocked;
        }
        visibility.is_blocked(light, &to_light, asked.error, asked.sphere)
    }

    /// Says whether something holds for any sphere that may keep the light from a point, from its cell on;
    /// `None` if too much is there.
    fn walk(
        &mut self,
        occluders: &Occluders<'_>,
        mut key: Key,
        point: &PointBelow,
        holds: &mut dyn FnMut(usize) -> bool,
    ) -> Option<bool> {
        let (least, highest) = (key.exponent - MOST_HALVINGS, occluders.highest());
        // Whether larger cells are to be tried, and how many were passed that are as large as this one.
        let (mut rises, mut passed) = (false, 0);
        loop {
            let mut asked = key;
            if rises && key.is_low() {
                asked = self.rise(occluders, &mut key);
                passed = 0;
            }
            let cell = self.cell(occluders, asked);
            if cell.is_crowded {
                if key.exponent == least {
                    return None;
                }
                key = smaller(&key, point)?;
                (rises, passed) = (false, 0);
                continue;
            }
            let is_sparse = cell.count <= FEW_DISCS;
            if cell.grid.any(occluders.level(), point, holds) {
                return Some(true);
            }
            key.place[2] += 1;
            if asked.is_column || key.place[2] as f64 * key.side() > highest {
                return Some(false);
            }
            passed += 1;
            rises = is_sparse || passed >= MOST_PASSED;
        }
    }

    /// Takes the larger cell around a cell, if it is known; returns the cell to ask, which may be the column of that.
    #[inline(always)]
    fn rise(&mut self, occluders: &Occluders<'_>, key: &mut Key) -> Key {
        let larger = key.parent();
        let column = larger.column();
        if !self.cell(occluders, column).is_crowded {
            return column;
        }
        if !self.cell(occluders, larger).is_crowded {
            *key = larger;
        }
        *key
    }

    /// The cell with this key.
    #[inline(always)]
    fn cell(&mut self, occluders: &Occluders<'_>, key: Key) -> &Cell {
        let slot = key.slot();
        let is_there = |cell: &Option<Box<Cell>>| cell.as_ref().is_some_and(|cell| cell.key == key);
        if !self.slots.get(slot).is_some_and(is_there) {
            self.look_up(occluders, key);
        }
        self.slots[slot].as_ref().expect("it was looked up")
    }

    /// Looks up a cell.
    #[cold]
    #[inline(never)]
    fn look_up(&mut self, occluders: &Occluders<'_>, key: Key) {
        if self.slots.is_empty() || self.places > MOST_PLACES {
            self.slots.clear();
            self.slots.resize(1 << SLOTS_EXPONENT, None);
            self.places = 0;
        }
        let cell = self.slots[key.slot()].get_or_insert_with(|| {
            Box::new(Cell {
                key,
                grid: DiscGrid::default(),
                count: 0,
                is_crowded: false,
            })
        });
        self.places -= cell.grid.len();
        let side = key.side();
        let [x, y, z] = key.place.map(|place| place as f64 * side);
        let square = Square {
            low: DVec2::new(x, y),
            bottom: z,
            side,
            margin: side * MARGIN,
        };
        let (end, most) = if key.is_column {
            (f64::INFINITY, MOST_IN_COLUMN)
        } else {
            (z + side, MOST_DISCS)
        };
        cell.key = key;
        let found = occluders.find_high(&square, (z, end), most, &mut self.discs);
        cell.is_crowded = found.is_none();
        cell.count = self.discs.len();
        match found {
            Some(excess) => cell.grid.fill(&square, &self.discs, excess),
            None => cell.grid.clear(),
        }
        self.places += cell.grid.len();
    }
}

/// Two to a power that is a normal double.
#[inline(always)]
fn power(exponent: i32) -> f64 {
    f64::from_bits(((f64::MAX_EXP - 1 + exponent) as u64) << (f64::MANTISSA_DIGITS - 1))
}

/// The cell that a point's way to the light begins in, if the point is known that well, for a region with
/// that side.
#[inline(always)]
fn key(light: u32, side: f64, point: &PointBelow) -> Option<Key> {
    const BIAS: i32 = f64::MAX_EXP - 1;
    let exponent = (side.to_bits() >> (f64::MANTISSA_DIGITS - 1)) as i32 - BIAS + LARGER_EXPONENT;
    // A sphere whose top is where the point is may reach above it.
    let height = point.height - 2.0 * point.around;
    key_at(light, exponent, &PointBelow { height, ..*point })
}

/// The cell of the layer below in which a point's way through a cell begins.
#[inline(always)]
fn smaller(key: &Key, point: &PointBelow) -> Option<Key> {
    let begin = key.place[2] as f64 * key.side();
    let height = begin.max(point.height - 2.0 * point.around);
    key_at(
        key.light,
        key.exponent - 1,
        &PointBelow { height, ..*point },
    )
}

/// The cell of a layer that a point lies in, if the point is known that well.
#[inline(always)]
fn key_at(light: u32, exponent: i32, point: &PointBelow) -> Option<Key> {
    /// Exponents of cells whose numbers are squared in single precision.
    const MODERATE: std::ops::RangeInclusive<i32> = -36..=36;
    /// Whole numbers below are doubles, with places for halves.
    const MOST: f64 = (1_u64 << 40) as f64;
    if !MODERATE.contains(&exponent) {
        return None;
    }
    let scale = power(-exponent);
    let place = DVec3::new(point.place.x, point.place.y, point.height) * scale;
    // Half of the margin is for what rounding costs elsewhere.
    let is_known = place.abs().max_element() < MOST && point.around * scale <= 0.5 * MARGIN;
    is_known.then(|| Key {
        light,
        is_column: false,
        exponent,
        place: three(place.floor().to_array(), |place| place as i64),
    })
}

#[cfg(test)]
mod tests;
