//! PLY, text or little-endian: the element `vertex`, which has to come first.
//!
//! Colors in bytes are sRGB, as programs show them; in floating point they are linear.
//!
//! # Source
//! Greg Turk, "The PLY Polygon File Format", 1994.

use std::ops::Range;

use super::binary::{self, Kind, Layout};
use super::columns::Plan;
use super::error::TableError;
use super::lines::Lines;
use super::request::Request;
use super::rows::Rows;
use super::source::Source;
use super::text::{self, Form};
use crate::text::{LocatedFault, either};

/// The contents of a header.
#[derive(Default)]
struct Header {
    /// `None` before the format is told.
    is_text: Option<bool>,
    /// The number of elements; of those after the first nothing is read.
    elements: usize,
    rows: u64,
    names: Vec<String>,
    kinds: Vec<Kind>,
}

/// Reads the vertices.
pub(crate) fn read(file: Source<'_>, request: &Request) -> Result<Rows, TableError> {
    let mut lines = Lines::new(file)?;
    let header = header(&mut lines)?;
    let kinds = &header.kinds;
    let is_byte = |column: usize| kinds.get(column) == Some(&Kind::U8);
    let plan = Plan::new(header.names, request, is_byte).map_err(|message| {
        LocatedFault::in_line(lines.number, END.as_bytes(), 0..END.len(), message)
    })?;
    if header.is_text == Some(false) {
        let layout = Layout {
            start: lines.position,
            rows: header.rows,
            kinds: header.kinds,
            is_by_column: false,
            noun: "vertices",
        };
        return binary::read(lines.into_file(), &layout, &plan);
    }
    let form = Form {
        separator: None,
        may_be_longer: false,
    };
    let noun = "vertices, as the header says";
    text::read_count(&mut lines, &plan, form, header.rows, noun)
}

/// The line that ends a header.
const END: &str = "end_header";

fn header(lines: &mut Lines<'_>) -> Result<Header, TableError> {
    let mut header = Header::default();
    loop {
        let number = lines.number + 1;
        let Some(line) = lines.next()? else {
            let expected = if number == 1 { "`ply`" } else { "`end_header`" };
            return Err(LocatedFault::at_end(number, expected).into());
        };
        let text = String::from_utf8_lossy(line).into_owned();
        let words: Vec<&str> = text.split_ascii_whitespace().collect();
        let taken = match number {
            1 if words == ["ply"] => Ok(()),
            1 => Err((0, "`ply`, with which PLY files start".to_owned())),
            _ => header.take(&words),
        };
        taken.map_err(|(part, expected)| {
            LocatedFault::expected(number, line, word(line, part), &expected)
        })?;
        if words == [END] {
            return Ok(header);
        }
    }
}

impl Header {
    /// Takes in a line of these words.
    ///
    /// # Errors
    /// Returns the number of the word instead of which something else was expected, and that.
    fn take(&mut self, words: &[&str]) -> Result<(), (usize, String)> {
        const MOST_COLUMNS: usize = 1000;
        let refuse = |part: usize, expected: &str| Err((part, expected.to_owned()));
        match *words {
            ["comment" | "obj_info", ..] | [] => {}
            ["format", form @ ("ascii" | "binary_little_endian"), "1.0"] => {
                self.is_text = Some(form == "ascii");
            }
            ["format", ..] => return refuse(1, "`ascii 1.0` or `binary_little_endian 1.0`"),
            ["element", name, count] => {
                self.elements += 1;
                if self.elements > 1 {
                    return Ok(());
                }
                if name != "vertex" {
                    return refuse(1, "the element `vertex` before all others");
                }
                match count.parse() {
                    Ok(rows) => self.rows = rows,
                    Err(_) => return refuse(2, "the number of vertices"),
                }
            }
            ["property", ..] if self.elements > 1 => {}
            ["property", "list", ..] => return refuse(1, "a number as the property of a vertex"),
            ["property", kind, name] if self.elements == 1 => {
                let Some(kind) = self::kind(kind) else {
                    let expected = format!("a type ({})", either(KINDS.map(|known| known.0)));
                    return refuse(1, &expected);
                };
                if self.names.len() == MOST_COLUMNS {
                    return refuse(0, "at most 1000 properties");
                }
                self.kinds.push(kind);
                self.names.push(name.to_owned());
            }
            [END] if self.is_text.is_none() => return refuse(0, "a line `format …` before"),
            [END] if self.elements == 0 => return refuse(0, "a line `element vertex …` before"),
            [END] => {}
            _ => {
                let known = "`element …`, `property …`, `comment …` or `end_header`";
                return refuse(0, known);
            }
        }
        Ok(())
    }
}

/// The place of a word in a line; its end if there are fewer.
fn word(line: &[u8], number: usize) -> Range<usize> {
    let mut fields = text::Fields::new(line, None);
    for _ in 0..number {
        fields.next();
    }
    fields.next().unwrap_or(line.len()..line.len())
}

/// The kind of number with this name.
fn kind(name: &str) -> Option<Kind> {
    let mut known = KINDS.iter();
    let known = known.find(|known| name == known.0 || name == known.1)?;
    Some(known.2)
}

/// The kinds of numbers, with the names of the format and those that tell their size.
const KINDS: [(&str, &str, Kind); 8] = [
    ("char", "int8", Kind::I8),
    ("uchar", "uint8", Kind::U8),
    ("short", "int16", Kind::I16),
    ("ushort", "uint16", Kind::U16),
    ("int", "int32", Kind::I32),
    ("uint", "uint32", Kind::U32),
    ("float", "float32", Kind::F32),
    ("double", "float64", Kind::F64),
];
