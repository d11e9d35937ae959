//! The sections of a legacy VTK file, each of which begins with a line of words.

use super::super::error::TableError;
use super::super::fields::{self, Division};
use super::super::input::Input;
use super::super::kind::Number;
use super::dataset::{Dataset, text};
use super::numbers::{self, Type};
use crate::text::LocatedFault;

/// A line, with its number.
#[derive(Clone, Copy)]
struct Line<'a> {
    number: u64,
    text: &'a [u8],
}

impl Line<'_> {
    /// Something else was expected than this line.
    fn refuse(self, expected: &str) -> TableError {
        LocatedFault::expected(self.number, self.text, 0..self.text.len(), expected).into()
    }
}

/// The kind of a section.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub(super) enum Section {
    /// Numbers of points or cells follow.
    Announcement,
    /// Any other that was read or passed over.
    Known,
    Unknown,
}

impl Dataset {
    /// Reads what the line with this number begins.
    pub(super) fn section(
        &mut self,
        input: &mut Input<'_>,
        (number, text): (u64, &[u8]),
    ) -> Result<Section, TableError> {
        let line = Line { number, text };
        let refuse = |expected: &str| line.refuse(expected);
        let words = fields::all(text, &Division::Words);
        match words[..] {
            [] => {}
            [b"ASCII"] => self.is_binary = false,
            [b"BINARY"] => self.is_binary = true,
            [
                b"DATASET",
                b"POLYDATA" | b"UNSTRUCTURED_GRID" | b"STRUCTURED_GRID",
            ] => {}
            [b"DATASET", ..] => {
                return Err(refuse(
                    "a dataset of points: POLYDATA, UNSTRUCTURED_GRID or STRUCTURED_GRID (ParaView saves the points of \
                     others as CSV, by File > Save Data)",
                ));
            }
            [b"POINTS", points, kind] => {
                self.points = count(points).ok_or_else(|| refuse("the number of points"))?;
                let kind = numbers::kind(kind).ok_or_else(|| refuse("a type of numbers"))?;
                input.check_count(self.points, "points")?;
                let points = self.points;
                self.take(input, "position", (3, points), kind)?;
            }
            [kind @ (b"POINT_DATA" | b"CELL_DATA"), rows] => {
                self.rows = count(rows).ok_or_else(|| refuse("the number of points or cells"))?;
                self.is_of_points = kind == b"POINT_DATA";
                if self.is_of_points && self.rows != self.points {
                    let expected = format!("numbers of all {} points", self.points);
                    return Err(refuse(&expected));
                }
                return Ok(Section::Announcement);
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
                        self.skip_array(input, cells)?;
                        self.skip_array(input, size)?;
                    }
                    false => self.skip(input, size, Type::Number(Number::I32))?,
                }
            }
            [b"CELL_TYPES", cells] => {
                let cells = count(cells).ok_or_else(|| refuse("the number of cells"))?;
                self.skip(input, cells, Type::Number(Number::I32))?;
            }
            [b"LOOKUP_TABLE", _, size] => {
                let size = count(size).ok_or_else(|| refuse("the number of colors"))?;
                let bytes = size.saturating_mul(4);
                self.skip(input, bytes, Type::Number(Number::U8))?;
            }
            [b"METADATA"] => {
                while input
                    .next()?
                    .is_some_and(|line| !line.trim_ascii().is_empty())
                {}
            }
            [b"DIMENSIONS", ..] => {}
            _ => return self.attributes(input, &words, line),
        }
        Ok(Section::Known)
    }

    /// Reads numbers of points, or passes over those of cells.
    fn attributes(
        &mut self,
        input: &mut Input<'_>,
        words: &[&[u8]],
        line: Line<'_>,
    ) -> Result<Section, TableError> {
        let refuse = |expected: &str| line.refuse(expected);
        match *words {
            [b"SCALARS", name, kind, ref size @ ..] => {
                let size = size.first().map_or(Some(1), |size| count(size));
                let size = size.ok_or_else(|| refuse("the number of components"))?;
                let kind = numbers::kind(kind).ok_or_else(|| refuse("a type of numbers"))?;
                pass_lookup_table(input)?;
                self.attribute(input, &text(name), size, kind)?;
            }
            [b"VECTORS" | b"NORMALS", name, kind] => {
                let kind = numbers::kind(kind).ok_or_else(|| refuse("a type of numbers"))?;
                self.attribute(input, &text(name), 3, kind)?;
            }
            [b"TENSORS", name, kind] => {
                let kind = numbers::kind(kind).ok_or_else(|| refuse("a type of numbers"))?;
                self.attribute(input, &text(name), 9, kind)?;
            }
            [b"TENSORS6", name, kind] => {
                let kind = numbers::kind(kind).ok_or_else(|| refuse("a type of numbers"))?;
                self.attribute(input, &text(name), 6, kind)?;
            }
            [b"TEXTURE_COORDINATES", name, size, kind] => {
                let size = count(size).ok_or_else(|| refuse("the number of coordinates"))?;
                let kind = numbers::kind(kind).ok_or_else(|| refuse("a type of numbers"))?;
                self.attribute(input, &text(name), size, kind)?;
            }
            [b"GLOBAL_IDS" | b"PEDIGREE_IDS", name, kind] => {
                let kind = numbers::kind(kind).ok_or_else(|| refuse("a type of numbers"))?;
                self.attribute(input, &text(name), 1, kind)?;
            }
            // Numbers from 0 to 1, or bytes.
            [b"COLOR_SCALARS", name, size] => {
                let size = count(size).ok_or_else(|| refuse("the number of components"))?;
                self.attribute(input, &text(name), size, Type::Color)?;
            }
            [b"FIELD", _, arrays] => {
                let arrays = count(arrays).ok_or_else(|| refuse("the number of arrays"))?;
                for _ in 0..arrays {
                    self.field(input)?;
                }
            }
            _ => return Ok(Section::Unknown),
        }
        Ok(Section::Known)
    }
}

/// The whole number that a word is.
fn count(word: &[u8]) -> Option<u64> {
    str::from_utf8(word).ok()?.parse().ok()
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
