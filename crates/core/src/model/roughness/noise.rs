//! Smooth noise in [−1, 1): random values at the points of the unit lattice, blended by quadratic
//! B-splines, so that slopes are continuous and no lattice shows.

use fearless_simd::Simd;

use crate::numeric::lanes::{Lanes, f64x8};
use crate::numeric::pair::three;

/// The noise in the unit cube about one lattice point: random values at the 27 lattice points around,
/// blended.
///
/// As a polynomial of the second degree in each of the offsets from the lattice point, which takes
/// two thirds of the products that weights do. The values have 21 bits, so that the coefficients are
/// exact.
#[derive(Clone, Copy, Debug)]
pub(super) struct Cell {
    /// By powers of x, then y, then z; three independent polynomials. The last five are not used: eight
    /// can be computed at a time.
    coefficients: [[f64; 32]; 3],
}

impl Cell {
    /// The cell about the lattice point `index` (x, y, z) of the lattice with this key.
    pub(super) fn new(key: u64, index: [i64; 3]) -> Self {
        let [xs, ys, zs] = three(index, |index| {
            three([-1, 0, 1], |step| index.wrapping_add(step) as u64)
        });
        let planes = three(zs, |z| {
            let key = hash(key, z);
            let rows = three(ys, |y| {
                let key = hash(key, y);
                spline(three(xs, |x| spread(hash(key, x))))
            });
            let [before, middle, after] = rows;
            let mut plane = rows;
            for power in 0..3 {
                let along = spline([before[power], middle[power], after[power]]);
                for (row, value) in plane.iter_mut().zip(along) {
                    row[power] = value;
                }
            }
            plane
        });
        let [before, middle, after] = planes;
        let mut coefficients = [[0.0; 32]; 3];
        for y in 0..3 {
            for (x, coefficients) in coefficients.iter_mut().enumerate() {
                let along = spline([before[y][x], middle[y][x], after[y][x]]);
                for (z, value) in along.into_iter().enumerate() {
                    coefficients[9 * y + 3 * z..][..3].copy_from_slice(&value);
                }
            }
        }
        Self { coefficients }
    }

    /// The noise at an offset from the lattice point, from −½ to ½ along each axis.
    ///
    /// Axis by axis: first the nine rows along x, then three along y, then one along z.
    #[inline(always)]
    pub(super) fn blend<L: Lanes>(&self, [x, y, z]: [L; 3]) -> [L; 3] {
        let planes = [
            self.plane(x, y, 0),
            self.plane(x, y, 1),
            self.plane(x, y, 2),
        ];
        along(z, planes)
    }

    /// The coefficients of a power of z.
    #[inline(always)]
    fn plane<L: Lanes>(&self, x: L, y: L, of_z: usize) -> [L; 3] {
        let rows = [
            self.row(x, 3 * of_z),
            self.row(x, 3 * of_z + 9),
            self.row(x, 3 * of_z + 18),
        ];
        along(y, rows)
    }

    #[inline(always)]
    fn row<L: Lanes>(&self, x: L, first: usize) -> [L; 3] {
        let [a, b, c] = &self.coefficients;
        let at = [first, first + 1, first + 2];
        [
            (x * c[at[0]] + b[at[0]]) * x + a[at[0]],
            (x * c[at[1]] + b[at[1]]) * x + a[at[1]],
            (x * c[at[2]] + b[at[2]]) * x + a[at[2]],
        ]
    }

    /// The second derivative along an axis, which is the same all along it, at an offset from the lattice point.
    pub(super) fn bend(&self, axis: usize, offset: [f64; 3]) -> [f64; 3] {
        match axis {
            0 => self.bend_along::<0>(offset),
            1 => self.bend_along::<1>(offset),
            _ => self.bend_along::<2>(offset),
        }
    }

