//! Rows of bytes, each value at its place.

use std::io::{ErrorKind, Read, Seek, SeekFrom};

use rayon::prelude::*;

use super::columns::{Plan, Slot};
use super::fault::TablePlace;
use super::rows::{Numbers, Rows};
use super::source::Source;
use super::{TableError, TableFault};

/// How a value is stored, little-endian.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub(crate) enum Kind {
    I8,
    U8,
    I16,
    U16,
    I32,
    U32,
    I64,
    U64,
    F32,
    F64,
    /// So many bytes that are no number.
    Other(u64),
}

impl Kind {
    /// Its size in bytes.
    pub(crate) fn size(self) -> u64 {
        match self {
            Self::I8 | Self::U8 => 1,
            Self::I16 | Self::U16 => 2,
            Self::I32 | Self::U32 | Self::F32 => 4,
            Self::I64 | Self::U64 | Self::F64 => 8,
            Self::Other(size) => size,
        }
    }

    /// The number at the start of these bytes; none where there are too few.
    #[inline(always)]
    fn decode(self, bytes: &[u8]) -> Option<f64> {
        Some(match self {
            Self::I8 => f64::from(i8::from_le_bytes(*bytes.first_chunk()?)),
            Self::U8 => f64::from(u8::from_le_bytes(*bytes.first_chunk()?)),
            Self::I16 => f64::from(i16::from_le_bytes(*bytes.first_chunk()?)),
            Self::U16 => f64::from(u16::from_le_bytes(*bytes.first_chunk()?)),
            Self::I32 => f64::from(i32::from_le_bytes(*bytes.first_chunk()?)),
            Self::U32 => f64::from(u32::from_le_bytes(*bytes.first_chunk()?)),
            Self::I64 => i64::from_le_bytes(*bytes.first_chunk()?) as f64,
            Self::U64 => u64::from_le_bytes(*bytes.first_chunk()?) as f64,
            Self::F32 => f64::from(f32::from_le_bytes(*bytes.first_chunk()?)),
            Self::F64 => f64::from_le_bytes(*bytes.first_chunk()?),
            Self::Other(_) => return None,
        })
    }
}

/// Where the values of a table lie.
#[derive(Clone, Debug)]
pub(crate) struct Layout {
    /// Where the table starts in the file, in bytes.
    pub(crate) start: u64,
    pub(crate) rows: u64,
    /// How each column is stored.
    pub(crate) kinds: Vec<Kind>,
    /// Whether all values of a column lie side by side, instead of those of a row; all of one size.
    pub(crate) is_by_column: bool,
    /// What a row is called in messages.
    pub(crate) noun: &'static str,
}

/// About how much of the file is held at a time, and the longest row, in bytes.
const BLOCK: u64 = 1 << 21;

/// Rows that are decoded as one piece of work.
const PIECE: usize = 1 << 13;

/// Reads a table.
pub(crate) fn read(mut file: Source<'_>, layout: &Layout, plan: &Plan) -> Result<Rows, TableError> {
    let sizes = layout.kinds.iter().map(|kind| kind.size());
    let stride = sizes.fold(0_u64, u64::saturating_add);
    let header = || {
        let Layout { rows, noun, .. } = layout;
        let size = u128::from(*rows) * u128::from(stride);
        format!("expected {rows} {noun} of {stride} bytes, {size} bytes in all")
    };
    let metadata = file.metadata()?;
    let behind = metadata.len().saturating_sub(layout.start);
    let needed = layout.rows.checked_mul(stride);
    let is_short = needed.is_none_or(|needed| needed > behind);
    if is_short && (metadata.is_file() || needed.is_none()) {
        let message = format!("{}, found {behind}", header());
        return Err(TableFault::in_header(message).into());
    }
    for (column, (slot, kind)) in plan.slots.iter().zip(&layout.kinds).enumerate() {
        if slot.is_some() && matches!(kind, Kind::Other(_)) {
            let name = &plan.names[column];
            let message = format!("expected numbers in the column `{name}`, found something else");
            return Err(TableFault::in_header(message).into());
        }
    }
    if stride > BLOCK {
        let message = format!("expected rows of at most {BLOCK} bytes, found {stride}");
        return Err(TableFault::in_header(message).into());
    }
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
        if let Err(error) = read {
            return Err(match error.kind() {
                ErrorKind::UnexpectedEof => {
                    TableFault::in_header(format!("{}, found fewer", header())).into()
                }
                _ => error.into(),
            });
        }
        let block = Block {
            layout,
            plan,
            stride,
            bytes: &buffer,
            first,
            count: count as usize,
            values: values(layout, plan, stride, count),
        };
        // What comes of it does not depend on who decodes which piece.
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
    /// Where its first is in a block, and how far on the next, in bytes.
    offset: usize,
    step: usize,
}

/// The values that are needed of the rows of a block, so many.
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
    fn fault(&self, row: usize, column: usize, expected: &str, number: f64) -> TableFault {
        let layout = self.layout;
        let row = self.first + row as u64;
        let before: u64 = layout.kinds[..column].iter().map(|kind| kind.size()).sum();
        let byte = if layout.is_by_column {
            layout.rows * before + row * layout.kinds[column].size()
        } else {
            row * self.stride + before
        };
        TableFault {
            place: TablePlace::Row {
                row: row + 1,
                column: column + 1,
                byte: layout.start + byte,
            },
            message: format!("expected {expected}, found {number}"),
        }
    }
}
