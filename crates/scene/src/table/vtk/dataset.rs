//! The points of a legacy VTK file, and the arrays that have a row for each of them.

use std::borrow::Cow;
use std::io::{self, Read};

use super::super::array::Column;
use super::super::columns::{MOST_COLUMNS, components, marked};
use super::super::error::TableError;
use super::super::fields::{self, Division};
use super::super::input::Input;
use super::super::kind::{Kind, Number};
use super::numbers::{self, Type, binary_numbers, check_length, text_numbers};
use crate::text::LocatedFault;

/// The parts of a dataset that were read.
#[derive(Default)]
pub(super) struct Dataset {
    pub(super) is_binary: bool,
    pub(super) points: u64,
    /// The numbers that follow belong to points, not to cells.
    pub(super) is_of_points: bool,
    /// The number of these points or cells.
    pub(super) rows: u64,
    pub(super) names: Vec<String>,
    pub(super) arrays: Vec<Array>,
    /// The bytes of all arrays.
    held: u64,
    /// The number of arrays that were said to be left out.
    left_out: usize,
}

/// The most arrays that are said to be left out, of which a small file may have millions.
const MOST_LEFT_OUT: usize = 100;

/// Numbers of all points, those of a point side by side.
pub(super) struct Array {
    /// The way in which they are held.
    kind: Kind,
    /// The way in which the file says that they are stored.
    pub(super) declared: Kind,
    /// The number of components.
    pub(super) size: usize,
    pub(super) bytes: Vec<u8>,
    /// The byte of the file at which they start.
    start: u64,
}

impl Array {
    /// A column for each component.
    pub(super) fn columns(&self) -> impl Iterator<Item = Column<'_>> {
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

impl Dataset {
    /// Reads the numbers of points, or passes over those of cells.
    pub(super) fn attribute(
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
    pub(super) fn field(&mut self, input: &mut Input<'_>) -> Result<(), TableError> {
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
                Some((text(name), count(size), count(rows), numbers::kind(kind)))
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
    pub(super) fn take(
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
    pub(super) fn skip(
        &self,
        input: &mut Input<'_>,
        count: u64,
        kind: Type,
    ) -> Result<(), TableError> {
        if !self.is_binary {
            return text_numbers(input, count, |_| Ok(()));
        }
        let all = kind.bytes(count);
        let passed = io::copy(&mut input.by_ref().take(all), &mut io::sink())?;
        check_length(all, passed)
    }

    /// Passes over an array `NAME TYPE` of so many numbers.
    pub(super) fn skip_array(
        &mut self,
        input: &mut Input<'_>,
        count: u64,
    ) -> Result<(), TableError> {
        let number = input.number + 1;
        let line = input.next()?.map(<[u8]>::to_vec).unwrap_or_default();
        let words = fields::all(&line, &Division::Words);
        let kind = words.last().and_then(|word| numbers::kind(word));
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

pub(super) fn text(word: &[u8]) -> String {
    String::from_utf8_lossy(word).into_owned()
}
