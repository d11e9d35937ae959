//! NPY, the arrays of NumPy: rows of x, y, z and more, or records whose fields have names.
//!
//! # Source
//! The format is described at `numpy.lib.format`.

use std::fmt::Display;
use std::io::{ErrorKind, Read};

use super::binary::{self, Layout};
use super::columns::{MOST_COLUMNS, components};
use super::error::TableError;
use super::input::Input;
use super::kind::{Kind, Number, Order};
use super::python::Literal;
use super::request::Request;
use super::rows::Rows;
use crate::text::{LocatedFault, show};

pub(crate) const MAGIC: &[u8] = b"\x93NUMPY";
/// The longest header that is read, in bytes.
const LONGEST_HEADER: u64 = 1 << 20;

/// The contents of an array's header.
#[derive(Clone, Debug)]
pub(crate) struct Header {
    pub(crate) elements: Elements,
    pub(crate) shape: Vec<u64>,
    /// The first index is that of neighbors, not the last.
    pub(crate) is_by_column: bool,
}

/// The elements of an array.
#[derive(Clone, Debug)]
pub(crate) enum Elements {
    Plain(Kind),
    /// Names and kinds of fields.
    Records(Vec<(String, Kind)>),
}

/// Reads the next of an array's tables; `None` behind the last one.
pub(crate) fn read(
    input: &mut Input<'_>,
    array: &Array,
    request: &Request,
) -> Result<Option<Rows>, TableError> {
    if input.position >= array.end() {
        return Ok(None);
    }
    let (rows, names, kinds) = array.header.columns()?;
    let plan = binary::plan(names, &kinds, request).map_err(LocatedFault::of_file)?;
    let layout = Layout {
        start: input.position,
        rows,
        is_by_column: array.header.is_by_column,
        kinds,
        noun: "rows",
    };
    binary::read(input, &layout, &plan).map(Some)
}

/// An array of one table, or of several one behind another.
#[derive(Clone, Debug)]
pub(crate) struct Array {
    /// The header of each.
    header: Header,
    /// The byte at which the first begins.
    start: u64,
    pub(crate) tables: u64,
    /// The bytes of each.
    size: u64,
}

impl Array {
    /// Reads what stands before the numbers.
    pub(crate) fn new(input: &mut Input<'_>) -> Result<Self, TableError> {
        let mut header = header_of(input)?;
        let mut tables = 1;
        if let ([count, ..], 3, false) =
            (&header.shape[..], header.shape.len(), header.is_by_column)
        {
            tables = *count;
            header.shape.remove(0);
        }
        let (rows, _, kinds) = header.columns()?;
        let row = kinds
            .iter()
            .map(|kind| kind.size())
            .fold(0, u64::saturating_add);
        Ok(Self {
            header,
            start: input.position,
            tables,
            size: rows.saturating_mul(row),
        })
    }

    /// The byte at which the first table begins.
    pub(crate) fn start(&self) -> u64 {
        self.start
    }

    /// The byte behind the last table; one behind the start where tables have none.
    fn end(&self) -> u64 {
        self.start
            .saturating_add(self.tables.saturating_mul(self.size).max(1))
    }

    /// Notes what follows the last table.
    pub(crate) fn check_end(&self, input: &mut Input<'_>) -> Result<(), TableError> {
        if input.has_rest()? {
            let (what, it_is) = match input.head().starts_with(MAGIC) {
                true => ("another array follows the first one", "it is"),
                false => ("bytes follow the array", "they are"),
            };
            let at = input.position;
            input.leave_out(LocatedFault::of_file(format!(
                "{what} at byte {at}: {it_is} not read"
            )));
        }
        Ok(())
    }

    /// The fault of a file that ends within its tables.
    fn cut(&self) -> TableError {
        let expected = format!("{} tables of {} bytes", self.tables, self.size);
        fault(&expected, "the end of the file").into()
    }

