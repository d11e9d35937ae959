//! NPZ: NumPy's archives of named arrays, as `savez` and `savez_compressed` write them.
//!
//! Arrays of as many rows as there are spheres are columns by their names: `positions` of shape (n, 3) is x, y and z.
//! An array that is a table by itself is one where there is no other.

use std::borrow::Cow;
use std::fs::File;
use std::io::{self, BufReader, Read};
use std::path::Path;

use flate2::bufread::DeflateDecoder;
use rawzip::{
    CompressionMethod, ErrorKind, FileReader, MAX_CENTRAL_DIRECTORY_RECORD_SIZE, ZipArchive,
    ZipEntry,
};

use super::array::Column;
use super::binary;
use super::columns::{MOST_COLUMNS, components};
use super::compression::{REMEDY, check_count, most_bytes};
use super::error::TableError;
use super::kind::Kind;
use super::npy::{self, Elements, Header};
use super::request::Request;
use super::rows::Rows;
use super::unread_arrays;
use crate::text::{LocatedFault, reason, show};

pub(crate) const MAGIC: &[u8] = b"PK\x03\x04";

/// An array of the archive.
struct Array {
    name: String,
    header: Header,
    bytes: Vec<u8>,
}

/// The name and the shape of an array that is no column.
type Other = (String, Vec<u64>);

/// Reads the arrays of the archive at `path`.
pub(crate) fn read(path: &Path, request: &Request) -> Result<Rows, TableError> {
    let file = File::open(path)?;
    let stored = file.metadata()?.len();
    let (arrays, others) = arrays(file, stored)?;
    let rows = rows(&arrays).ok_or_else(|| {
        let names: Vec<&str> = arrays.iter().map(|array| &*array.name).collect();
        let expected = "arrays of as many rows as there are spheres";
        LocatedFault::of_file(format!("expected {expected}, found {}", listed(&names)))
    })?;
    check_count(stored, rows, "rows")?;
    let (mut names, mut columns) = (Vec::new(), Vec::new());
    // A table by itself, unless another array is one that cannot be read.
    let mut shapes = others.iter();
    let is_alone =
        arrays.len() == 1 && !shapes.any(|(name, shape)| unread_arrays::has_purpose(name, shape));
    for array in arrays.iter().filter(|array| array.header.shape[0] == rows) {
        add_columns(array, is_alone, &mut names, &mut columns)?;
    }
    let kinds: Vec<Kind> = columns.iter().map(|column| column.kind).collect();
    let plan = binary::plan(names, &kinds, request).map_err(LocatedFault::of_file)?;
    let mut all = binary::read_columns(&columns, rows, &plan)?;
    let shapes = arrays
        .iter()
        .map(|array| (&*array.name, &*array.header.shape));
    let others = others.iter().map(|(name, shape)| (&**name, &**shape));
    for unread in unread_arrays::of(shapes.chain(others), rows, request) {
        all.remarks.add_guess(unread);
    }
    Ok(all)
}

/// Reads the arrays that may be columns, and the checksums of all members; returns also arrays that are none.
fn arrays(file: File, stored: u64) -> Result<(Vec<Array>, Vec<Other>), TableError> {
    let mut buffer = vec![0; MAX_CENTRAL_DIRECTORY_RECORD_SIZE];
    let archive = ZipArchive::from_file(file, &mut buffer).map_err(refused)?;
    let (mut arrays, mut others) = (Vec::new(), Vec::new());
    let mut names = vec![0; MAX_CENTRAL_DIRECTORY_RECORD_SIZE];
    // Of all members together: they may share their bytes.
    let mut left = Allowance {
        bytes: most_bytes(stored),
        columns: MOST_COLUMNS as u64,
    };
    let (mut entries, mut missing) = (archive.entries(&mut buffer), archive.entries_hint());
    while let Some(entry) = entries.next_entry().map_err(refused)? {
        missing = missing.saturating_sub(1);
        let name = String::from_utf8_lossy(entry.file_path().as_bytes()).into_owned();
        let (method, is_encrypted) = (entry.compression_method(), entry.flags().is_encrypted());
        let checksum = entry.crc32();
        let entry = archive.get_entry(entry.wayfinder()).map_err(refused)?;
        check_copies(&name, checksum, &entry, &mut names)?;
        let packed = BufReader::new(entry.reader());
        let data: Box<dyn Read> = match method {
            CompressionMethod::STORE if !is_encrypted => Box::new(packed),
            CompressionMethod::DEFLATE if !is_encrypted => Box::new(DeflateDecoder::new(packed)),
            // It is none that a table is made of.
            _ if !name.ends_with(".npy") => continue,
            _ => {
                let message =
                    format!("expected arrays that are stored or deflated, found others: `{name}`");
                return Err(LocatedFault::of_file(message).into());
            }
        };
        // Compares size and checksum at the end of the data.
        let mut data = Counted {
            data: entry.verifying_reader(data),
            left: left.bytes,
        };
        let array = match name.strip_suffix(".npy") {
            Some(array) => self::array(&mut data, &mut left.columns)
                .map(|(header, bytes)| Some((array, header, bytes))),
            None => Ok(None),
        };
        let array = array.map_err(|error| in_member(&name, error))?;
        io::copy(&mut data, &mut io::sink()).map_err(|error| in_member(&name, damaged(error)))?;
        left.bytes = data.left;
        match array {
            Some((name, header, Some(bytes))) => arrays.push(Array {
                name: name.to_owned(),
                header,
                bytes,
            }),
            Some((name, header, None)) => others.push((name.to_owned(), header.shape)),
            None => {}
        }
    }
    if missing > 0 {
        let message = format!("expected {missing} more arrays in the archive, found its end");
        return Err(LocatedFault::of_file(message).into());
    }
    Ok((arrays, others))
}

