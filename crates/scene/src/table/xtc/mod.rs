//! XTC, the compressed trajectories of GROMACS, in nanometers: a header and the positions of each frame, big-endian.
//!
//! # Source
//! The library `xdrfile` of GROMACS.

mod bits;
mod packed;

use glam::{DMat3, DVec3};

use self::packed::Range;
use super::cell::{Cell, ToldCell};
use super::error::TableError;
use super::frame::{Frame, damaged, take};
use super::input::Input;
use crate::text::LocatedFault;

/// The numbers with which a frame begins, before GROMACS 2023 and since then.
const MAGIC: [u32; 2] = [1995, 2023];
/// The bytes of a header, and of what stands between it and compressed positions, whose size has four bytes more in
/// frames of the newer kind.
const HEADER: u64 = 56;
const OF_PACKED: u64 = 36;
/// The most atoms whose positions are not compressed.
const MOST_PLAIN: u32 = 9;
/// The fewest bits of an atom.
const LEAST_BITS: u64 = 2;

/// The start of a frame.
struct Header {
    atoms: u32,
    /// The edges of the box, one after another.
    edges: [f32; 9],
    /// `None` where positions are numbers as they are.
    packed: Option<Packed>,
    /// The size of the positions, without the bytes that fill them up to a multiple of four.
    bytes: u64,
}

/// The compression of a frame.
struct Packed {
    /// The number of whole steps in a nanometer.
    precision: f32,
    range: Range,
}

/// Says whether a file begins so: the number of atoms is told twice.
pub(crate) fn is_like(head: &[u8]) -> bool {
    let word = |at: usize| Some(u32::from_be_bytes(*head.get(at..)?.first_chunk()?));
    word(0).is_some_and(|magic| MAGIC.contains(&magic)) && word(4) == word(52)
}

/// Reads the next frame; `None` at the end of the file.
pub(crate) fn read(input: &mut Input<'_>) -> Result<Option<Frame>, TableError> {
    let frame = input.number + 1;
    let Some(header) = Header::new(input)? else {
        return Ok(None);
    };
    let start = input.position;
    let bytes = take(input, header.bytes.next_multiple_of(4))?;
    let refused = || {
        damaged(format!(
            "the positions of frame {frame} at byte {start} are damaged"
        ))
    };
    let positions = match &header.packed {
        None => {
            let (numbers, _) = bytes.as_chunks();
            let numbers = numbers.iter().map(|bytes| f32::from_be_bytes(*bytes));
            let numbers: Vec<f32> = numbers.collect();
            numbers.as_chunks().0.to_vec()
        }
        Some(Packed { precision, range }) => {
            let atoms = range.unpack(&bytes[..header.bytes as usize], header.atoms as usize);
            let length = precision.recip();
            let position = |atom: [i32; 3]| atom.map(|number| number as f32 * length);
            atoms
                .ok_or_else(refused)?
                .into_iter()
                .map(position)
                .collect()
        }
    };
    input.number = frame;
    Ok(Some(Frame {
        positions,
        cell: header.cell(frame),
    }))
}

/// Passes over the next frame; returns whether there was one.
pub(crate) fn skip(input: &mut Input<'_>) -> Result<bool, TableError> {
    let Some(header) = Header::new(input)? else {
        return Ok(false);
    };
    let end = input.position + header.bytes.next_multiple_of(4);
    input.skip_to(end, input.number + 1)?;
    Ok(true)
}

impl Header {
    /// Reads the header of the next frame, all of whose bytes are there; `None` at the end of the file.
    fn new(input: &mut Input<'_>) -> Result<Option<Self>, TableError> {
        let (frame, start) = (input.number + 1, input.position);
        let size = input.size().unwrap_or(0);
        let left = size.saturating_sub(start);
        if left == 0 {
            return Ok(None);
        }
        let refused = |expected: &str| {
            damaged(format!(
                "expected {expected} in frame {frame} at byte {start}, found others"
            ))
        };
        let head = take(input, HEADER)?;
        let [magic, atoms, _, _, edges @ .., again] = words::<14>(&head);
        if !MAGIC.contains(&magic) {
            return Err(damaged(format!(
                "expected a frame, which begins with 1995 or 2023, at byte {start}, found {magic}"
            )));
        }
        if atoms != again {
            return Err(refused("the same number of atoms twice"));
        }
        let edges = edges.map(f32::from_bits);
        let (packed, bytes) = match atoms {
            0..=MOST_PLAIN => (None, u64::from(atoms) * 12),
            _ => {
                let head = take(input, OF_PACKED)?;
                let [precision, numbers @ .., step, bytes] = words::<9>(&head);
                let [x, y, z, x_end, y_end, z_end] = numbers.map(|number| number as i32);
                let range = Range::new([x, y, z], [x_end, y_end, z_end], step);
                let precision = f32::from_bits(precision);
                if !(precision.is_finite() && precision > 0.0) {
                    return Err(refused("a precision greater than 0"));
                }
                let range =
                    range.ok_or_else(|| refused("a range of positions that are compressed"))?;
                // The upper half comes first.
                let bytes = match magic {
                    2023 => u64::from(bytes) << 32 | u64::from(words::<1>(&take(input, 4)?)[0]),
                    _ => u64::from(bytes),
                };
                (Some(Packed { precision, range }), bytes)
            }
        };
        let left = size.saturating_sub(input.position);
        if bytes > left {
            return Err(damaged(format!(
                "expected {bytes} bytes of positions in frame {frame} at byte {start}, found {left}: the file is cut"
            )));
        }
        if packed.is_some() && u64::from(atoms) > bytes * 8 / LEAST_BITS {
            return Err(damaged(format!(
                "expected the positions of {atoms} atoms in frame {frame} at byte {start}, found {bytes} bytes"
            )));
        }
        Ok(Some(Self {
            atoms,
            edges,
            packed,
            bytes,
        }))
    }

    /// The box of this frame; `None` if all its edges are 0, as they are without a box.
    fn cell(&self, frame: u64) -> Option<ToldCell> {
        if self.edges == [0.0; 9] {
            return None;
        }
        let edges = DMat3::from_cols_array(&self.edges.map(f64::from));
        let cell = Cell::new(edges, DVec3::ZERO);
        Some(cell.map_err(|message| LocatedFault::of_file(format!("{message} in frame {frame}"))))
    }
}

/// The first whole numbers of these bytes; 0 where there are none.
fn words<const COUNT: usize>(bytes: &[u8]) -> [u32; COUNT] {
    let (chunks, _) = bytes.as_chunks();
    let mut words = [0; COUNT];
    for (word, chunk) in words.iter_mut().zip(chunks) {
        *word = u32::from_be_bytes(*chunk);
    }
    words
}
