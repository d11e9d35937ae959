//! Rows of bytes, each value at its place.

use std::fs::Metadata;
use std::io::{ErrorKind, Read, Seek, SeekFrom};

use rayon::prelude::*;

use super::columns::{Plan, Slot};
use super::error::TableError;
use super::rows::{Numbers, Rows};
use super::source::Source;
use crate::text::{LocatedFault, Place};

/// Declares the kinds of numbers.
macro_rules! kinds {
    ($($name:ident($type:ty),)*) => {
        /// The way in which a value is stored, little-endian.
        #[derive(Clone, Copy, Debug, Eq, PartialEq)]
        pub(crate) enum Kind {
            $($name,)*
            /// So many bytes that are no number.
            Other(u64),
        }

        impl Kind {
            /// The size of a value, in bytes.
            pub(crate) fn size(self) -> u64 {
                match self {
                    $(Self::$name => size_of::<$type>() as u64,)*
                    Self::Other(size) => size,
                }
            }

            /// The number at the start of these bytes; none where there are too few.
            #[inline(always)]
            fn decode(self, bytes: &[u8]) -> Option<f64> {
                Some(match self {
                    $(Self::$name => <$type>::from_le_bytes(*bytes.first_chunk()?) as f64,)*
                    Self::Other(_) => return None,
                })
            }
        }
    };
}

kinds! {
    I8(i8),
    U8(u8),
    I16(i16),
    U16(u16),
    I32(i32),
    U32(u32),
    I64(i64),
    U64(u64),
    F32(f32),
    F64(f64),
}

/// The arrangement of the values of a table.
#[derive(Clone, Debug)]
pub(crate) struct Layout {
    /// The byte of the file at which the table starts.
    pub(crate) start: u64,
    pub(crate) rows: u64,
    /// The way in which each column is stored.
    pub(crate) kinds: Vec<Kind>,
    /// All values of a column lie side by side, instead of those of a row; all have one size.
    pub(crate) is_by_column: bool,
    /// The noun for rows in messages.
    pub(crate) noun: &'static str,
}

impl Layout {
    /// The bytes of a row.
    fn stride(&self) -> u64 {
        let sizes = self.kinds.iter().map(|kind| kind.size());
        sizes.fold(0, u64::saturating_add)
    }

    /// The expected size of the table, for messages.
    fn expected(&self) -> String {
        let (rows, noun, stride) = (self.rows, self.noun, self.stride());
        let size = u128::from(rows) * u128::from(stride);
        format!("expected {rows} {noun} of {stride} bytes, {size} bytes in all")
    }

    /// Refuses a table that cannot be read from a file of this size.
    fn check(&self, plan: &Plan, file: &Metadata) -> Result<(), LocatedFault> {
        let stride = self.stride();
        let behind = file.len().saturating_sub(self.start);
        let needed = self.rows.checked_mul(stride);
        let is_short = needed.is_none_or(|needed| needed > behind);
        if is_short && (file.is_file() || needed.is_none()) {
            let message = format!("{}, found {behind}", self.expected());
            return Err(LocatedFault::of_file(message));
        }
        for (column, (slot, kind)) in plan.slots.iter().zip(&self.kinds).enumerate() {
            if slot.is_some() && matches!(kind, Kind::Other(_)) {
                let name = &plan.names[column];
                return Err(LocatedFault::of_file(format!(
                    "expected numbers in the column `{name}`, found something else"
                )));
            }
        }
        if stride > BLOCK {
            let message = format!("expected rows of at most {BLOCK} bytes, found {stride}");
            return Err(LocatedFault::of_file(message));
        }
        Ok(())
    }
}

/// About the part of the file that is held at a time, and the longest row, in bytes.
const BLOCK: u64 = 1 << 21;

/// Rows that are decoded as one piece of work.
const PIECE: usize = 1 << 13;

