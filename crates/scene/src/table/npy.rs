//! NPY, the arrays of NumPy: rows of x, y, z and more, or records whose fields have names.
//!
//! # Source
//! The format is described at `numpy.lib.format`.

use std::io::Read;

use super::binary::{self, Kind, Layout};
use super::columns::Plan;
use super::python::Literal;
use super::rows::Rows;
use super::source::Source;
use super::{Request, TableError, TableFault};
use crate::fault::show;

const MAGIC: &[u8] = b"\x93NUMPY";
/// The longest header that is read, in bytes.
const LONGEST_HEADER: u64 = 1 << 20;

/// Reads a table.
pub(crate) fn read(mut file: Source<'_>, request: &Request) -> Result<Rows, TableError> {
    let (start, header) = header(&mut file)?;
    let literal = Literal::read(&header).ok_or_else(|| {
        fault(format!(
            "expected a header that describes an array, found {}",
            show(header.trim())
        ))
    })?;
    let (descr, order, shape) = (
        literal.get("descr"),
        literal.get("fortran_order"),
        literal.get("shape"),
    );
    let (Some(descr), Some(Literal::Flag(is_by_column)), Some(Literal::List(shape))) =
        (descr, order, shape)
    else {
        let expected = "expected `descr`, `fortran_order` and `shape` in the header";
        return Err(fault(format!("{expected}, found {}", show(header.trim()))).into());
    };
    let (rows, names, kinds) = match descr {
        Literal::Text(kind) => plain(kind, shape)?,
        Literal::List(fields) => records(fields, shape)?,
        _ => return Err(fault(String::from("expected a type, found none")).into()),
    };
    let is_byte = |column: usize| kinds.get(column) == Some(&Kind::U8);
    let plan = Plan::new(names, request, is_byte).map_err(fault)?;
    let layout = Layout {
        start,
        rows,
        is_by_column: *is_by_column && matches!(descr, Literal::Text(_)),
        kinds,
        noun: "rows",
    };
    binary::read(file, &layout, &plan)
}

/// Where the array starts, and the text before it.
fn header(file: &mut Source<'_>) -> Result<(u64, String), TableError> {
    let mut start = [0; 8];
    let mut length = [0; 4];
    let mut read = 0;
    while read < start.len() {
        match file.read(&mut start[read..])? {
            0 => break,
            count => read += count,
        }
    }
    if !start.starts_with(MAGIC) {
        let found = show(&String::from_utf8_lossy(&start[..read]));
        let expected = "expected an NPY file, which starts with \\x93NUMPY";
        return Err(fault(format!("{expected}, found {found}")).into());
    }
    let size = match start[6] {
        1 => 2,
        2 | 3 => 4,
        other => {
            let expected = "expected version 1, 2 or 3 of the format";
            return Err(fault(format!("{expected}, found {other}")).into());
        }
    };
    let cut = || fault(String::from("expected a header, found the end of the file"));
    if read < start.len() || file.read_exact(&mut length[..size]).is_err() {
        return Err(cut().into());
    }
    let length = u64::from(u32::from_le_bytes(length));
    if length > LONGEST_HEADER {
        let expected = "expected a header of at most 1 MiB";
        return Err(fault(format!("{expected}, found {length} bytes")).into());
    }
    let mut text = Vec::new();
    file.by_ref().take(length).read_to_end(&mut text)?;
    if text.len() as u64 != length {
        return Err(cut().into());
    }
    let start = (start.len() + size) as u64 + length;
    Ok((start, String::from_utf8_lossy(&text).into_owned()))
}

type Columns = (u64, Vec<String>, Vec<Kind>);

/// The columns of an array of numbers.
fn plain(kind: &str, shape: &[Literal]) -> Result<Columns, TableFault> {
    let names: Option<(u64, &[&str])> = match *shape {
        [Literal::Whole(rows), Literal::Whole(3)] => Some((rows, &["x", "y", "z"])),
        [Literal::Whole(rows), Literal::Whole(4)] => Some((rows, &["x", "y", "z", "radius"])),
        [Literal::Whole(rows), Literal::Whole(5)] => {
            Some((rows, &["x", "y", "z", "radius", "value"]))
        }
        [Literal::Whole(rows), Literal::Whole(7)] => {
            Some((rows, &["x", "y", "z", "radius", "red", "green", "blue"]))
        }
        _ => None,
    };
    let Some((rows, names)) = names else {
        let expected = "expected an array of shape (rows, 3), (rows, 4), (rows, 5) or (rows, 7)";
        let found: Vec<String> = shape
            .iter()
            .map(|length| match length {
                Literal::Whole(length) => length.to_string(),
                _ => String::from("…"),
            })
            .collect();
        return Err(fault(format!("{expected}, found ({})", found.join(", "))));
    };
    let kind = match kind {
        "<f4" => Kind::F32,
        "<f8" => Kind::F64,
        _ => {
            let expected = "expected numbers of type `<f4` or `<f8`";
            return Err(fault(format!("{expected}, found {}", show(kind))));
        }
    };
    let names: Vec<String> = names.iter().copied().map(String::from).collect();
    let kinds = vec![kind; names.len()];
    Ok((rows, names, kinds))
}

/// The columns of an array of records.
fn records(fields: &[Literal], shape: &[Literal]) -> Result<Columns, TableFault> {
    let [Literal::Whole(rows)] = *shape else {
        return Err(fault(String::from(
            "expected records in an array of one dimension, found more",
        )));
    };
    let (mut names, mut kinds) = (Vec::new(), Vec::new());
    for field in fields {
        let parts = match field {
            Literal::List(parts) => &parts[..],
            _ => &[],
        };
        let (name, kind, count) = match parts {
            [Literal::Text(name), Literal::Text(kind)] => (name, kind, 1),
            [
                Literal::Text(name),
                Literal::Text(kind),
                Literal::List(shape),
            ] => {
                let mut sizes = shape.iter().map(|size| match size {
                    Literal::Whole(size) => Some(*size),
                    _ => None,
                });
                let count = sizes.try_fold(1_u64, |all, size| all.checked_mul(size?));
                const MOST_VALUES: u64 = 1000;
                let Some(count) = count.filter(|count| *count <= MOST_VALUES) else {
                    return Err(fault(format!(
                        "expected at most {MOST_VALUES} values in a field, found more in {}",
                        show(name)
                    )));
                };
                (name, kind, count)
            }
            _ => {
                return Err(fault(String::from(
                    "expected fields `(name, type)`, found something else",
                )));
            }
        };
        let kind = self::kind(kind)?;
        kinds.extend((0..count).map(|_| kind));
        match (name.to_ascii_lowercase().as_str(), count) {
            ("pos" | "position" | "positions" | "center", 3) => {
                names.extend(["x", "y", "z"].map(String::from));
            }
            ("rgb" | "color" | "colour", 3) => {
                names.extend(["red", "green", "blue"].map(String::from));
            }
            (_, 1) => names.push(name.clone()),
            _ => names.extend((1..=count).map(|number| format!("{name}_{number}"))),
        }
    }
    Ok((rows, names, kinds))
}

/// The type of a field.
fn kind(text: &str) -> Result<Kind, TableFault> {
    let characters = |digits: &str, size: u64| {
        let count: Option<u64> = digits.parse().ok();
        count
            .and_then(|count| count.checked_mul(size))
            .map(Kind::Other)
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
        let expected = "expected a little-endian type such as `<f8`, `<f4`, `<i4` or `|u1`";
        fault(format!("{expected}, found {}", show(text)))
    })
}

fn fault(message: String) -> TableFault {
    TableFault::in_header(message)
}