    /// The same along an axis that the compiler knows, and with it the places of all coefficients.
    #[inline(always)]
    fn bend_along<const AXIS: usize>(&self, offset: [f64; 3]) -> [f64; 3] {
        // How far the coefficients of powers of x, y and z are apart.
        const STRIDES: [usize; 3] = [32, 9, 3];
        let coefficients = self.coefficients.as_flattened();
        let [one, other] = const { [(AXIS + 1) % 3, (AXIS + 2) % 3] };
        let [along_one, along_other] = [offset[one], offset[other]];
        let first = 2 * STRIDES[AXIS];
        three([0, 1, 2], |part| {
            let row = |power: usize| {
                let at = first + power * STRIDES[one] + part;
                let step = STRIDES[other];
                let [a, b, c] = three([at, at + step, at + 2 * step], |at| coefficients[at]);
                (c * along_other + b) * along_other + a
            };
            2.0 * ((row(2) * along_one + row(1)) * along_one + row(0))
        })
    }

    /// The noise at one offset, the same to the bit: with eight coefficients at a time, where
    /// [`Self::blend`] takes eight offsets.
    #[inline(always)]
    pub(super) fn blend_one<S: Simd>(&self, simd: S, [x, y, z]: [f64; 3]) -> [f64; 3] {
        let [a, b, c] = &self.coefficients;
        let mut rows = [0.0; 32];
        for first in [0, 8, 16, 24] {
            let a = f64x8::from_slice(simd, &a[first..first + 8]);
            let b = f64x8::from_slice(simd, &b[first..first + 8]);
            let c = f64x8::from_slice(simd, &c[first..first + 8]);
            let eight: [f64; 8] = ((c * x + b) * x + a).into();
            rows[first..first + 8].copy_from_slice(&eight);
        }
        let a = f64x8::from_slice(simd, &rows[..8]);
        let b = f64x8::from_slice(simd, &rows[9..17]);
        let c = f64x8::from_slice(simd, &rows[18..26]);
        let eight: [f64; 8] = ((c * y + b) * y + a).into();
        let ninth = (rows[26] * y + rows[17]) * y + rows[8];
        [
            (eight[6] * z + eight[3]) * z + eight[0],
            (eight[7] * z + eight[4]) * z + eight[1],
            (ninth * z + eight[5]) * z + eight[2],
        ]
    }
}
#[inline(always)]
fn along<L: Lanes>(at: L, [a, b, c]: [[L; 3]; 3]) -> [L; 3] {
    [
        (at * c[0] + b[0]) * at + a[0],
        (at * c[1] + b[1]) * at + a[1],
        (at * c[2] + b[2]) * at + a[2],
    ]
}

/// The polynomial of the offset o from the middle one of three lattice points, the constant first, that
/// is the blend of their values with the weights of the quadratic B-spline: ½ (½ − o)², ¾ − o² and
/// ½ (½ + o)².
fn spline([before, middle, after]: [[f64; 3]; 3]) -> [[f64; 3]; 3] {
    let mut polynomial = [[0.0; 3]; 3];
    for part in 0..3 {
        let sides = before[part] + after[part];
        polynomial[0][part] = 0.125 * sides + 0.75 * middle[part];
        polynomial[1][part] = 0.5 * (after[part] - before[part]);
        polynomial[2][part] = 0.5 * sides - middle[part];
    }
    polynomial
}

/// The cells that were asked for last, of any spheres.
///
/// A table with one place for each cell: the cells of a sphere within a cube of four by four by
/// four never push each other out.
#[derive(Clone, Debug)]
pub(crate) struct NoiseCells {
    /// The names of the cells in the table: apart from the cells, so that a look takes little memory.
    names: Vec<Name>,
    cells: Vec<Cell>,
}

/// The key of a cell's lattice and the bits of the lattice point.
type Name = (u64, [u64; 3]);

/// Bits of the index that choose the slot, for each axis.
const SLOT_BITS: u32 = 2;
const SLOTS: usize = 1 << (3 * SLOT_BITS);