    /// Passes over the next table; returns whether there was one.
    ///
    /// # Errors
    /// A file that ends within it, so that no header asks for more tables than there are.
    pub(crate) fn skip(&self, input: &mut Input<'_>) -> Result<bool, TableError> {
        if input.position >= self.end() {
            return Ok(false);
        }
        let next = input.position.saturating_add(self.size.max(1));
        if self.size > 0 && input.size().is_some_and(|size| next > size) {
            return Err(self.cut());
        }
        input.skip_to(next, 0).map_err(|error| match error.kind() {
            ErrorKind::UnexpectedEof => self.cut(),
            _ => error.into(),
        })?;
        Ok(true)
    }
}

/// Reads what stands before the numbers.
pub(crate) fn header_of(input: &mut dyn Read) -> Result<Header, TableError> {
    let text = header_text(input)?;
    let refused = |expected: &str| fault(expected, show(text.trim()));
    let literal = Literal::read(&text);
    let literal = literal.ok_or_else(|| refused("a header that describes an array"))?;
    let fields = ["descr", "fortran_order", "shape"].map(|key| literal.get(key));
    let [
        Some(descr),
        Some(Literal::Flag(is_by_column)),
        Some(Literal::List(shape)),
    ] = fields
    else {
        return Err(refused("`descr`, `fortran_order` and `shape` in the header").into());
    };
    let length = |length: &Literal| match length {
        Literal::Whole(length) => Some(*length),
        _ => None,
    };
    let shape: Option<Vec<u64>> = shape.iter().map(length).collect();
    let shape = shape.ok_or_else(|| refused("whole numbers in the shape"))?;
    let (elements, is_by_column) = match descr {
        Literal::Text(kind) => (Elements::Plain(self::kind(kind)?), *is_by_column),
        Literal::List(fields) => (Elements::Records(records(fields)?), false),
        _ => return Err(fault("a type", "none").into()),
    };
    Ok(Header {
        elements,
        shape,
        is_by_column,
    })
}

/// The text of the header.
fn header_text(input: &mut dyn Read) -> Result<String, TableError> {
    /// The bytes before the length: `MAGIC` and two of the version.
    const START: u64 = 8;
    let mut start = Vec::new();
    input.take(START).read_to_end(&mut start)?;
    if !start.starts_with(MAGIC) {
        let found = show(&String::from_utf8_lossy(&start));
        return Err(fault("an NPY file, which starts with \\x93NUMPY", found).into());
    }
    let cut = || fault("a header", "the end of the file");
    let size = match start.get(MAGIC.len()) {
        Some(1) => 2,
        Some(2 | 3) => 4,
        Some(other) => return Err(fault("version 1, 2 or 3 of the format", other).into()),
        None => return Err(cut().into()),
    };
    let mut length = [0; 4];
    if start.len() as u64 != START || input.read_exact(&mut length[..size]).is_err() {
        return Err(cut().into());
    }
    let length = u64::from(u32::from_le_bytes(length));
    if length > LONGEST_HEADER {
        let found = format!("{length} bytes");
        return Err(fault("a header of at most 1 MiB", found).into());
    }
    let mut text = Vec::new();
    input.take(length).read_to_end(&mut text)?;
    if text.len() as u64 != length {
        return Err(cut().into());
    }
    Ok(String::from_utf8_lossy(&text).into_owned())
}

/// The number of rows, and the names and types of the columns.
type Columns = (u64, Vec<String>, Vec<Kind>);

impl Header {
    /// The columns of an array that is a table.
    pub(crate) fn columns(&self) -> Result<Columns, LocatedFault> {
        match &self.elements {
            Elements::Plain(kind) => self.plain(*kind),
            Elements::Records(fields) => {
                let [rows] = self.shape[..] else {
                    return Err(fault("records in an array of one dimension", "more"));
                };
                let (names, kinds) = fields.iter().cloned().unzip();
                Ok((rows, names, kinds))
            }
        }
    }

