//! VTK XML files of unstructured grids and polygons (VTU and VTP): their points, and the arrays of points.
//!
//! The tags are read first, then the arrays that are needed, wherever in the file their numbers stand.
//!
//! # Source
//! "VTK File Formats", The VTK User's Guide, Kitware.

mod base64;
mod bytes;
mod collection;
mod document;
mod numbers;
mod tags;

use std::borrow::Cow;

use self::bytes::Bytes;
pub(crate) use self::collection::Collection;
use self::document::{Array, Document, Piece};
use self::numbers::Numbers;
use super::array::{Column, Part};
use super::binary;
use super::columns::{MOST_COLUMNS, Plan, components, marked};
use super::compression::check_bytes;
use super::error::TableError;
use super::input::Input;
use super::kind::Kind;
use super::request::Request;
use super::rows::Rows;
use crate::text::LocatedFault;

/// The bytes at the start of a file in which its kind is sought.
const HEAD: usize = 4096;

/// The points that any file may have, and those that it may have for each of its bytes: pieces may refer to the same numbers.
const FREE_POINTS: u64 = 1 << 17;
const MOST_POINTS_FOR_A_BYTE: u64 = 4;

/// Says whether a file that begins so holds points.
pub(crate) fn is_like(head: &[u8]) -> bool {
    has_type(head, &[b"UnstructuredGrid", b"PolyData"])
}

/// Says whether a file that begins so is a collection.
pub(crate) fn is_collection(head: &[u8]) -> bool {
    has_type(head, &[b"Collection"])
}

/// Says whether a file that begins so has a type among these.
fn has_type(head: &[u8], types: &[&[u8]]) -> bool {
    let head = &head[..head.len().min(HEAD)];
    let Some(start) = memchr::memmem::find(head, b"<VTKFile") else {
        return false;
    };
    let tag = head[start..].split(|&byte| byte == b'>').next();
    let tag = tag.unwrap_or_default();
    head.trim_ascii_start().starts_with(b"<")
        && types.iter().any(|kind| {
            [b'"', b'\''].iter().any(|quote| {
                let value = [&b"type="[..], &[*quote], kind, &[*quote]].concat();
                memchr::memmem::find(tag, &value).is_some()
            })
        })
}

/// Reads the points of all pieces.
pub(crate) fn read(input: &mut Input<'_>, request: &Request) -> Result<Rows, TableError> {
    let stored = input.source().state.size;
    let mut bytes = Bytes::new(input)?;
    let document = Document::read(&mut bytes)?;
    let pieces = &document.pieces;
    let has_points = |piece: &&Piece| piece.points > 0;
    let Some(model) = pieces.iter().find(has_points).or(pieces.first()) else {
        return Err(LocatedFault::of_file("expected `<Piece …>`, found none").into());
    };
    let table = Table::of(model)?;
    let kinds: Vec<Kind> = table.kinds().collect();
    let plan = binary::plan(table.names.clone(), &kinds, request);
    let plan = plan.map_err(LocatedFault::of_file)?;
    let counts = pieces.iter().map(|piece| piece.points);
    let count = counts.fold(0, u64::saturating_add);
    let most = FREE_POINTS.max(stored.saturating_mul(MOST_POINTS_FOR_A_BYTE));
    if count > most {
        let message =
            format!("expected at most {most} points in a file of {stored} bytes, found {count}");
        return Err(LocatedFault::of_file(message).into());
    }
    let mut rows = Rows::new(&plan);
    for piece in pieces.iter().filter(has_points) {
        table.add(piece, &document, &mut bytes, &plan, (stored, &mut rows))?;
    }
    for told in document.left_out {
        input.leave_out(told);
    }
    Ok(rows)
}

/// The columns of all pieces, as the first piece with points has them.
struct Table<'d> {
    arrays: Vec<&'d Array>,
    names: Vec<String>,
}

impl<'d> Table<'d> {
    fn of(piece: &'d Piece) -> Result<Self, LocatedFault> {
        let positions = piece.positions()?;
        let mut table = Self {
            arrays: vec![positions],
            names: components("position", positions.size),
        };
        for array in &piece.arrays {
            if array.size <= (MOST_COLUMNS - table.names.len()) as u64 {
                table.names.extend(components(&array.name, array.size));
                table.arrays.push(array);
            }
        }
        Ok(table)
    }

