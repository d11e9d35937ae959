//! Legacy VTK files: the points of a dataset, and their numbers, text or big-endian.
//!
//! # Source
//! "VTK File Formats", The VTK User's Guide, Kitware.

use std::borrow::Cow;
use std::io::Read;

use super::binary::{self, Column};
use super::columns::{MOST_COLUMNS, components, marked};
use super::error::TableError;
use super::fields::{self, Division};
use super::input::Input;
use super::kind::{Kind, Number, Order};
use super::number::parse;
use super::request::Request;
use super::rows::Rows;
use crate::text::LocatedFault;

pub(crate) const MAGIC: &[u8] = b"# vtk DataFile";

/// The parts of a dataset that were read.
#[derive(Default)]
struct Dataset {
    is_binary: bool,
    points: u64,
    /// The numbers that follow belong to points, not to cells.
    is_of_points: bool,
    /// The number of these points or cells.
    rows: u64,
    names: Vec<String>,
    columns: Vec<Column<'static>>,
}

/// Reads the points.
pub(crate) fn read(input: &mut Input<'_>, request: &Request) -> Result<Rows, TableError> {
    let mut data = Dataset::default();
    for _ in 0..2 {
        input.next()?;
    }
    // The line that says that numbers of points or cells follow, until some do.
    let mut announced = None;
    while let Some(line) = input.next()?.map(<[u8]>::to_vec) {
        let number = input.number;
        if !line.trim_ascii().is_empty() {
            announced = None;
        }
        let words = fields::all(&line, &Division::Words);
        let refuse = |expected: &str| -> TableError {
            LocatedFault::expected(number, &line, 0..line.len(), expected).into()
        };
        let count = |word: &[u8]| str::from_utf8(word).ok()?.parse::<u64>().ok();
        match words[..] {
            [] => {}
            [b"ASCII"] => data.is_binary = false,
            [b"BINARY"] => data.is_binary = true,
            [
                b"DATASET",
                b"POLYDATA" | b"UNSTRUCTURED_GRID" | b"STRUCTURED_GRID",
            ] => {}
            [b"DATASET", ..] => {
                return Err(refuse(
                    "a dataset of points: POLYDATA, UNSTRUCTURED_GRID or STRUCTURED_GRID",
                ));
            }
            [b"POINTS", points, kind] => {
                data.points = count(points).ok_or_else(|| refuse("the number of points"))?;
                let kind = self::kind(kind).ok_or_else(|| refuse("a type of numbers"))?;
                let points = data.points;
                data.take(input, "position", (3, points), kind)?;
            }
            [kind @ (b"POINT_DATA" | b"CELL_DATA"), rows] => {
                data.rows = count(rows).ok_or_else(|| refuse("the number of points or cells"))?;
                data.is_of_points = kind == b"POINT_DATA";
                if data.is_of_points && data.rows != data.points {
                    let expected = format!("numbers of all {} points", data.points);
                    return Err(refuse(&expected));
                }
                announced = Some((number, line.clone()));
            }
            [b"SCALARS", name, kind, ref size @ ..] => {
                let size = size.first().map_or(Some(1), |size| count(size));
                let size = size.ok_or_else(|| refuse("the number of components"))?;
                let kind = self::kind(kind).ok_or_else(|| refuse("a type of numbers"))?;
                // The name of a table of colors.
                input.next()?;
                data.attribute(input, &text(name), size, kind)?;
            }
            [b"VECTORS" | b"NORMALS", name, kind] => {
                let kind = self::kind(kind).ok_or_else(|| refuse("a type of numbers"))?;
                data.attribute(input, &text(name), 3, kind)?;
            }
            [b"TENSORS", name, kind] => {
                let kind = self::kind(kind).ok_or_else(|| refuse("a type of numbers"))?;
                data.attribute(input, &text(name), 9, kind)?;
            }
            [b"TENSORS6", name, kind] => {
                let kind = self::kind(kind).ok_or_else(|| refuse("a type of numbers"))?;
                data.attribute(input, &text(name), 6, kind)?;
            }
            [b"TEXTURE_COORDINATES", name, size, kind] => {
                let size = count(size).ok_or_else(|| refuse("the number of coordinates"))?;
                let kind = self::kind(kind).ok_or_else(|| refuse("a type of numbers"))?;
                data.attribute(input, &text(name), size, kind)?;
            }
            [b"GLOBAL_IDS" | b"PEDIGREE_IDS", name, kind] => {
                let kind = self::kind(kind).ok_or_else(|| refuse("a type of numbers"))?;
                data.attribute(input, &text(name), 1, kind)?;
            }
            // Numbers from 0 to 1, or bytes.
            [b"COLOR_SCALARS", name, size] => {
                let size = count(size).ok_or_else(|| refuse("the number of components"))?;
                let kind = Kind::Number(Number::U8, Order::Big);
                data.attribute(input, &text(name), size, kind)?;
            }
            [b"FIELD", _, arrays] => {
                let arrays = count(arrays).ok_or_else(|| refuse("the number of arrays"))?;
                for _ in 0..arrays {
                    data.field(input)?;
                }
            }
            [
                b"VERTICES" | b"LINES" | b"POLYGONS" | b"TRIANGLE_STRIPS" | b"CELLS",
                cells,
                size,
            ] => {
                let size = count(size).ok_or_else(|| refuse("the number of indices"))?;
                match input
                    .peek()?
                    .is_some_and(|line| line.starts_with(b"OFFSETS"))
                {
                    // The arrays of version 5, offsets and connectivity.
                    true => {
                        let cells = count(cells).ok_or_else(|| refuse("the number of cells"))?;
                        data.skip_array(input, cells)?;
                        data.skip_array(input, size)?;
                    }
                    false => data.skip(input, size, Kind::Number(Number::I32, Order::Big))?,
                }
            }
            [b"CELL_TYPES", cells] => {
                let cells = count(cells).ok_or_else(|| refuse("the number of cells"))?;
                data.skip(input, cells, Kind::Number(Number::I32, Order::Big))?;
            }
            [b"LOOKUP_TABLE", _, size] => {
                let size = count(size).ok_or_else(|| refuse("the number of colors"))?;
                data.skip(
                    input,
                    size.saturating_mul(4),
                    Kind::Number(Number::U8, Order::Big),
                )?;
            }
            [b"METADATA"] => {
                while input
                    .next()?
                    .is_some_and(|line| !line.trim_ascii().is_empty())
                {}
            }
            [b"DIMENSIONS", ..] => {}
            // Spheres need no more than what was read.
            _ if !data.names.is_empty() => {
                let told = "not a section of a legacy VTK file: the rest of the file is not read";
                let place = 0..line.len();
                input.leave_out(LocatedFault::in_line(number, &line, place, told.to_owned()));
                break;
            }
            _ => return Err(refuse("a section of a legacy VTK file")),
        }
    }
    if let Some((number, line)) = announced {
        let doubt = "the file ends after a header for numbers of points or cells: the numbers may have been cut off";
        input.doubt(LocatedFault::in_line(
            number,
            &line,
            0..line.len(),
            doubt.to_owned(),
        ));
    }
    if data.names.is_empty() {
        return Err(LocatedFault::at_end(input.number + 1, "`POINTS …`").into());
    }
    let kinds: Vec<Kind> = data.columns.iter().map(|column| column.kind).collect();
    let plan = binary::plan(data.names, &kinds, request).map_err(LocatedFault::of_file)?;
    binary::read_columns(&data.columns, data.points, &plan)
}

