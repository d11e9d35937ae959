//! Rows of bytes, each value at its place.

use std::borrow::Cow;
use std::io::{ErrorKind, Read};

use marbles_core::parallel;

use super::array::Column;
pub(crate) use super::columns::plan_of_kinds as plan;
use super::columns::{Plan, Slot, Test};
use super::contents::Contents;
use super::element;
use super::elements::Atom;
use super::error::TableError;
use super::input::Input;
use super::kind::Kind;
use super::paint::Paint;
use super::request::Coloring;
use super::rows::{Numbers, Pushed, Row, Rows};
use crate::text::{LocatedFault, Place, show};

/// The arrangement of the values of a table.
#[derive(Clone, Debug)]
pub(crate) struct Layout {
    /// The byte of the file at which the table starts, which comes next.
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
    fn check(&self, size: Option<u64>) -> Result<(), LocatedFault> {
        check_row(self.rows, self.noun, &self.kinds)?;
        let stride = self.stride();
        let behind = size.unwrap_or(0).saturating_sub(self.start);
        let needed = self.rows.checked_mul(stride);
        let is_short = needed.is_none_or(|needed| needed > behind);
        if is_short && (size.is_some() || needed.is_none()) {
            let message = format!("{}, found {behind}", self.expected());
            return Err(LocatedFault::of_file(message));
        }
        if stride > BLOCK {
            let message = format!("expected rows of at most {BLOCK} bytes, found {stride}");
            return Err(LocatedFault::of_file(message));
        }
        Ok(())
    }
}

/// Refuses rows without bytes, of which a file of any size has as many as its header says.
fn check_row(rows: u64, noun: &str, kinds: &[Kind]) -> Result<(), LocatedFault> {
    if rows > 0 && kinds.iter().all(|kind| kind.size() == 0) {
        let message = format!("expected {noun} of at least 1 byte, found {rows} of none");
        return Err(LocatedFault::of_file(message));
    }
    Ok(())
}

/// About the part of the file that is held at a time, and the longest row, in bytes.
const BLOCK: u64 = 1 << 21;

/// Rows that are decoded as one piece of work.
const PIECE: usize = 1 << 13;

/// Reads a table.
pub(crate) fn read(
    input: &mut Input<'_>,
    layout: &Layout,
    plan: &Plan,
) -> Result<Rows, TableError> {
    let size = input.size();
    layout.check(size)?;
    input.check_count(layout.rows, layout.noun)?;
    let stride = layout.stride();
    let mut rows = Rows::new(plan);
    let is_known = size.is_some() && plan.filters.is_empty();
    rows.reserve(if is_known { layout.rows } else { 0 })?;
    if layout.is_by_column && !input.can_seek() {
        let columns = whole_columns(input, layout)?;
        return read_columns(&columns, layout.rows, plan);
    }
    let mut buffer = Vec::new();
    let mut first = 0;
    while first < layout.rows {
        let count = (BLOCK / stride.max(1)).min(layout.rows - first);
        buffer.resize((count * stride) as usize, 0);
        let read = if layout.is_by_column {
            read_parts(input, layout, first, count, &mut buffer)
        } else {
            input.read_exact(&mut buffer)
        };
        read.map_err(|error| match error.kind() {
            ErrorKind::UnexpectedEof => {
                LocatedFault::of_file(format!("{}, found fewer", layout.expected())).into()
            }
            _ => TableError::from(error),
        })?;
        let block = Block {
            plan,
            first,
            count: count as usize,
            values: values(layout, plan, &buffer, (first, count)),
        };
        block.decode_all(&mut rows)?;
        first += count;
    }
    Ok(rows)
}