    /// The type of the numbers in each column.
    fn kinds(&self) -> impl Iterator<Item = Kind> {
        let arrays = self.arrays.iter();
        arrays.flat_map(|array| std::iter::repeat_n(array.kind, array.size as usize))
    }

    /// Adds the rows of a piece.
    fn add(
        &self,
        piece: &Piece,
        document: &Document,
        bytes: &mut Bytes<'_, '_>,
        plan: &Plan,
        (stored, rows): (u64, &mut Rows),
    ) -> Result<(), TableError> {
        let mut uses = &plan.uses[..];
        let mut parts = Vec::new();
        let mut held: u64 = 0;
        for (index, array) in self.arrays.iter().enumerate() {
            let (own, others) = uses.split_at(array.size as usize);
            uses = others;
            if own.iter().all(|uses| uses.slots().is_empty()) {
                parts.push(None);
                continue;
            }
            let found = match index {
                0 => piece.positions()?,
                _ => piece.array(&array.name, array.size)?,
            };
            let size = piece.points.saturating_mul(found.stride());
            held = held.saturating_add(size);
            if document.encoding.is_compressed {
                check_bytes(stored, held, "numbers")?;
            }
            let numbers = Numbers::of(found, piece.points, document, bytes)?;
            parts.push(Some((found, numbers)));
        }
        let used = parts.iter().flatten();
        let stride = used
            .map(|part| part.0.stride())
            .fold(0, u64::saturating_add);
        let most = binary::rows_of_block(stride);
        if plan.filters.is_empty() && rows.read == 0 {
            rows.reserve(piece.points)?;
        }
        let mut first = 0;
        while first < piece.points {
            let count = most.min(piece.points - first);
            let parts = self.arrays.iter().zip(&parts).map(|part| match part {
                (_, Some((array, numbers))) => array.part(numbers, (first, count), bytes),
                (array, None) => Ok(Part::unused(array.kind)),
            });
            let parts: Vec<Part<'_>> = parts.collect::<Result<_, TableError>>()?;
            let columns = self.arrays.iter().zip(&parts);
            let columns = columns.flat_map(|(array, part)| {
                (0..array.size).map(move |component| part.column(array.size, component))
            });
            let columns: Vec<Column<'_>> = columns.collect();
            binary::append_columns(rows, &columns, count, plan)?;
            first += count;
        }
        Ok(())
    }
}

impl Piece {
    fn positions(&self) -> Result<&Array, LocatedFault> {
        let missing = || {
            let message = "expected `<Points>` with an array in this piece, found none";
            self.place.told(message.to_owned())
        };
        self.positions.as_ref().ok_or_else(missing)
    }

    /// The array that another piece has, too.
    fn array(&self, name: &str, size: u64) -> Result<&Array, LocatedFault> {
        let mut arrays = self.arrays.iter();
        let found = arrays.find(|array| array.name == name && array.size == size);
        found.ok_or_else(|| {
            let name = marked(name);
            let message = format!(
                "expected the array {name} of {size} components in this piece as in the first one, found none"
            );
            self.place.told(message)
        })
    }
}

impl Array {
    /// The bytes of a row.
    fn stride(&self) -> u64 {
        self.size.saturating_mul(self.kind.size())
    }

    /// So many rows from one on.
    fn part<'n>(
        &self,
        numbers: &'n Numbers,
        (first, count): (u64, u64),
        bytes: &mut Bytes<'_, '_>,
    ) -> Result<Part<'n>, TableError> {
        match numbers {
            Numbers::Decoded(decoded, kind) => {
                let stride = self.size * kind.size();
                let range = (first * stride) as usize..((first + count) * stride) as usize;
                Ok(Part {
                    kind: *kind,
                    bytes: Cow::Borrowed(decoded.get(range).unwrap_or_default()),
                    start: None,
                    is_constant: false,
                })
            }
            Numbers::Stored(start) => {
                let start = start + first * self.stride();
                bytes.go_to(start)?;
                let taken = bytes.take(count * self.stride())?;
                Ok(Part {
                    kind: self.kind,
                    bytes: Cow::Owned(taken),
                    start: Some(start),
                    is_constant: false,
                })
            }
        }
    }
}
