//! The index of a GSD file: its chunks of numbers, by frame and name.

use std::io::Read;

use super::super::error::TableError;
use super::super::input::Input;
use super::super::kind::{Kind, Number};
use crate::text::{LocatedFault, show};

/// The bytes with which a file begins.
const MAGIC: u64 = 0x65df_65df_65df_65df;
/// The bytes of a header, of an entry of the index, and of each part of the list of names.
const HEADER: usize = 256;
const ENTRY: usize = 32;
const NAME: u64 = 64;

/// The index of a file.
#[derive(Clone, Debug)]
pub(crate) struct File {
    /// The chunks, by frame and name.
    chunks: Vec<Chunk>,
    /// The names of chunks, by their numbers.
    pub(super) names: Vec<String>,
    /// The number of frames.
    pub(crate) frames: u64,
}

/// An array of a frame.
#[derive(Clone, Copy, Debug)]
pub(super) struct Chunk {
    frame: u64,
    /// The number of its name.
    name: usize,
    pub(super) rows: u64,
    /// The numbers of a row.
    pub(super) size: u64,
    pub(super) kind: Kind,
    /// The byte of the file at which it starts.
    pub(super) start: u64,
}

/// Says whether a file begins so, written by a machine of either byte order.
pub(crate) fn is_like(head: &[u8]) -> bool {
    let magic = head.first_chunk().map(|bytes| u64::from_le_bytes(*bytes));
    magic.is_some_and(|magic| magic == MAGIC || magic.swap_bytes() == MAGIC)
}

impl File {
    /// Reads the index of a file.
    pub(crate) fn new(input: &mut Input<'_>) -> Result<Self, TableError> {
        let size = input.size().unwrap_or(0);
        let header = take(input, 0, HEADER as u64)?;
        let long = |at: usize| long(&header, at);
        if long(0) != Some(MAGIC) {
            let expected = "a GSD file of little-endian numbers";
            return Err(refused(format!("expected {expected}, found another file")));
        }
        let fields = [8, 16, 24, 32].map(long);
        let (&[Some(index), Some(entries), Some(list), Some(parts)], Some(version), HEADER) =
            (&fields, word(&header, 44), header.len())
        else {
            let found = header.len();
            return Err(refused(format!(
                "expected a header of {HEADER} bytes, found {found}"
            )));
        };
        let schema = header.get(112..176).map(text).unwrap_or_default();
        if schema != "hoomd" {
            let found = show(&schema);
            return Err(refused(format!(
                "expected the schema \"hoomd\", found {found}"
            )));
        }
        let entries = table(input, "index", index, entries, ENTRY as u64)?;
        let list = table(input, "list of names", list, parts, NAME)?;
        // Before version 2 each name had a part of its own.
        let names: Vec<String> = match version >> 16 {
            0 | 1 => list.chunks(NAME as usize).map(text).collect(),
            _ => list.split(|&byte| byte == 0).map(text).collect(),
        };
        let mut chunks = Vec::new();
        for entry in entries.chunks_exact(ENTRY) {
            match Chunk::new(entry) {
                Some(chunk) => chunks.push(chunk),
                None => break,
            }
        }
        // Of two with the same name, the first one counts.
        chunks.sort_by_key(|chunk| (chunk.frame, chunk.name));
        let frames = chunks.last().map_or(0, |last| last.frame.saturating_add(1));
        if frames > size {
            return Err(refused(format!(
                "expected at most {size} frames in a file of {size} bytes, found {frames}"
            )));
        }
        Ok(Self {
            chunks,
            names: names
                .into_iter()
                .take_while(|name| !name.is_empty())
                .collect(),
            frames,
        })
    }

    /// The chunk of this name in a frame.
    pub(super) fn chunk(&self, frame: u64, name: &str) -> Option<&Chunk> {
        let name = self.names.iter().position(|known| known == name)?;
        let start = self
            .chunks
            .partition_point(|chunk| (chunk.frame, chunk.name) < (frame, name));
        let chunk = self.chunks.get(start);
        chunk.filter(|chunk| (chunk.frame, chunk.name) == (frame, name))
    }

