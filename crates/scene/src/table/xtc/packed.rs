//! Positions as XTC compresses them: whole multiples of a length, many of them as steps from the atom before.
//!
//! An atom is three whole numbers from the smallest ones of all atoms on, then one bit. If this is set, five bits tell how
//! many atoms follow as small steps from it, and whether the largest step changes by one place in the table of sizes. The
//! first of the atoms that follow stands before the one from which it steps: so the two hydrogens of water are near their
//! oxygen.
//!
//! # Source
//! The library `xdrfile` of GROMACS defines the format by what it writes; checked against files of `MDAnalysis` and `mdtraj`.

use super::bits::Bits;

/// The first place in the table of sizes that may be used, and the number of places.
const FIRST: usize = 9;
const PLACES: usize = 73;

/// The whole numbers below which the components of steps lie, by their place in the table: the powers of the cube root of 2
/// rounded down, so that three of them take as many bits as the place says.
const SIZES: [u32; PLACES] = {
    let mut sizes = [0; PLACES];
    let mut place = FIRST;
    while place < PLACES {
        sizes[place] = cube_root(1 << place);
        place += 1;
    }
    // These are others in all programs, and the format is what these write.
    sizes[37] = 5060;
    sizes[57] = 524_287;
    sizes[69] = 8_388_607;
    sizes
};

/// The largest whole number whose cube is not above this one.
const fn cube_root(number: u128) -> u32 {
    let mut root: u128 = 0;
    let mut bit: u128 = 1 << 25;
    while bit > 0 {
        let more = root + bit;
        if more * more * more <= number {
            root = more;
        }
        bit >>= 1;
    }
    root as u32
}

/// The range of the atoms, and the size of the first steps.
#[derive(Clone, Copy, Debug)]
pub(super) struct Range {
    low: [i32; 3],
    /// The numbers of whole numbers from the smallest ones to the largest ones.
    sizes: [u32; 3],
    /// The place of the first steps in the table of sizes.
    step: usize,
}

impl Range {
    /// The range from the smallest to the largest numbers; `None` if there is none.
    pub(super) fn new(low: [i32; 3], high: [i32; 3], step: u32) -> Option<Self> {
        let mut sizes = [0; 3];
        for axis in 0..3 {
            let size = i64::from(high[axis]) - i64::from(low[axis]) + 1;
            sizes[axis] = u32::try_from(size).ok().filter(|size| *size > 0)?;
        }
        let step = usize::try_from(step).ok()?;
        (FIRST..PLACES)
            .contains(&step)
            .then_some(Self { low, sizes, step })
    }

    /// Reads so many atoms from these bytes, multiples of a length; `None` if they are damaged or end early.
    pub(super) fn unpack(&self, bytes: &[u8], count: usize) -> Option<Vec<[i32; 3]>> {
        /// Sizes of which three are one number.
        const MOST: u32 = 0xff_ffff;
        let Self { low, sizes, .. } = *self;
        let are_one = sizes.iter().all(|size| *size <= MOST);
        let of_one = length(sizes.iter().map(|size| u128::from(*size)).product());
        let of_each = sizes.map(|size| length(u128::from(size)));
        let mut bits = Bits::new(bytes);
        let mut step = self.step;
        let mut run = 0;
        // As many as the bytes bear out: damaged files tell of more.
        let mut atoms = Vec::with_capacity(count.min(bytes.len()));
        while atoms.len() < count {
            let numbers = match are_one {
                true => bits.triple(of_one, sizes)?,
                false => {
                    let mut numbers = [0; 3];
                    for axis in 0..3 {
                        numbers[axis] = bits.take(of_each[axis])?;
                    }
                    numbers
                }
            };
            let first = shifted(low, numbers);
            let mut change = 1;
            if bits.take(1)? == 1 {
                let told = bits.take(5)?;
                (run, change) = (told / 3, told % 3);
            }
            if atoms.len() + run as usize >= count {
                return None;
            }
            let half = (SIZES[step] / 2) as i32;
            let mut before = first;
            for index in 0..run {
                let numbers = bits.triple(step as u32, [SIZES[step]; 3])?;
                before = shifted(before.map(|number| number.wrapping_sub(half)), numbers);
                atoms.push(before);
                if index == 0 {
                    atoms.push(first);
                }
            }
            if run == 0 {
                atoms.push(first);
            }
            step = (step + change as usize).checked_sub(1)?;
            if !(FIRST..PLACES).contains(&step) {
                return None;
            }
        }
        Some(atoms)
    }
}

/// The number of bits of a number.
fn length(number: u128) -> u32 {
    u128::BITS - number.leading_zeros()
}

fn shifted(from: [i32; 3], by: [u32; 3]) -> [i32; 3] {
    [0, 1, 2].map(|axis| from[axis].wrapping_add(by[axis] as i32))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sizes_are_those_of_the_format() {
        // The first, some between, and the last of the table in `xdrfile`.
        let known = [(9, 8), (10, 10), (11, 12), (14, 25), (35, 3250), (36, 4096)];
        let others = [(38, 6501), (47, 52_015), (61, 1_321_122), (72, 16_777_216)];
        for (place, size) in known.into_iter().chain(others) {
            assert_eq!(SIZES[place], size, "{place}");
        }
    }
}
