//! Legacy VTK files: the points of a dataset, and their numbers, text or big-endian.
//!
//! # Source
//! "VTK File Formats", The VTK User's Guide, Kitware.

use std::borrow::Cow;
use std::io::{self, Read};

use super::array::Column;
use super::binary;
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
    arrays: Vec<Array>,
    /// The bytes of all arrays.
    held: u64,
    /// The number of arrays that were said to be left out.
    left_out: usize,
}

/// The most arrays that are said to be left out, of which a small file may have millions.
const MOST_LEFT_OUT: usize = 100;

/// Numbers of all points, those of a point side by side.
struct Array {
    /// The way in which they are held.
    kind: Kind,
    /// The way in which the file says that they are stored.
    declared: Kind,
    /// The number of components.
    size: usize,
    bytes: Vec<u8>,
    /// The byte of the file at which they start.
    start: u64,
}

/// The type of an array's numbers.
#[derive(Clone, Copy)]
enum Type {
    Number(Number),
    /// Eight to a byte in a binary file, from its highest bit.
    Bit,
    /// Bytes that a text writes as fractions of 255.
    Color,
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
                input.check_count(data.points, "points")?;
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
                pass_lookup_table(input)?;
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
                data.attribute(input, &text(name), size, Type::Color)?;
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
                    false => data.skip(input, size, Type::Number(Number::I32))?,
                }
            }
            [b"CELL_TYPES", cells] => {
                let cells = count(cells).ok_or_else(|| refuse("the number of cells"))?;
                data.skip(input, cells, Type::Number(Number::I32))?;
            }
            [b"LOOKUP_TABLE", _, size] => {
                let size = count(size).ok_or_else(|| refuse("the number of colors"))?;
                let bytes = size.saturating_mul(4);
                data.skip(input, bytes, Type::Number(Number::U8))?;
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
    let declared = |array: &Array| std::iter::repeat_n(array.declared, array.size);
    let kinds: Vec<Kind> = data.arrays.iter().flat_map(declared).collect();
    let plan = binary::plan(data.names, &kinds, request).map_err(LocatedFault::of_file)?;
    let mut uses = &plan.uses[..];
    for array in &mut data.arrays {
        let (own, others) = uses.split_at(array.size);
        if own.iter().all(|uses| uses.slots().is_empty()) {
            array.bytes = Vec::new();
        }
        uses = others;
    }
    let columns: Vec<Column<'_>> = data.arrays.iter().flat_map(Array::columns).collect();
    binary::read_columns(&columns, data.points, &plan)
}

/// Passes over the line behind `SCALARS` that names a table of colors; no numbers are taken for it.
fn pass_lookup_table(input: &mut Input<'_>) -> Result<(), TableError> {
    let expected = "`LOOKUP_TABLE …` on the line after `SCALARS …`";
    loop {
        let number = input.number + 1;
        let line = input.next()?;
        let line = line.ok_or_else(|| LocatedFault::at_end(number, expected))?;
        match fields::all(line, &Division::Words).first() {
            None => {}
            Some(word) if word.eq_ignore_ascii_case(b"LOOKUP_TABLE") => return Ok(()),
            Some(_) => {
                return Err(LocatedFault::expected(number, line, 0..line.len(), expected).into());
            }
        }
    }
}

impl Array {
    /// A column for each component.
    fn columns(&self) -> impl Iterator<Item = Column<'_>> {
        let size = self.kind.size() as usize;
        (0..self.size).map(move |component| Column {
            kind: self.kind,
            bytes: Cow::Borrowed(&self.bytes),
            offset: component * size,
            step: self.size * size,
            start: Some(self.start),
        })
    }
}

impl Type {
    /// The way in which numbers of this type are stored, or held where they are bits; big-endian.
    fn kind(self) -> Kind {
        let number = match self {
            Self::Number(number) => number,
            // No codes of colors, which are bytes without a sign.
            Self::Bit => Number::I8,
            Self::Color => Number::U8,
        };
        Kind::Number(number, Order::Big)
    }

    /// The bytes of so many numbers in a binary file.
    fn bytes(self, count: u64) -> u64 {
        match self {
            Self::Bit => count.div_ceil(8),
            _ => count.saturating_mul(self.kind().size()),
        }
    }

    /// The number that a text writes as this.
    ///
    /// # Errors
    /// Returns what was expected instead.
    fn of_text(self, value: f64) -> Result<f64, &'static str> {
        match self {
            // The codes that binary files and VTK itself hold.
            Self::Color if (0.0..=1.0).contains(&value) => Ok((255.0 * value).round()),
            Self::Color => Err("a number from 0 to 1 for `COLOR_SCALARS`"),
            _ => Ok(value),
        }
    }
}

