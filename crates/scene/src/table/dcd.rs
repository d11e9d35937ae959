//! DCD, the trajectories of CHARMM and NAMD, in ångströms: records of Fortran, of either byte order, with their size before
//! and behind them. Each frame has a record for each axis, and may have one for the cell before them.
//!
//! # Source
//! "CHARMM trajectory file format" in the documentation of CHARMM; `dcdplugin` of VMD for cells and atoms that are fixed.

use glam::{DMat3, DVec3};

use super::cell::{Cell, ToldCell};
use super::error::TableError;
use super::frame::{Frame, damaged, take};
use super::input::Input;
use super::kind::Order;
use crate::text::LocatedFault;

/// The bytes of the first record, and the places of whole numbers in it, behind the mark `CORD`.
const HEADER: u32 = 84;
const MARK: &[u8; 4] = b"CORD";
const FRAMES: usize = 0;
const FIXED: usize = 8;
const HAS_CELL: usize = 10;
const HAS_FOURTH: usize = 11;
const VERSION: usize = 19;
/// The bytes of a cell: six doubles.
const OF_CELL: u64 = 48;
/// The size before and behind a record.
const MARKERS: u64 = 8;

/// A file, whose frames all have the same size but the first.
#[derive(Clone, Debug)]
pub(crate) struct File {
    order: Order,
    atoms: u64,
    has_cell: bool,
    has_fourth: bool,
    /// The numbers of the atoms that move, from 0, where others are in the first frame alone.
    moving: Option<Vec<usize>>,
    /// The byte at which the first frame starts.
    start: u64,
    /// The number of frames.
    pub(crate) frames: u64,
}

/// Says whether a file begins so, written by a machine of either byte order.
pub(crate) fn is_like(head: &[u8]) -> bool {
    let size = head.first_chunk().map(|bytes| u32::from_le_bytes(*bytes));
    size.is_some_and(|size| size == HEADER || size.swap_bytes() == HEADER)
        && head.get(4..8) == Some(MARK)
}

impl File {
    /// Reads the records before the first frame; the input stays at the frame with its number.
    pub(crate) fn new(input: &mut Input<'_>) -> Result<Self, TableError> {
        input.skip_to(0, input.number)?;
        let first = take(input, 4)?;
        let order = match first.first() {
            Some(&byte) if u32::from(byte) == HEADER => Order::Little,
            _ => Order::Big,
        };
        input.skip_to(0, input.number)?;
        let header = record(input, order, Some(u64::from(HEADER)), "header")?;
        if header.get(..4) != Some(MARK) {
            return Err(damaged(
                "expected the mark `CORD` in the header, found others".into(),
            ));
        }
        let number = |at: usize| word(order, header.get(4 + 4 * at..).unwrap_or_default());
        let is_of_charmm = number(VERSION) != 0;
        record(input, order, None, "title")?;
        let atoms = record(input, order, Some(4), "number of atoms")?;
        let atoms = u64::from(word(order, &atoms));
        let fixed = u64::from(number(FIXED));
        let moving = match fixed {
            0 => None,
            _ => Some(moving(input, order, atoms, fixed)?),
        };
        let mut file = Self {
            order,
            atoms,
            has_cell: is_of_charmm && number(HAS_CELL) != 0,
            has_fourth: is_of_charmm && number(HAS_FOURTH) == 1,
            moving,
            start: input.position,
            frames: 0,
        };
        file.frames = file.count(input)?;
        let told = u64::from(number(FRAMES));
        if told != file.frames {
            let frames = file.frames;
            let doubt = format!(
                "its header counts {told} frames, and it has {frames}: the file may be cut, or is being written"
            );
            input.doubt(LocatedFault::of_file(doubt));
        }
        Ok(file)
    }

    /// The number of frames, the last of which is whole.
    fn count(&self, input: &Input<'_>) -> Result<u64, TableError> {
        let left = input.size().unwrap_or(0).saturating_sub(self.start);
        let (first, later) = (self.size(0), self.size(1));
        let count = match left.checked_sub(first) {
            None => 0,
            Some(rest) => 1 + rest / later,
        };
        let end = self.place(count);
        let rest = (self.start + left).saturating_sub(end);
        if rest > 0 {
            let (frame, size) = (count + 1, self.size(count));
            return Err(damaged(format!(
                "expected {size} bytes in frame {frame} at byte {end}, found {rest}: the file is cut"
            )));
        }
        Ok(count)
    }

    /// The atoms whose positions a frame has.
    fn stored(&self, frame: u64) -> u64 {
        match (&self.moving, frame) {
            (Some(moving), 1..) => moving.len() as u64,
            _ => self.atoms,
        }
    }

    /// The bytes of a frame.
    fn size(&self, frame: u64) -> u64 {
        let axes = 3 + u64::from(self.has_fourth);
        let cell = u64::from(self.has_cell) * (OF_CELL + MARKERS);
        cell + axes * (4 * self.stored(frame) + MARKERS)
    }

    /// The byte at which a frame begins.
    fn place(&self, frame: u64) -> u64 {
        match frame.checked_sub(1) {
            None => self.start,
            Some(later) => self.start + self.size(0) + later * self.size(1),
        }
    }

