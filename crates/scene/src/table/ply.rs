//! PLY, text or binary: the element `vertex`, which has to come first.
//!
//! Colors in bytes are sRGB, as programs show them; in floating point they are linear.
//!
//! # Source
//! Greg Turk, "The PLY Polygon File Format", 1994.

use std::ops::Range;

use super::binary::{self, Layout};
use super::error::TableError;
use super::fields::{Division, Fields};
use super::form::Form;
use super::input::Input;
use super::kind::{Kind, Number, Order};
use super::request::Request;
use super::rows::Rows;
use super::text;
use crate::text::{LocatedFault, either};

/// The contents of a header.
#[derive(Default)]
struct Header {
    /// `None` before the format is told.
    format: Option<Format>,
    /// The number of elements; of those after the first nothing is read.
    elements: usize,
    rows: u64,
    names: Vec<String>,
    numbers: Vec<Number>,
}

/// The format of the rows.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
enum Format {
    Text,
    Binary(Order),
}

/// Reads the vertices.
pub(crate) fn read(input: &mut Input<'_>, request: &Request) -> Result<Rows, TableError> {
    let header = header(input)?;
    let order = match header.format {
        Some(Format::Binary(order)) => order,
        _ => Order::Little,
    };
    let kind = |number: &Number| Kind::Number(*number, order);
    let kinds: Vec<Kind> = header.numbers.iter().map(kind).collect();
    let plan = binary::plan(header.names, &kinds, request).map_err(|message| {
        LocatedFault::in_line(input.number, END.as_bytes(), 0..END.len(), message)
    })?;
    if matches!(header.format, Some(Format::Binary(_))) {
        let layout = Layout {
            start: input.position,
            rows: header.rows,
            kinds,
            is_by_column: false,
            noun: "vertices",
        };
        let rows = binary::read(input, &layout, &plan)?;
        if header.elements == 1 && input.has_rest()? && !input.head().trim_ascii().is_empty() {
            let at = input.position;
            input.leave_out(LocatedFault::of_file(format!(
                "bytes follow the last vertex at byte {at}: they are not read"
            )));
        }
        return Ok(rows);
    }
    let form = Form::new(Division::Words);
    let noun = "vertices, according to the header";
    let rows = text::read_count(input, &plan, &form, header.rows, noun)?;
    while header.elements == 1
        && let Some(line) = input.next()?.map(<[u8]>::to_vec)
    {
        if !line.trim_ascii().is_empty() {
            let told = "lines follow the last vertex: they are not read";
            let place = 0..line.len();
            input.leave_out(LocatedFault::in_line(
                input.number,
                &line,
                place,
                told.to_owned(),
            ));
            break;
        }
    }
    Ok(rows)
}

/// The line that ends a header.
const END: &str = "end_header";

fn header(lines: &mut Input<'_>) -> Result<Header, TableError> {
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
            1 => Err((0, "`ply`, the first line of a PLY file".to_owned())),
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
            ["format", "ascii", "1.0"] => self.format = Some(Format::Text),
            ["format", "binary_little_endian", "1.0"] => {
                self.format = Some(Format::Binary(Order::Little));
            }
            ["format", "binary_big_endian", "1.0"] => {
                self.format = Some(Format::Binary(Order::Big));
            }
            ["format", ..] => {
                let known = "`ascii 1.0`, `binary_little_endian 1.0` or `binary_big_endian 1.0`";
                return refuse(1, known);
            }
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
                let Some(number) = self::number(kind) else {
                    let expected = format!("a type ({})", either(KINDS.map(|known| known.0)));
                    return refuse(1, &expected);
                };
                if self.names.len() == MOST_COLUMNS {
                    return refuse(0, "at most 1000 properties");
                }
                self.numbers.push(number);
                self.names.push(name.to_owned());
            }
            [END] if self.format.is_none() => return refuse(0, "a line `format …` before"),
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
    let mut fields = Fields::new(line, &Division::Words);
    for _ in 0..number {
        fields.next();
    }
    fields.next().unwrap_or(line.len()..line.len())
}

/// The kind of number with this name.
fn number(name: &str) -> Option<Number> {
    let mut known = KINDS.iter();
    let known = known.find(|known| name == known.0 || name == known.1)?;
    Some(known.2)
}

/// The kinds of numbers, with the names of the format and those that tell their size.
const KINDS: [(&str, &str, Number); 8] = [
    ("char", "int8", Number::I8),
    ("uchar", "uint8", Number::U8),
    ("short", "int16", Number::I16),
    ("ushort", "uint16", Number::U16),
    ("int", "int32", Number::I32),
    ("uint", "uint32", Number::U32),
    ("float", "float32", Number::F32),
    ("double", "float64", Number::F64),
];