impl Dataset {
    /// Reads the numbers of points, or passes over those of cells.
    fn attribute(
        &mut self,
        input: &mut Input<'_>,
        name: &str,
        size: u64,
        kind: Type,
    ) -> Result<(), TableError> {
        let rows = self.rows;
        match self.is_of_points {
            true => self.take(input, name, (size, rows), kind),
            false => self.skip(input, size.saturating_mul(rows), kind),
        }
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
                    if self.is_of_points && self.left_out < MOST_LEFT_OUT {
                        self.left_out += 1;
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

    /// Reads so many components of so many points, or passes over none and over more than a table may have.
    fn take(
        &mut self,
        input: &mut Input<'_>,
        name: &str,
        (size, rows): (u64, u64),
        kind: Type,
    ) -> Result<(), TableError> {
        let count = size.saturating_mul(rows);
        if size == 0 || size > (MOST_COLUMNS - self.names.len()) as u64 {
            return self.skip(input, count, kind);
        }
        let declared = kind.kind();
        let held = match self.is_binary {
            true => declared,
            false => Kind::little(Number::F64),
        };
        // Texts of digits and spaces take less than the numbers.
        self.held = self.held.saturating_add(count.saturating_mul(held.size()));
        input.check_bytes(self.held, "numbers")?;
        let start = input.position;
        let bytes = match self.is_binary {
            true => binary_numbers(input, count, kind)?,
            false => {
                let mut bytes = Vec::new();
                text_numbers(input, count, |value| {
                    bytes.extend(kind.of_text(value)?.to_le_bytes());
                    Ok(())
                })?;
                bytes
            }
        };
        self.names.extend(components(name, size));
        self.arrays.push(Array {
            kind: held,
            declared,
            size: size as usize,
            bytes,
            start,
        });
        Ok(())
    }

    /// Passes over so many numbers.
    fn skip(&self, input: &mut Input<'_>, count: u64, kind: Type) -> Result<(), TableError> {
        if !self.is_binary {
            return text_numbers(input, count, |_| Ok(()));
        }
        let all = kind.bytes(count);
        let passed = io::copy(&mut input.by_ref().take(all), &mut io::sink())?;
        check_length(all, passed)
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

/// The bytes of so many numbers of a binary file, with a byte for each bit.
fn binary_numbers(input: &mut Input<'_>, count: u64, kind: Type) -> Result<Vec<u8>, TableError> {
    let all = kind.bytes(count);
    let mut bytes = Vec::new();
    input.by_ref().take(all).read_to_end(&mut bytes)?;
    check_length(all, bytes.len() as u64)?;
    let bit = |at: u64| bytes[(at / 8) as usize] >> (7 - at % 8) & 1;
    Ok(match kind {
        Type::Bit => (0..count).map(bit).collect(),
        _ => bytes,
    })
}

/// Refuses numbers that the end of the file cuts.
fn check_length(expected: u64, found: u64) -> Result<(), TableError> {
    if found < expected {
        let message = format!("expected {expected} bytes of numbers, found {found}");
        return Err(LocatedFault::of_file(message).into());
    }
    Ok(())
}

/// Hands out so many numbers of a text; `take` returns what it expects instead of one.
fn text_numbers(
    input: &mut Input<'_>,
    count: u64,
    mut take: impl FnMut(f64) -> Result<(), &'static str>,
) -> Result<(), TableError> {
    let mut found = 0;
    while found < count {
        let number = input.number + 1;
        let expected = format!("{count} numbers ({found} read)");
        let line = input.next()?;
        let line = line.ok_or_else(|| LocatedFault::at_end(number, &expected))?;
        let mut words = fields::Fields::new(line, &Division::Words);
        while let Some(word) = words.next() {
            let taken = match parse(&line[word.clone()], false) {
                Some(value) if found < count => take(value),
                _ => Err(&*expected),
            };
            taken.map_err(|expected| LocatedFault::expected(number, line, word, expected))?;
            found += 1;
        }
    }
    Ok(())
}

fn text(word: &[u8]) -> String {
    String::from_utf8_lossy(word).into_owned()
}

/// The type of this name.
fn kind(name: &[u8]) -> Option<Type> {
    let number = match name.to_ascii_lowercase().as_slice() {
        b"bit" => return Some(Type::Bit),
        b"unsigned_char" => Number::U8,
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
    Some(Type::Number(number))
}