/// Reads the rows of columns that are in memory.
pub(crate) fn read_columns(
    columns: &[Column<'_>],
    count: u64,
    plan: &Plan,
) -> Result<Rows, TableError> {
    let mut rows = Rows::new(plan);
    append_columns(&mut rows, columns, count, plan)?;
    Ok(rows)
}

/// About as many rows of this size as are held at a time.
pub(crate) fn rows_of_block(size: u64) -> u64 {
    (BLOCK / size.max(1)).max(1)
}

/// Reads rows of columns that are in memory, which follow others of the same table.
pub(crate) fn append_columns(
    rows: &mut Rows,
    columns: &[Column<'_>],
    count: u64,
    plan: &Plan,
) -> Result<(), TableError> {
    let kinds: Vec<Kind> = columns.iter().map(|column| column.kind).collect();
    check_row(count, "rows", &kinds)?;
    let mut values = Vec::new();
    for (index, (uses, column)) in plan.uses.iter().zip(columns).enumerate() {
        values.extend(uses.slots().iter().map(|&slot| Value {
            slot,
            kind: column.kind,
            column: index,
            bytes: &column.bytes,
            offset: column.offset,
            step: column.step,
            place: column.start,
        }));
    }
    let block = Block {
        plan,
        first: rows.read,
        count: count as usize,
        values,
    };
    block.decode_all(rows)
}

/// Reads columns whose values lie side by side, one after another.
fn whole_columns(
    input: &mut Input<'_>,
    layout: &Layout,
) -> Result<Vec<Column<'static>>, TableError> {
    let mut columns = Vec::new();
    for kind in &layout.kinds {
        let start = input.position;
        let size = layout.rows * kind.size();
        let mut bytes = Vec::new();
        input.by_ref().take(size).read_to_end(&mut bytes)?;
        if (bytes.len() as u64) < size {
            let message = format!("{}, found fewer", layout.expected());
            return Err(LocatedFault::of_file(message).into());
        }
        columns.push(Column {
            kind: *kind,
            bytes: Cow::Owned(bytes),
            offset: 0,
            step: kind.size() as usize,
            start: Some(start),
        });
    }
    Ok(columns)
}

/// Reads a part of every column.
fn read_parts(
    input: &mut Input<'_>,
    layout: &Layout,
    first: u64,
    count: u64,
    buffer: &mut [u8],
) -> std::io::Result<()> {
    let mut rest = buffer;
    let mut start = layout.start;
    for kind in &layout.kinds {
        input.skip_to(start + first * kind.size(), 0)?;
        let (part, after) = rest.split_at_mut((count * kind.size()) as usize);
        input.read_exact(part)?;
        rest = after;
        start += layout.rows * kind.size();
    }
    Ok(())
}

/// A value of a row that is needed.
#[derive(Clone, Copy, Debug)]
struct Value<'a> {
    slot: Slot,
    kind: Kind,
    column: usize,
    bytes: &'a [u8],
    /// The place of its first in the bytes, and the way to the next.
    offset: usize,
    step: usize,
    /// The byte of the file at which the bytes start, where they stand there as they are.
    place: Option<u64>,
}

impl Value<'_> {
    /// The bytes that begin with this value of a row.
    #[inline(always)]
    fn at(&self, row: usize) -> &[u8] {
        let bytes = self.bytes.get(self.offset + row * self.step..);
        bytes.unwrap_or_default()
    }
}

/// The atom with this label.
fn atom(label: &[u8]) -> Atom<'_> {
    Atom {
        number: element::of_label(label).unwrap_or(0),
        label,
    }
}

/// The values that are needed of the `count` rows of a block that begins with the row `first`.
fn values<'a>(
    layout: &Layout,
    plan: &Plan,
    bytes: &'a [u8],
    (first, count): (u64, u64),
) -> Vec<Value<'a>> {
    let stride = layout.stride();
    let mut values = Vec::new();
    let (mut offset, mut before) = (0, 0);
    for (column, (uses, kind)) in plan.uses.iter().zip(&layout.kinds).enumerate() {
        let (step, size) = if layout.is_by_column {
            (kind.size(), kind.size() * count)
        } else {
            (stride, kind.size())
        };
        let place = if layout.is_by_column {
            // As if the bytes began where those of this column would.
            layout.start + layout.rows * before + first * kind.size()
        } else {
            layout.start + first * stride + before
        };
        values.extend(uses.slots().iter().map(|&slot| Value {
            slot,
            kind: *kind,
            column,
            bytes,
            offset: offset as usize,
            step: step as usize,
            place: Some(place.saturating_sub(offset)),
        }));
        offset += size;
        before += kind.size();
    }
    values
}

/// Some rows, as they are stored.
struct Block<'a> {
    plan: &'a Plan,
    /// The place of the first row in the table.
    first: u64,
    count: usize,
    values: Vec<Value<'a>>,
}

