//! The attributes in the header of a written EXR file: their order, and numbers that are known only after the blocks.
//!
//! Layout: magic number, version, then attributes. Each attribute has a name and a type, both ended by a zero byte, a
//! size, and as many bytes. An empty name ends the list.
//!
//! Source: "OpenEXR File Layout", openexr.com.

use std::ops::Range;

/// Bytes before the first attribute: the magic number and the version.
const PREAMBLE: usize = 8;

/// Sorts the attributes of a file with one part by name.
///
/// The encoder keeps some of them in a hash map, so their order would differ from run to run. Returns `None`, and
/// changes nothing, if the bytes do not have this layout.
pub(crate) fn sort_attributes(file: &mut [u8]) -> Option<()> {
    let mut records = records(file)?;
    let end = records.last().map_or(PREAMBLE, |last| last.end);
    // A name is smaller than the longer ones it begins: its zero byte comes before all letters.
    records.sort_by_key(|record| &file[record.clone()]);
    let sorted: Vec<u8> = records
        .into_iter()
        .flat_map(|record| file[record].iter().copied())
        .collect();
    file[PREAMBLE..end].copy_from_slice(&sorted);
    Some(())
}

/// Replaces the number in the attribute with this name, a double. Returns `None` if there is no such attribute.
pub(crate) fn set_double(file: &mut [u8], name: &str, number: f64) -> Option<()> {
    const BYTES: [u8; 4] = 8_u32.to_le_bytes();
    let start = [name.as_bytes(), b"\0double\0", &BYTES].concat();
    let record = records(file)?
        .into_iter()
        .find(|record| file[record.clone()].starts_with(&start))?;
    file[record.start + start.len()..record.end].copy_from_slice(&number.to_le_bytes());
    Some(())
}

/// The positions of the attributes in a file with one part.
fn records(file: &[u8]) -> Option<Vec<Range<usize>>> {
    let mut records = Vec::new();
    let mut start = PREAMBLE;
    while *file.get(start)? != 0 {
        let end = attribute_end(file, start)?;
        records.push(start..end);
        start = end;
    }
    Some(records)
}

/// The end of the attribute that begins at `start`.
fn attribute_end(file: &[u8], start: usize) -> Option<usize> {
    let mut rest = file.get(start..)?;
    for _name_and_type in 0..2 {
        let zero = rest.iter().position(|&byte| byte == 0)?;
        rest = &rest[zero + 1..];
    }
    let (size, value) = rest.split_first_chunk::<4>()?;
    let size = usize::try_from(u32::from_le_bytes(*size)).ok()?;
    let rest = value.get(size..)?;
    Some(file.len() - rest.len())
}

#[cfg(test)]
mod tests;