impl Dataset {
    /// Reads the numbers of points, or passes over those of cells.
    fn attribute(
        &mut self,
        input: &mut Input<'_>,
        name: &str,
        size: u64,
        kind: Kind,
    ) -> Result<(), TableError> {
        let rows = self.rows;
        self.take(input, name, (size, rows), kind)
    }

    /// Reads an array of a field.
    fn field(&mut self, input: &mut Input<'_>) -> Result<(), TableError> {
        let mut line = input.next()?.map(<[u8]>::to_vec);
        while line
            .as_ref()
            .is_some_and(|line| line.trim_ascii().is_empty())
        {
            line = input.next()?.map(<[u8]>::to_vec);
        }
        // What is told of the array before it.
        if line
            .as_ref()
            .is_some_and(|line| line.starts_with(b"METADATA"))
        {
            while input
                .next()?
                .is_some_and(|line| !line.trim_ascii().is_empty())
            {}
            line = input.next()?.map(<[u8]>::to_vec);
        }
        let number = input.number;
        let expected = "an array `NAME COMPONENTS COUNT TYPE`";
        let line = line.ok_or_else(|| LocatedFault::at_end(number + 1, expected))?;
        let words = fields::all(&line, &Division::Words);
        let count = |word: &[u8]| str::from_utf8(word).ok()?.parse::<u64>().ok();
        let array = match words[..] {
            [name, size, rows, kind] => {
                Some((text(name), count(size), count(rows), self::kind(kind)))
            }
            _ => None,
        };
        match array {
            Some((name, Some(size), Some(rows), Some(kind))) => {
                if rows == self.points && self.is_of_points {
                    self.take(input, &name, (size, rows), kind)
                } else {
                    if self.is_of_points {
                        let (points, shown) = (self.points, marked(&name));
                        let told = format!(
                            "the array {shown} has {rows} rows, but there are {points} points: it is not read"
                        );
                        let place = 0..line.len();
                        input.leave_out(LocatedFault::in_line(number, &line, place, told));
                    }
                    self.skip(input, size.saturating_mul(rows), kind)
                }
            }
            _ => Err(LocatedFault::expected(number, &line, 0..line.len(), expected).into()),
        }
    }