impl Block<'_> {
    /// Adds all rows, decoded on the threads of the current rayon pool: they do not depend on the thread that
    /// decodes a piece.
    fn decode_all(&self, rows: &mut Rows) -> Result<(), TableError> {
        let count = self.count.div_ceil(PIECE);
        let pieces = parallel::map(count, |index| self.decode(index * PIECE));
        pieces.into_iter().try_for_each(|piece| rows.append(piece?))
    }

    /// The rows of the piece that begins with the row `start` of the block.
    fn decode(&self, start: usize) -> Result<Rows, TableError> {
        let plan = self.plan;
        let end = self.count.min(start + PIECE);
        let mut rows = Rows::new(plan);
        rows.reserve((end - start) as u64)?;
        let mut numbers: Numbers = plan.constants;
        for row in start..end {
            let meets = |(value, test): (&Value<'_>, &Test)| self.meets(row, value, test);
            if !plan.filters.is_empty() && !self.filters().all(meets) {
                rows.read += 1;
                continue;
            }
            let mut label = Cow::Borrowed(&[][..]);
            let mut category = Cow::Borrowed(&[][..]);
            let mut of_element = None;
            for value in &self.values {
                let bytes = value.at(row);
                match value.slot {
                    Slot::Filter(_) => continue,
                    Slot::Contents(column) => {
                        if let Paint::Contents(all) = &mut rows.paint {
                            self.look_at(&mut all[usize::from(column)], value, bytes);
                        }
                        continue;
                    }
                    Slot::Value if plan.coloring == Coloring::Category => {
                        category = value.kind.text(bytes);
                        continue;
                    }
                    Slot::Element => {
                        label = value.kind.text(bytes);
                        of_element = Some(value);
                        continue;
                    }
                    _ => {}
                }
                let number = value.kind.decode(bytes).unwrap_or(f64::NAN);
                if let Some(expected) = plan.refusal(value.slot, number) {
                    let expected = plan.expected(value.column, expected);
                    return Err(self.fault(row, value, &expected, number.to_string()).into());
                }
                numbers[value.slot.index()] = number;
            }
            let atom = match of_element {
                Some(_) => atom(&label),
                None => Atom::NONE,
            };
            if plan.has_element_categories {
                category = Cow::Borrowed(plan.elements.name(atom));
            }
            let pushed = rows.push(
                plan,
                Row {
                    numbers: &numbers,
                    atom,
                    category: &category,
                },
            );
            match (pushed, of_element.or(self.values.first())) {
                (Ok(Pushed::AsItIs), _) | (Ok(_), None) => {}
                (Ok(Pushed::OfUnknown), Some(value)) => {
                    let place = || self.place(row, value);
                    rows.remarks.add_unknown(atom.label, place);
                }
                (Err(expected), Some(value)) => {
                    let found = show(&String::from_utf8_lossy(&label));
                    return Err(self.fault(row, value, expected, found).into());
                }
                (Err(expected), None) => {
                    let message = format!("expected {expected}, found others");
                    return Err(LocatedFault::of_file(message).into());
                }
            }
        }
        Ok(rows)
    }

    /// Adds a value to the contents of its column.
    fn look_at(&self, contents: &mut Contents, value: &Value<'_>, bytes: &[u8]) {
        match value.kind {
            Kind::Other(_) => *contents = Contents::Other,
            kind if matches!(contents, Contents::Texts(_)) => {
                let text = kind.text(bytes);
                match self.plan.element_column == Some(value.column) {
                    true => contents.add_text(self.plan.elements.name(atom(&text))),
                    false => contents.add_text(&text),
                }
            }
            kind => contents.add_number(kind.decode(bytes)),
        }
    }

    /// The values that conditions are on.
    fn filters(&self) -> impl Iterator<Item = (&Value<'_>, &Test)> {
        self.values.iter().filter_map(|value| match value.slot {
            Slot::Filter(filter) => Some((value, &self.plan.filters[usize::from(filter)])),
            _ => None,
        })
    }

    /// Says whether a row meets a condition on a value.
    fn meets(&self, row: usize, value: &Value<'_>, test: &Test) -> bool {
        let bytes = value.at(row);
        match test {
            Test::IsText(wanted) if self.plan.element_column == Some(value.column) => {
                let label = value.kind.text(bytes);
                self.plan.elements.is_called(atom(&label), wanted)
            }
            Test::IsText(wanted) => *value.kind.text(bytes) == *wanted.as_bytes(),
            test => test.holds(value.kind.decode(bytes).unwrap_or(f64::NAN)),
        }
    }

    /// The place of a value of a row.
    fn place(&self, row: usize, value: &Value<'_>) -> Place {
        Place::Row {
            row: self.first + row as u64 + 1,
            column: value.column + 1,
            byte: value
                .place
                .map(|start| start + (value.offset + row * value.step) as u64),
        }
    }

    /// Something else was expected than what this row has there.
    #[cold]
    fn fault(&self, row: usize, value: &Value<'_>, expected: &str, found: String) -> LocatedFault {
        LocatedFault {
            place: self.place(row, value),
            message: format!("expected {expected}, found {found}"),
        }
    }
}