/// 1.5 · 2⁵²: whole numbers of up to 51 bits, added to it, are its last bits.
const COUNTER: f64 = 1.5 * (1_u64 << (f64::MANTISSA_DIGITS - 1)) as f64;

impl NoiseCells {
    /// An empty table of about 40 KiB.
    pub(crate) fn new() -> Self {
        // Any cell will do for a start, anywhere: it is what its key and index say.
        let name = (0, [0; 3]);
        Self {
            names: vec![name; SLOTS],
            cells: vec![Cell::new(0, [0; 3]); SLOTS],
        }
    }

    /// The cell about the lattice point (x, y, z), computed where it is not in the table.
    #[inline(always)]
    pub(super) fn cell(&mut self, key: u64, [x, y, z]: [f64; 3]) -> &Cell {
        let place = last_bits(x) | last_bits(y) << SLOT_BITS | last_bits(z) << (2 * SLOT_BITS);
        let slot = place.wrapping_add(key as usize) % SLOTS;
        let (of, [at_x, at_y, at_z]) = self.names[slot];
        let is_other =
            (of ^ key) | (at_x ^ x.to_bits()) | (at_y ^ y.to_bits()) | (at_z ^ z.to_bits());
        if is_other != 0 {
            self.replace(slot, key, [x, y, z]);
        }
        &self.cells[slot]
    }

    #[inline(never)]
    fn replace(&mut self, slot: usize, key: u64, point: [f64; 3]) {
        self.names[slot] = (key, point.map(f64::to_bits));
        self.cells[slot] = Cell::new(key, point.map(|part| part as i64));
    }
}

/// The last bits of a whole number, as many as choose the slot.
#[inline(always)]
fn last_bits(whole: f64) -> usize {
    (whole + COUNTER).to_bits() as usize % (1 << SLOT_BITS)
}

/// Three numbers in [−1, 1) from the bits of one.
pub(crate) fn spread(bits: u64) -> [f64; 3] {
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
pub(crate) fn hash(key: u64, word: u64) -> u64 {
    const GOLDEN_GAMMA: u64 = 0x9e37_79b9_7f4a_7c15;
    let mut z = (key ^ word.wrapping_mul(GOLDEN_GAMMA)).wrapping_add(GOLDEN_GAMMA);
    z = (z ^ z >> 30).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ z >> 27).wrapping_mul(0x94d0_49bb_1331_11eb);
    z ^ z >> 31
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Second differences of a polynomial of the second degree are its second derivative.
    #[test]
    fn cells_bend_as_second_differences_tell() {
        const STEP: f64 = 0.125;
        let offset = [0.3, -0.2, 0.11];
        for index in [[0, 0, 0], [-3, 7, 2], [5, -1, 1 << 40]] {
            let cell = Cell::new(17, index);
            for axis in 0..3 {
                let at = |steps: f64| {
                    let mut offset = offset;
                    offset[axis] += steps * STEP;
                    cell.blend(offset)
                };
                let (before, middle, after) = (at(-1.0), at(0.0), at(1.0));
                let bend = cell.bend(axis, offset);
                for part in 0..3 {
                    let sides = before[part] + after[part] - 2.0 * middle[part];
                    let difference = sides / (STEP * STEP) - bend[part];
                    assert!(difference.abs() < 1e-12, "{axis} {part}: {difference:e}");
                }
            }
        }
    }

    #[test]
    fn cells_of_a_block_stay_in_the_table() {
        let mut table = NoiseCells::new();
        let block = (0..64).map(|i| [i % 4 - 2, i / 4 % 4 - 7, i / 16 + (1 << 40)]);
        let block = block.map(|index: [i64; 3]| index.map(|index| index as f64));
        for index in block.clone() {
            table.cell(99, index);
        }
        for index in block {
            let name = (99, index.map(f64::to_bits));
            assert!(table.names.contains(&name), "{index:?}");
        }
    }
}