/// The bytes and columns that the members of an archive may still hold.
struct Allowance {
    bytes: u64,
    columns: u64,
}

/// The data of a member, of which no more is read than is left.
struct Counted<R> {
    data: R,
    left: u64,
}

impl<R: Read> Read for Counted<R> {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        let count = self.data.read(buffer)?;
        self.left = self.left.checked_sub(count as u64).ok_or_else(|| {
            io::Error::other(format!(
                "its arrays are too large when decompressed; {REMEDY}"
            ))
        })?;
        Ok(count)
    }
}

/// Compares the checksum in the directory with its copies before and behind the data of a member.
fn check_copies(
    name: &str,
    stored: u32,
    entry: &ZipEntry<'_, FileReader>,
    buffer: &mut [u8],
) -> Result<(), TableError> {
    let before = entry.local_header(buffer).map_err(refused)?;
    let behind = entry.reader().data_descriptor().map_err(refused)?;
    let copy = match behind {
        Some(behind) => behind.crc32(),
        None => before.crc32(),
    };
    if copy == stored {
        return Ok(());
    }
    let message = format!(
        "expected one checksum of {}, found 0x{stored:08x} in the directory and 0x{copy:08x} next to the data: \
         the archive is damaged",
        show(name)
    );
    Err(LocatedFault::of_file(message).into())
}

/// An array that may be a column, or several, and its bytes; `None` for those of others.
fn array(
    file: &mut Counted<impl Read>,
    columns: &mut u64,
) -> Result<(Header, Option<Vec<u8>>), TableError> {
    let header = npy::header_of(file)?;
    let is_known = match &header.elements {
        Elements::Plain(kind) => !matches!(kind, Kind::Other(_)),
        Elements::Records(_) => true,
    };
    if !is_known || !matches!(header.shape.len(), 1 | 2) {
        return Ok((header, None));
    }
    let (size, count) = match &header.elements {
        Elements::Plain(kind) => (Some(kind.size()), 1),
        Elements::Records(fields) => {
            let mut sizes = fields.iter().map(|(_, kind)| kind.size());
            let size = sizes.try_fold(0, u64::checked_add);
            (size, fields.len() as u64)
        }
    };
    *columns = columns.checked_sub(count).ok_or_else(|| {
        let message = format!("expected at most {MOST_COLUMNS} columns in all arrays, found more");
        LocatedFault::of_file(message)
    })?;
    let mut sides = header.shape.iter();
    let all = size.and_then(|size| sides.try_fold(size, |all, side| all.checked_mul(*side)));
    let all = all.ok_or(TableError::OutOfMemory(header.shape[0]))?;
    let most = file.left;
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
    Ok((header, Some(bytes)))
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
    // It was found to be no more than the array has, where that has rows.
    let sizes = kinds.iter().map(|kind| kind.size());
    let stride = sizes.fold(0, u64::saturating_add);
    let mut before: usize = 0;
    for (name, kind) in own.into_iter().zip(kinds) {
        let size = kind.size() as usize;
        let (offset, step) = match header.is_by_column {
            true => (before.saturating_mul(rows), size),
            false => (before, stride as usize),
        };
        names.push(name);
        columns.push(Column {
            kind,
            bytes: Cow::Borrowed(&array.bytes),
            offset,
            step,
            start: Some(0),
        });
        before = before.saturating_add(size);
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
            let message = format!("expected an archive of arrays, found a damaged one: {other}");
            LocatedFault::of_file(message).into()
        }
    }
}

/// The error for the damaged data of an array.
fn damaged(error: io::Error) -> TableError {
    match error.downcast::<rawzip::Error>() {
        Ok(error) => match error.kind() {
            ErrorKind::InvalidChecksum { expected, actual } => {
                let message = format!(
                    "expected the checksum 0x{expected:08x}, found 0x{actual:08x}: the archive is damaged"
                );
                LocatedFault::of_file(message).into()
            }
            _ => refused(error),
        },
        Err(error) => error.into(),
    }
}

/// The error of a member of this name.
fn in_member(name: &str, error: TableError) -> TableError {
    let name = show(name);
    match error {
        TableError::Fault(mut fault) => {
            fault.message.push_str(&format!(" (in the member {name})"));
            fault.into()
        }
        TableError::Unreadable(error) => {
            let why = reason(&error);
            io::Error::new(error.kind(), format!("in its member {name}: {why}")).into()
        }
        error => error,
    }
}