    /// Reads the frame of the input's number; `None` behind the last one.
    pub(crate) fn read(&self, input: &mut Input<'_>) -> Result<Option<Frame>, TableError> {
        let frame = input.number;
        if frame >= self.frames {
            return Ok(None);
        }
        let stored = self.read_stored(input, frame)?;
        let read = match &self.moving {
            Some(moving) if frame > 0 => {
                let mut all = self.read_stored(input, 0)?;
                for (atom, position) in moving.iter().zip(stored.positions) {
                    if let Some(own) = all.positions.get_mut(*atom) {
                        *own = position;
                    }
                }
                Frame {
                    cell: stored.cell,
                    ..all
                }
            }
            _ => stored,
        };
        input.number = frame + 1;
        Ok(Some(read))
    }

    /// Passes over the frame of the input's number; returns whether there was one.
    pub(crate) fn skip(&self, input: &mut Input<'_>) -> bool {
        let is_one = input.number < self.frames;
        input.number += u64::from(is_one);
        is_one
    }

    /// Reads the positions that a frame has.
    fn read_stored(&self, input: &mut Input<'_>, frame: u64) -> Result<Frame, TableError> {
        input.skip_to(self.place(frame), input.number)?;
        let cell = match self.has_cell {
            true => cell(
                &record(input, self.order, Some(OF_CELL), "cell")?,
                self.order,
                frame + 1,
            ),
            false => None,
        };
        let atoms = self.stored(frame);
        let mut positions = vec![[0.0; 3]; atoms as usize];
        for (axis, name) in ["x", "y", "z"].into_iter().enumerate() {
            let bytes = record(input, self.order, Some(4 * atoms), name)?;
            let (numbers, _) = bytes.as_chunks::<4>();
            for (position, number) in positions.iter_mut().zip(numbers) {
                position[axis] = f32::from_bits(word(self.order, number));
            }
        }
        Ok(Frame { positions, cell })
    }
}

/// The atoms that move, besides so many that are fixed.
fn moving(
    input: &mut Input<'_>,
    order: Order,
    atoms: u64,
    fixed: u64,
) -> Result<Vec<usize>, TableError> {
    let Some(count) = atoms.checked_sub(fixed) else {
        return Err(damaged(format!(
            "expected at most {atoms} fixed atoms, as many as there are, found {fixed}"
        )));
    };
    let bytes = record(
        input,
        order,
        Some(4 * count),
        "numbers of the atoms that move",
    )?;
    let (numbers, _) = bytes.as_chunks::<4>();
    let atom = |bytes: &[u8; 4]| {
        let number = word(order, bytes);
        let atom = u64::from(number)
            .checked_sub(1)
            .filter(|atom| *atom < atoms);
        atom.map(|atom| atom as usize).ok_or_else(|| {
            damaged(format!(
                "expected the numbers of atoms that move, from 1 to {atoms}, found {number}"
            ))
        })
    };
    numbers.iter().map(atom).collect()
}

/// The next record, which has so many bytes if that is known; `noun` says what is in it.
fn record(
    input: &mut Input<'_>,
    order: Order,
    expected: Option<u64>,
    noun: &str,
) -> Result<Vec<u8>, TableError> {
    let start = input.position;
    let size = u64::from(word(order, &take(input, 4)?));
    if let Some(expected) = expected
        && size != expected
    {
        return Err(damaged(format!(
            "expected a record of {expected} bytes ({noun}) at byte {start}, found one of {size}"
        )));
    }
    let bytes = take(input, size)?;
    let again = u64::from(word(order, &take(input, 4)?));
    match again == size {
        true => Ok(bytes),
        false => Err(damaged(format!(
            "expected the size {size} of the record ({noun}) at byte {start} behind it, too, found {again}"
        ))),
    }
}

/// The cell of a frame; `None` if all its numbers are 0, as they are without a cell.
fn cell(bytes: &[u8], order: Order, frame: u64) -> Option<ToldCell> {
    let (numbers, _) = bytes.as_chunks();
    let number = |bytes: &[u8; 8]| match order {
        Order::Little => f64::from_le_bytes(*bytes),
        Order::Big => f64::from_be_bytes(*bytes),
    };
    let numbers: Vec<f64> = numbers.iter().map(number).collect();
    let &[a, gamma, b, beta, alpha, c] = &numbers[..] else {
        return None;
    };
    if numbers.iter().all(|number| *number == 0.0) {
        return None;
    }
    let angles = [alpha, beta, gamma];
    let is_cosine = |number: &f64| (-1.0..=1.0).contains(number);
    let is_angle = |number: &f64| (0.0..=180.0).contains(number);
    let cell = if angles.iter().all(is_cosine) {
        let degrees = angles.map(|cosine| libm::acos(cosine).to_degrees());
        Cell::of_lengths([a, b, c], degrees)
    } else if angles.iter().all(is_angle) && [a, b, c].iter().all(|length| *length >= 0.0) {
        Cell::of_lengths([a, b, c], angles)
    } else {
        // Newer versions of CHARMM write half of a symmetric matrix.
        let [xx, xy, yy, xz, yz, zz] = [a, gamma, b, beta, alpha, c];
        let edges = DMat3::from_cols(
            DVec3::new(xx, xy, xz),
            DVec3::new(xy, yy, yz),
            DVec3::new(xz, yz, zz),
        );
        Cell::new(edges, DVec3::ZERO)
    };
    Some(cell.map_err(|message| LocatedFault::of_file(format!("{message} in frame {frame}"))))
}

/// The whole number at the start of these bytes; 0 where there are too few.
fn word(order: Order, bytes: &[u8]) -> u32 {
    let bytes = bytes.first_chunk().copied().unwrap_or_default();
    match order {
        Order::Little => u32::from_le_bytes(bytes),
        Order::Big => u32::from_be_bytes(bytes),
    }
}