    /// The columns of an array of numbers.
    fn plain(&self, kind: Kind) -> Result<Columns, LocatedFault> {
        const ALL: [&str; 7] = ["x", "y", "z", "radius", "red", "green", "blue"];
        const WITH_VALUE: [&str; 5] = ["x", "y", "z", "radius", "value"];
        let (rows, columns) = match self.shape[..] {
            [rows, columns] if (3..=MOST_COLUMNS as u64).contains(&columns) => {
                (rows, columns as usize)
            }
            _ => {
                let found: Vec<String> = self.shape.iter().map(u64::to_string).collect();
                let expected = "an array of shape (rows, 3), (rows, 4), (rows, 5), (rows, 7), or of more columns";
                return Err(fault(expected, format!("({})", found.join(", "))));
            }
        };
        let names: Vec<String> = match columns {
            3 | 4 | 7 => ALL[..columns].iter().copied().map(String::from).collect(),
            5 => WITH_VALUE.map(String::from).into(),
            // `columns` of the scene file tells what they are.
            _ => (1..=columns).map(|column| column.to_string()).collect(),
        };
        Ok((rows, names, vec![kind; columns]))
    }
}

/// The fields of records.
fn records(fields: &[Literal]) -> Result<Vec<(String, Kind)>, LocatedFault> {
    let mut columns: Vec<(String, Kind)> = Vec::new();
    for field in fields {
        let Literal::List(parts) = field else {
            return Err(no_field());
        };
        let (name, kind, count) = match &parts[..] {
            [Literal::Text(name), Literal::Text(kind)] => (name, kind, 1),
            [
                Literal::Text(name),
                Literal::Text(kind),
                Literal::List(shape),
            ] => (name, kind, count(name, shape)?),
            _ => return Err(no_field()),
        };
        let kind = self::kind(kind)?;
        if count > (MOST_COLUMNS - columns.len()) as u64 {
            let expected = format!("at most {MOST_COLUMNS} values in a record");
            return Err(fault(&expected, "more"));
        }
        let names = match (name.to_ascii_lowercase().as_str(), count) {
            ("center", 3) => components("position", count),
            ("rgb", 3) => components("color", count),
            _ => components(name, count),
        };
        columns.extend(names.into_iter().map(|name| (name, kind)));
    }
    Ok(columns)
}

/// The number of values in a field of this shape.
fn count(name: &str, shape: &[Literal]) -> Result<u64, LocatedFault> {
    const MOST_VALUES: u64 = 1000;
    let count = shape.iter().try_fold(1_u64, |all, size| match size {
        Literal::Whole(size) => all.checked_mul(*size),
        _ => None,
    });
    count.filter(|count| *count <= MOST_VALUES).ok_or_else(|| {
        let expected = format!("at most {MOST_VALUES} values in a field");
        fault(&expected, format!("more in {}", show(name)))
    })
}

fn no_field() -> LocatedFault {
    fault("fields `(name, type)`", "something else")
}

/// The type of a field.
fn kind(text: &str) -> Result<Kind, LocatedFault> {
    let (order, kind) = match text.as_bytes().first() {
        Some(b'>') => (Order::Big, &text[1..]),
        Some(b'<' | b'|' | b'=') => (Order::Little, &text[1..]),
        _ => (Order::Little, text),
    };
    let size = |digits: &str| digits.parse::<u64>().ok();
    let known = match kind {
        "b1" | "?" | "u1" => Some(Number::U8),
        "i1" => Some(Number::I8),
        "i2" => Some(Number::I16),
        "u2" => Some(Number::U16),
        "i4" => Some(Number::I32),
        "u4" => Some(Number::U32),
        "i8" => Some(Number::I64),
        "u8" => Some(Number::U64),
        "f2" => Some(Number::F16),
        "f4" => Some(Number::F32),
        "f8" => Some(Number::F64),
        "f12" => Some(Number::F80(12)),
        "f16" => Some(Number::F80(16)),
        _ => None,
    };
    let known = known.map(|number| Kind::Number(number, order));
    let known = known.or_else(|| match kind.split_at_checked(1)? {
        ("S", digits) => size(digits).map(Kind::Text),
        ("U", digits) => size(digits)
            .filter(|count| count.checked_mul(4).is_some())
            .map(|count| Kind::Characters(count, order)),
        ("V" | "M" | "m" | "c", digits) => {
            let digits = digits.split('[').next().unwrap_or_default();
            size(digits).map(Kind::Other)
        }
        _ => None,
    });
    known.ok_or_else(|| fault("a type such as `<f8`, `>f4`, `<i4` or `|u1`", show(text)))
}

fn fault(expected: &str, found: impl Display) -> LocatedFault {
    LocatedFault::of_file(format!("expected {expected}, found {found}"))
}
