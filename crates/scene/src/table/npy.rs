//! NPY, the arrays of NumPy: rows of x, y, z and more, or records whose fields have names.
//!
//! # Source
//! The format is described at `numpy.lib.format`.

use std::fmt::Display;
use std::io::Read;

use super::binary::{self, Kind, Layout};
use super::columns::{MOST_COLUMNS, Plan, components};
use super::error::TableError;
use super::python::Literal;
use super::request::Request;
use super::rows::Rows;
use super::source::Source;
use crate::text::{LocatedFault, show};

const MAGIC: &[u8] = b"\x93NUMPY";
/// The longest header that is read, in bytes.
const LONGEST_HEADER: u64 = 1 << 20;

/// Reads a table.
pub(crate) fn read(mut file: Source<'_>, request: &Request) -> Result<Rows, TableError> {
    let (start, header) = header(&mut file)?;
    let refused = |expected: &str| fault(expected, show(header.trim()));
    let literal = Literal::read(&header);
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
    let (rows, names, kinds) = match descr {
        Literal::Text(kind) => plain(kind, shape)?,
        Literal::List(fields) => records(fields, shape)?,
        _ => return Err(fault("a type", "none").into()),
    };
    let is_byte = |column: usize| kinds.get(column) == Some(&Kind::U8);
    let plan = Plan::new(names, request, is_byte).map_err(LocatedFault::of_file)?;
    let layout = Layout {
        start,
        rows,
        is_by_column: *is_by_column && matches!(descr, Literal::Text(_)),
        kinds,
        noun: "rows",
    };
    binary::read(file, &layout, &plan)
}

/// The byte at which the array starts, and the text before it.
fn header(file: &mut Source<'_>) -> Result<(u64, String), TableError> {
    /// The bytes before the length: `MAGIC` and two of the version.
    const START: u64 = 8;
    let mut start = Vec::new();
    file.by_ref().take(START).read_to_end(&mut start)?;
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
    if start.len() as u64 != START || file.read_exact(&mut length[..size]).is_err() {
        return Err(cut().into());
    }
    let length = u64::from(u32::from_le_bytes(length));
    if length > LONGEST_HEADER {
        let found = format!("{length} bytes");
        return Err(fault("a header of at most 1 MiB", found).into());
    }
    let mut text = Vec::new();
    file.by_ref().take(length).read_to_end(&mut text)?;
    if text.len() as u64 != length {
        return Err(cut().into());
    }
    let start = START + size as u64 + length;
    Ok((start, String::from_utf8_lossy(&text).into_owned()))
}

/// The number of rows, and the names and types of the columns.
type Columns = (u64, Vec<String>, Vec<Kind>);

/// The columns of an array of numbers.
fn plain(kind: &str, shape: &[Literal]) -> Result<Columns, LocatedFault> {
    const ALL: [&str; 7] = ["x", "y", "z", "radius", "red", "green", "blue"];
    let (rows, names) = match *shape {
        [Literal::Whole(rows), Literal::Whole(3)] => (rows, &ALL[..3]),
        [Literal::Whole(rows), Literal::Whole(4)] => (rows, &ALL[..4]),
        [Literal::Whole(rows), Literal::Whole(5)] => {
            (rows, &["x", "y", "z", "radius", "value"][..])
        }
        [Literal::Whole(rows), Literal::Whole(7)] => (rows, &ALL[..]),
        _ => {
            let length = |length: &Literal| match length {
                Literal::Whole(length) => length.to_string(),
                _ => String::from("…"),
            };
            let found: Vec<String> = shape.iter().map(length).collect();
            let expected = "an array of shape (rows, 3), (rows, 4), (rows, 5) or (rows, 7)";
            return Err(fault(expected, format!("({})", found.join(", "))));
        }
    };
    let kind = match kind {
        "<f4" => Kind::F32,
        "<f8" => Kind::F64,
        _ => return Err(fault("numbers of type `<f4` or `<f8`", show(kind))),
    };
    let names: Vec<String> = names.iter().copied().map(String::from).collect();
    let kinds = vec![kind; names.len()];
    Ok((rows, names, kinds))
}

/// The columns of an array of records.
fn records(fields: &[Literal], shape: &[Literal]) -> Result<Columns, LocatedFault> {
    let [Literal::Whole(rows)] = *shape else {
        return Err(fault("records in an array of one dimension", "more"));
    };
    let (mut names, mut kinds) = (Vec::new(), Vec::new());
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
        if count > (MOST_COLUMNS - kinds.len()) as u64 {
            let expected = format!("at most {MOST_COLUMNS} values in a record");
            return Err(fault(&expected, "more"));
        }
        kinds.extend((0..count).map(|_| kind));
        names.extend(match (name.to_ascii_lowercase().as_str(), count) {
            ("center", 3) => components("position", count),
            ("rgb", 3) => components("color", count),
            _ => components(name, count),
        });
    }
    Ok((rows, names, kinds))
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
    let characters = |digits: &str, size: u64| {
        let count: u64 = digits.parse().ok()?;
        count.checked_mul(size).map(Kind::Other)
    };
    let (order, kind) = match text.as_bytes().first() {
        Some(b'<' | b'>' | b'|' | b'=') => text.split_at(1),
        _ => ("", text),
    };
    let known = match kind {
        "i1" => Some(Kind::I8),
        "u1" => Some(Kind::U8),
        "b1" => Some(Kind::Other(1)),
        _ if kind.starts_with(['S', 'V']) => characters(&kind[1..], 1),
        _ if order == ">" => None,
        "i2" => Some(Kind::I16),
        "u2" => Some(Kind::U16),
        "i4" => Some(Kind::I32),
        "u4" => Some(Kind::U32),
        "i8" => Some(Kind::I64),
        "u8" => Some(Kind::U64),
        "f2" => Some(Kind::Other(2)),
        "f4" => Some(Kind::F32),
        "f8" => Some(Kind::F64),
        _ if kind.starts_with('U') => characters(&kind[1..], 4),
        _ => None,
    };
    known.ok_or_else(|| {
        let expected = "a little-endian type such as `<f8`, `<f4`, `<i4` or `|u1`";
        fault(expected, show(text))
    })
}

fn fault(expected: &str, found: impl Display) -> LocatedFault {
    LocatedFault::of_file(format!("expected {expected}, found {found}"))
}
