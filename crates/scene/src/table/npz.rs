//! NPZ: NumPy's archives of named arrays, as `savez` and `savez_compressed` write them.
//!
//! Arrays of as many rows as there are spheres are columns by their names: `positions` of shape (n, 3) is x, y and z.
//! An array that is a table by itself is one where there is no other.

use std::borrow::Cow;
use std::fs::File;
use std::io::{self, BufReader, Read};
use std::path::Path;

use flate2::bufread::DeflateDecoder;
use rawzip::{CompressionMethod, ErrorKind, MAX_CENTRAL_DIRECTORY_RECORD_SIZE, ZipArchive};

use super::binary::{self, Column};
use super::columns::{MOST_COLUMNS, components};
use super::compression::{REMEDY, check_count, most_bytes};
use super::error::TableError;
use super::kind::Kind;
use super::npy::{self, Elements, Header};
use super::request::Request;
use super::rows::Rows;
use crate::text::LocatedFault;

pub(crate) const MAGIC: &[u8] = b"PK\x03\x04";

/// An array of the archive.
struct Array {
    name: String,
    header: Header,
    bytes: Vec<u8>,
}

/// Reads the arrays of the archive at `path`.
pub(crate) fn read(path: &Path, request: &Request) -> Result<Rows, TableError> {
    let file = File::open(path)?;
    let stored = file.metadata()?.len();
    let mut left = most_bytes(stored);
    let mut buffer = vec![0; MAX_CENTRAL_DIRECTORY_RECORD_SIZE];
    let archive = ZipArchive::from_file(file, &mut buffer).map_err(refused)?;
    let mut arrays = Vec::new();
    let (mut entries, mut missing) = (archive.entries(&mut buffer), archive.entries_hint());
    while let Some(entry) = entries.next_entry().map_err(refused)? {
        missing = missing.saturating_sub(1);
        let Some(name) = entry.file_path().as_bytes().strip_suffix(b".npy") else {
            continue;
        };
        let name = String::from_utf8_lossy(name).into_owned();
        let (method, is_encrypted) = (entry.compression_method(), entry.flags().is_encrypted());
        let entry = archive.get_entry(entry.wayfinder()).map_err(refused)?;
        let packed = BufReader::new(entry.reader());
        let data: Box<dyn Read> = match method {
            CompressionMethod::STORE if !is_encrypted => Box::new(packed),
            CompressionMethod::DEFLATE if !is_encrypted => Box::new(DeflateDecoder::new(packed)),
            _ => {
                let message =
                    format!("expected arrays that are stored or deflated, found others: `{name}`");
                return Err(LocatedFault::of_file(message).into());
            }
        };
        // Compares size and checksum at the end of the data.
        let mut data = entry.verifying_reader(data);
        if let Some((header, bytes)) = array(&mut data, left)? {
            left -= bytes.len() as u64;
            io::copy(&mut data.take(left), &mut io::sink()).map_err(damaged)?;
            arrays.push(Array {
                name,
                header,
                bytes,
            });
        }
    }
    if missing > 0 {
        let message = format!("expected {missing} more arrays in the archive, found its end");
        return Err(LocatedFault::of_file(message).into());
    }
    let rows = rows(&arrays).ok_or_else(|| {
        let names: Vec<&str> = arrays.iter().map(|array| &*array.name).collect();
        let expected = "arrays of as many rows as there are spheres";
        LocatedFault::of_file(format!("expected {expected}, found {}", listed(&names)))
    })?;
    check_count(stored, rows, "rows")?;
    let (mut names, mut columns) = (Vec::new(), Vec::new());
    let is_alone = arrays.len() == 1;
    for array in arrays.iter().filter(|array| array.header.shape[0] == rows) {
        add_columns(array, is_alone, &mut names, &mut columns)?;
    }
    let kinds: Vec<Kind> = columns.iter().map(|column| column.kind).collect();
    let plan = binary::plan(names, &kinds, request).map_err(LocatedFault::of_file)?;
    binary::read_columns(&columns, rows, &plan)
}

