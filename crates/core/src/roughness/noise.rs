//! Smooth noise in [−1, 1): random values at the points of the unit lattice, blended by quadratic
//! B-splines, so that slopes are continuous and no lattice shows.

use crate::lanes::Lanes;

/// The random values around one lattice point, which determine the noise in the unit cube about it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Cell {
    /// Along z, then y, then x; three independent numbers each.
    values: [[[[f64; 3]; 3]; 3]; 3],
}

impl Cell {
    /// The cell about the lattice point `index` (x, y, z) of the lattice with this key.
    pub(super) fn new(key: u64, index: [i64; 3]) -> Self {
        let [xs, ys, zs] =
            index.map(|index| [-1, 0, 1].map(|step| index.wrapping_add(step) as u64));
        let values = zs.map(|z| {
            let key = hash(key, z);
            ys.map(|y| {
                let key = hash(key, y);
                xs.map(|x| spread(hash(key, x)))
            })
        });
        Self { values }
    }

    /// The noise at an offset from the lattice point, from −½ to ½ along each axis.
    ///
    /// Axis by axis: first the nine rows along x, then three along y, then one along z.
    #[inline(always)]
    pub(super) fn blend<L: Lanes>(&self, offset: [L; 3]) -> [L; 3] {
        let [along_x, along_y, along_z] =
            [weights(offset[0]), weights(offset[1]), weights(offset[2])];
        let planes = [
            plane(along_x, along_y, &self.values[0]),
            plane(along_x, along_y, &self.values[1]),
            plane(along_x, along_y, &self.values[2]),
        ];
        weigh(along_z, planes)
    }
}

#[inline(always)]
fn plane<L: Lanes>(along_x: [L; 3], along_y: [L; 3], values: &[[[f64; 3]; 3]; 3]) -> [L; 3] {
    let rows = [
        row(along_x, &values[0]),
        row(along_x, &values[1]),
        row(along_x, &values[2]),
    ];
    weigh(along_y, rows)
}

#[inline(always)]
fn row<L: Lanes>([before, middle, after]: [L; 3], [a, b, c]: &[[f64; 3]; 3]) -> [L; 3] {
    [
        before * a[0] + middle * b[0] + after * c[0],
        before * a[1] + middle * b[1] + after * c[1],
        before * a[2] + middle * b[2] + after * c[2],
    ]
}

#[inline(always)]
fn weigh<L: Lanes>([before, middle, after]: [L; 3], [a, b, c]: [[L; 3]; 3]) -> [L; 3] {
    [
        before * a[0] + middle * b[0] + after * c[0],
        before * a[1] + middle * b[1] + after * c[1],
        before * a[2] + middle * b[2] + after * c[2],
    ]
}

/// The weights of the three lattice points along an axis at an offset from the middle one: the
/// quadratic B-spline.
#[inline(always)]
fn weights<L: Lanes>(offset: L) -> [L; 3] {
    let (before, after) = (offset * -1.0 + 0.5, offset + 0.5);
    [
        before * before * 0.5,
        offset * offset * -1.0 + 0.75,
        after * after * 0.5,
    ]
}

/// The cells that were asked for last, of any spheres.
///
/// A table with one place for each cell: the cells of a sphere within a cube of four by four by
/// four never push each other out.
#[derive(Clone, Debug)]
pub(crate) struct NoiseCells {
    /// Which cells are in the table: apart from the cells, so that a glance takes little memory.
    names: Vec<Name>,
    cells: Vec<Cell>,
}

/// What tells a cell: the key of its lattice and the lattice point.
type Name = (u64, [i64; 3]);

/// Bits of the index that choose the slot, for each axis.
const SLOT_BITS: u32 = 2;
const SLOTS: usize = 1 << (3 * SLOT_BITS);

impl NoiseCells {
    /// An empty table of about 40 KiB.
    pub(crate) fn new() -> Self {
        // Any cell will do for a start, anywhere: it is what its key and index say.
        let name = (0, [0; 3]);
        Self {
            names: vec![name; SLOTS],
            cells: vec![Cell::new(name.0, name.1); SLOTS],
        }
    }

    /// The cell about the lattice point `index`, computed where it is not in the table.
    #[inline]
    pub(super) fn cell(&mut self, key: u64, index: [i64; 3]) -> &Cell {
        let [x, y, z] = index.map(|index| index as usize % (1 << SLOT_BITS));
        let place = x | y << SLOT_BITS | z << (2 * SLOT_BITS);
        let slot = place.wrapping_add(key as usize) % SLOTS;
        if self.names[slot] != (key, index) {
            self.replace(slot, key, index);
        }
        &self.cells[slot]
    }

    #[inline(never)]
    fn replace(&mut self, slot: usize, key: u64, index: [i64; 3]) {
        self.names[slot] = (key, index);
        self.cells[slot] = Cell::new(key, index);
    }
}

/// Three numbers in [−1, 1) from the bits of one.
pub(super) fn spread(bits: u64) -> [f64; 3] {
    const BITS: u32 = 21;
    const UNIT: f64 = 1.0 / (1_u64 << (BITS - 1)) as f64;
    let part = |index: u32| {
        let bits = bits >> (64 - BITS * (index + 1)) & ((1 << BITS) - 1);
        f64::from(bits as u32) * UNIT - 1.0
    };
    [part(0), part(1), part(2)]
}

/// Mixes a word into a key; every bit of either changes every bit of the result.
///
/// # Source
/// The increment and finalizer of SplitMix64: Steele, Lea, Flood, Fast Splittable Pseudorandom
/// Number Generators, OOPSLA 2014, with the constants of Stafford's variant 13.
pub(super) fn hash(key: u64, word: u64) -> u64 {
    const GOLDEN_GAMMA: u64 = 0x9e37_79b9_7f4a_7c15;
    let mut z = (key ^ word.wrapping_mul(GOLDEN_GAMMA)).wrapping_add(GOLDEN_GAMMA);
    z = (z ^ z >> 30).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ z >> 27).wrapping_mul(0x94d0_49bb_1331_11eb);
    z ^ z >> 31
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cells_of_a_block_stay_in_the_table() {
        let mut table = NoiseCells::new();
        let block = (0..64).map(|i| [i % 4 - 2, i / 4 % 4 - 7, i / 16 + (1 << 40)]);
        for index in block.clone() {
            table.cell(99, index);
        }
        for index in block {
            assert!(table.names.contains(&(99, index)), "{index:?}");
        }
    }
}