    /// Reads so many components of so many points.
    fn take(
        &mut self,
        input: &mut Input<'_>,
        name: &str,
        (size, rows): (u64, u64),
        kind: Kind,
    ) -> Result<(), TableError> {
        let start = input.position;
        let (bytes, kind) = self.numbers(input, size.saturating_mul(rows), kind)?;
        let is_needed = name == "position" || self.is_of_points;
        if !is_needed || size > (MOST_COLUMNS - self.names.len()) as u64 {
            return Ok(());
        }
        let step = kind.size() * size;
        for (component, name) in (0..).zip(components(name, size)) {
            self.names.push(name);
            self.columns.push(Column {
                kind,
                bytes: Cow::Owned(column(&bytes, kind, component, step)),
                offset: 0,
                step: kind.size() as usize,
                start,
            });
        }
        Ok(())
    }

    /// Reads so many numbers; those of a text become doubles.
    fn numbers(
        &mut self,
        input: &mut Input<'_>,
        count: u64,
        kind: Kind,
    ) -> Result<(Vec<u8>, Kind), TableError> {
        if self.is_binary {
            let all = count.saturating_mul(kind.size());
            let mut bytes = Vec::new();
            input.by_ref().take(all).read_to_end(&mut bytes)?;
            if (bytes.len() as u64) < all {
                let message = format!("expected {all} bytes of numbers, found {}", bytes.len());
                return Err(LocatedFault::of_file(message).into());
            }
            return Ok((bytes, kind));
        }
        let mut bytes = Vec::new();
        let mut found = 0;
        while found < count {
            let number = input.number + 1;
            let expected = format!("{count} numbers ({found} read)");
            let line = input.next()?;
            let line = line.ok_or_else(|| LocatedFault::at_end(number, &expected))?;
            let mut words = fields::Fields::new(line, &Division::Words);
            while let Some(word) = words.next() {
                let value = parse(&line[word.clone()], false);
                let value = value.filter(|_| found < count);
                let value =
                    value.ok_or_else(|| LocatedFault::expected(number, line, word, &expected))?;
                bytes.extend(value.to_le_bytes());
                found += 1;
            }
        }
        Ok((bytes, Kind::little(Number::F64)))
    }

    fn skip(&mut self, input: &mut Input<'_>, count: u64, kind: Kind) -> Result<(), TableError> {
        self.numbers(input, count, kind).map(|_| ())
    }

    /// Passes over an array `NAME TYPE` of so many numbers.
    fn skip_array(&mut self, input: &mut Input<'_>, count: u64) -> Result<(), TableError> {
        let number = input.number + 1;
        let line = input.next()?.map(<[u8]>::to_vec).unwrap_or_default();
        let words = fields::all(&line, &Division::Words);
        let kind = words.last().and_then(|word| self::kind(word));
        let expected = "an array and its type";
        let kind =
            kind.ok_or_else(|| LocatedFault::expected(number, &line, 0..line.len(), expected))?;
        self.skip(input, count, kind)?;
        if self.is_binary {
            input.next()?;
        }
        Ok(())
    }
}

/// The values of one of several components.
fn column(bytes: &[u8], kind: Kind, component: u64, step: u64) -> Vec<u8> {
    let size = kind.size() as usize;
    let offset = component as usize * size;
    let values = bytes.chunks_exact((step as usize).max(1));
    values
        .flat_map(|all| &all[offset..offset + size])
        .copied()
        .collect()
}

fn text(word: &[u8]) -> String {
    String::from_utf8_lossy(word).into_owned()
}

/// The type of this name; binary numbers are big-endian.
fn kind(name: &[u8]) -> Option<Kind> {
    let number = match name.to_ascii_lowercase().as_slice() {
        b"unsigned_char" | b"bit" => Number::U8,
        b"char" => Number::I8,
        b"unsigned_short" => Number::U16,
        b"short" => Number::I16,
        b"unsigned_int" => Number::U32,
        b"int" => Number::I32,
        b"unsigned_long" | b"vtktypeuint64" => Number::U64,
        b"long" | b"vtktypeint64" | b"vtkidtype" => Number::I64,
        b"float" => Number::F32,
        b"double" => Number::F64,
        _ => return None,
    };
    Some(Kind::Number(number, Order::Big))
}