/// An array that may be a column, or several; `None` of others.
fn array(file: &mut dyn Read, most: u64) -> Result<Option<(Header, Vec<u8>)>, TableError> {
    let header = npy::header_of(file)?;
    let is_known = match &header.elements {
        Elements::Plain(kind) => !matches!(kind, Kind::Other(_)),
        Elements::Records(_) => true,
    };
    if !is_known || !matches!(header.shape.len(), 1 | 2) {
        return Ok(None);
    }
    let size = match &header.elements {
        Elements::Plain(kind) => kind.size(),
        Elements::Records(fields) => fields.iter().map(|(_, kind)| kind.size()).sum(),
    };
    let all = header
        .shape
        .iter()
        .try_fold(size, |all, side| all.checked_mul(*side));
    let all = all.ok_or(TableError::OutOfMemory(header.shape[0]))?;
    if all > most {
        let message =
            format!("expected arrays of at most {most} bytes more, found {all}: {REMEDY}");
        return Err(LocatedFault::of_file(message).into());
    }
    // What is read decides, not what the header claims.
    let mut bytes = Vec::new();
    file.take(all).read_to_end(&mut bytes).map_err(damaged)?;
    if (bytes.len() as u64) < all {
        let message = format!("expected an array of {all} bytes, found {}", bytes.len());
        return Err(LocatedFault::of_file(message).into());
    }
    Ok(Some((header, bytes)))
}

/// The number of spheres: of rows of positions, or else of those that most arrays have.
fn rows(arrays: &[Array]) -> Option<u64> {
    let shape = |array: &Array| array.header.shape.clone();
    let is_position = |array: &&Array| match shape(array)[..] {
        [_, 3] => components(&array.name, 3)[0] == "x",
        [_] => array.name.eq_ignore_ascii_case("x"),
        _ => false,
    };
    let positions = arrays.iter().find(is_position);
    let triples = || {
        arrays
            .iter()
            .find(|array| matches!(shape(array)[..], [_, 3]))
    };
    let any = positions.or_else(triples).or_else(|| arrays.first());
    any.map(|array| array.header.shape[0])
}

/// Adds the columns that an array is.
fn add_columns<'a>(
    array: &'a Array,
    is_alone: bool,
    names: &mut Vec<String>,
    columns: &mut Vec<Column<'a>>,
) -> Result<(), LocatedFault> {
    let header = &array.header;
    let rows = header.shape[0] as usize;
    let (own, kinds) = match (&header.elements, header.shape.get(1)) {
        _ if is_alone
            && (header.shape.len() == 2 || matches!(header.elements, Elements::Records(_))) =>
        {
            let (_, names, kinds) = header.columns()?;
            (names, kinds)
        }
        (Elements::Plain(kind), count) => {
            let count = count.copied().unwrap_or(1);
            if count > (MOST_COLUMNS - names.len().min(MOST_COLUMNS)) as u64 {
                return Ok(());
            }
            (components(&array.name, count), vec![*kind; count as usize])
        }
        (Elements::Records(fields), None) => fields.iter().cloned().unzip(),
        _ => return Ok(()),
    };
    let stride: u64 = kinds.iter().map(|kind| kind.size()).sum();
    let mut before = 0;
    for (name, kind) in own.into_iter().zip(kinds) {
        let size = kind.size() as usize;
        let (offset, step) = match header.is_by_column {
            true => (before * rows, size),
            false => (before, stride as usize),
        };
        names.push(name);
        columns.push(Column {
            kind,
            bytes: Cow::Borrowed(&array.bytes),
            offset,
            step,
            start: 0,
        });
        before += size;
    }
    Ok(())
}

fn listed(names: &[&str]) -> String {
    match names {
        [] => String::from("none"),
        _ => names.join(", "),
    }
}

fn refused(error: rawzip::Error) -> TableError {
    match error.into_kind() {
        ErrorKind::IO(error) => error.into(),
        other => {
            let other = rawzip::Error::from(other);
            let message = format!("expected an archive of arrays, found a broken one: {other}");
            LocatedFault::of_file(message).into()
        }
    }
}

/// What is wrong with the data of an array.
fn damaged(error: io::Error) -> TableError {
    match error.downcast() {
        Ok(error) => refused(error),
        Err(error) => error.into(),
    }
}