    /// A chunk of this name, of any frame.
    pub(super) fn any(&self, name: &str) -> Option<&Chunk> {
        let name = self.names.iter().position(|known| known == name)?;
        self.chunks.iter().find(|chunk| chunk.name == name)
    }
}

impl Chunk {
    /// The chunk of an entry of the index; `None` behind the last one.
    fn new(entry: &[u8]) -> Option<Self> {
        let start = long(entry, 16).filter(|start| *start > 0)?;
        let name = u16::from_le_bytes(*entry.get(28..)?.first_chunk()?);
        Some(Self {
            frame: long(entry, 0)?,
            rows: long(entry, 8)?,
            start,
            size: u64::from(word(entry, 24)?),
            name: usize::from(name),
            kind: kind(*entry.get(30)?),
        })
    }

    /// So many of its rows from one on.
    pub(super) fn take(
        &self,
        input: &mut Input<'_>,
        (first, count): (u64, u64),
    ) -> Result<Vec<u8>, TableError> {
        let stride = self.stride();
        let range = first
            .checked_mul(stride)
            .and_then(|before| Some((self.start.checked_add(before)?, count.checked_mul(stride)?)));
        let (start, size) = range.ok_or(TableError::OutOfMemory(self.rows))?;
        let taken = take(input, start, size)?;
        if (taken.len() as u64) < size {
            let found = taken.len();
            return Err(refused(format!(
                "expected a chunk of {size} bytes at byte {start}, found {found}: the file is cut or damaged"
            )));
        }
        Ok(taken)
    }

    /// The bytes of a row.
    pub(super) fn stride(&self) -> u64 {
        self.size.saturating_mul(self.kind.size())
    }
}

/// The bytes of a table of the file, which has so many entries of this size.
fn table(
    input: &mut Input<'_>,
    name: &str,
    start: u64,
    entries: u64,
    size: u64,
) -> Result<Vec<u8>, TableError> {
    let all = input.size().unwrap_or(0);
    let bytes = entries.checked_mul(size);
    let bytes = bytes.filter(|bytes| *bytes <= all.saturating_sub(start));
    let Some(bytes) = bytes else {
        return Err(refused(format!(
            "expected {entries} entries of {size} bytes in the {name} at byte {start}, found the end of the file at byte {all}"
        )));
    };
    take(input, start, bytes)
}

/// So many bytes from this place on, or as many as there are.
fn take(input: &mut Input<'_>, start: u64, count: u64) -> Result<Vec<u8>, TableError> {
    // Its number is that of the frame.
    let end = input.size().unwrap_or(u64::MAX);
    input.skip_to(start.min(end), input.number)?;
    let mut bytes = Vec::new();
    input.by_ref().take(count).read_to_end(&mut bytes)?;
    Ok(bytes)
}

/// The kind of numbers of this type.
fn kind(code: u8) -> Kind {
    let number = match code {
        1 => Number::U8,
        2 => Number::U16,
        3 => Number::U32,
        4 => Number::U64,
        5 | 11 => Number::I8,
        6 => Number::I16,
        7 => Number::I32,
        8 => Number::I64,
        9 => Number::F32,
        10 => Number::F64,
        _ => return Kind::Other(0),
    };
    Kind::little(number)
}

/// A text that may end with zeros.
pub(super) fn text(bytes: &[u8]) -> String {
    let text = bytes.split(|&byte| byte == 0).next();
    String::from_utf8_lossy(text.unwrap_or_default()).into_owned()
}

fn long(bytes: &[u8], at: usize) -> Option<u64> {
    Some(u64::from_le_bytes(*bytes.get(at..)?.first_chunk()?))
}

fn word(bytes: &[u8], at: usize) -> Option<u32> {
    Some(u32::from_le_bytes(*bytes.get(at..)?.first_chunk()?))
}

pub(super) fn refused(message: String) -> TableError {
    LocatedFault::of_file(message).into()
}