/// Reads a table.
pub(crate) fn read(mut file: Source<'_>, layout: &Layout, plan: &Plan) -> Result<Rows, TableError> {
    let metadata = file.metadata()?;
    layout.check(plan, &metadata)?;
    let stride = layout.stride();
    let mut rows = Rows::new(plan);
    rows.reserve(if metadata.is_file() { layout.rows } else { 0 })?;
    file.seek(SeekFrom::Start(layout.start))?;
    let mut buffer = Vec::new();
    let mut first = 0;
    while first < layout.rows {
        let count = (BLOCK / stride).min(layout.rows - first);
        buffer.resize((count * stride) as usize, 0);
        let read = if layout.is_by_column {
            read_columns(&mut file, layout, first, count, &mut buffer)
        } else {
            file.read_exact(&mut buffer)
        };
        read.map_err(|error| match error.kind() {
            ErrorKind::UnexpectedEof => {
                LocatedFault::of_file(format!("{}, found fewer", layout.expected())).into()
            }
            _ => TableError::from(error),
        })?;
        let block = Block {
            layout,
            plan,
            stride,
            bytes: &buffer,
            first,
            count: count as usize,
            values: values(layout, plan, stride, count),
        };
        // The rows do not depend on the thread that decodes a piece.
        let starts = (0..block.count).into_par_iter().step_by(PIECE);
        let pieces: Vec<_> = starts.map(|start| block.decode(start)).collect();
        for piece in pieces {
            rows.append(piece?, usize::MAX);
        }
        first += count;
    }
    Ok(rows)
}

/// Reads a part of every column.
fn read_columns(
    file: &mut Source<'_>,
    layout: &Layout,
    first: u64,
    count: u64,
    buffer: &mut [u8],
) -> std::io::Result<()> {
    let mut rest = buffer;
    let mut start = layout.start;
    for kind in &layout.kinds {
        file.seek(SeekFrom::Start(start + first * kind.size()))?;
        let (part, after) = rest.split_at_mut((count * kind.size()) as usize);
        file.read_exact(part)?;
        rest = after;
        start += layout.rows * kind.size();
    }
    Ok(())
}

/// A value of a row that is needed.
#[derive(Clone, Copy, Debug)]
struct Value {
    slot: Slot,
    kind: Kind,
    column: usize,
    /// The place of its first in a block, and the way to the next, in bytes.
    offset: usize,
    step: usize,
}

/// The values that are needed of the `count` rows of a block.
fn values(layout: &Layout, plan: &Plan, stride: u64, count: u64) -> Vec<Value> {
    let mut values = Vec::new();
    let mut offset = 0;
    for (column, (slot, kind)) in plan.slots.iter().zip(&layout.kinds).enumerate() {
        let (step, size) = if layout.is_by_column {
            (kind.size(), kind.size() * count)
        } else {
            (stride, kind.size())
        };
        if let Some(slot) = *slot {
            values.push(Value {
                slot,
                kind: *kind,
                column,
                offset: offset as usize,
                step: step as usize,
            });
        }
        offset += size;
    }
    values
}

/// Some rows, as they are stored.
struct Block<'file> {
    layout: &'file Layout,
    plan: &'file Plan,
    /// Bytes of a row.
    stride: u64,
    bytes: &'file [u8],
    /// The place of the first row in the table.
    first: u64,
    count: usize,
    values: Vec<Value>,
}

impl Block<'_> {
    /// The rows of the piece that begins with the row `start` of the block.
    fn decode(&self, start: usize) -> Result<Rows, TableError> {
        let end = self.count.min(start + PIECE);
        let mut rows = Rows::new(self.plan);
        rows.reserve((end - start) as u64)?;
        let mut numbers: Numbers = [0.0; Slot::COUNT];
        for row in start..end {
            for value in &self.values {
                let bytes = self.bytes.get(value.offset + row * value.step..);
                let number = bytes.and_then(|bytes| value.kind.decode(bytes));
                let number = number.unwrap_or(f64::NAN);
                if let Some(expected) = value.slot.refusal(number, self.plan.is_encoded) {
                    let expected = self.plan.expected(value.column, expected);
                    return Err(self.fault(row, value.column, &expected, number).into());
                }
                numbers[value.slot as usize] = number;
            }
            let atom = numbers[Slot::Element as usize];
            if let Err(expected) = rows.push(self.plan, &numbers, atom as u8) {
                let mut values = self.values.iter();
                let element = values.find(|value| value.slot == Slot::Element);
                let column = element.map_or(0, |value| value.column);
                return Err(self.fault(row, column, expected, atom).into());
            }
        }
        Ok(rows)
    }

    /// Something else was expected than this number.
    #[cold]
    fn fault(&self, row: usize, column: usize, expected: &str, number: f64) -> LocatedFault {
        let layout = self.layout;
        let row = self.first + row as u64;
        let before: u64 = layout.kinds[..column].iter().map(|kind| kind.size()).sum();
        let byte = if layout.is_by_column {
            layout.rows * before + row * layout.kinds[column].size()
        } else {
            row * self.stride + before
        };
        LocatedFault {
            place: Place::Row {
                row: row + 1,
                column: column + 1,
                byte: layout.start + byte,
            },
            message: format!("expected {expected}, found {number}"),
        }
    }
}
