//! The header of a file.
//!
//! Layout: `\x93NUMPY`, two bytes of the version, the length of the rest in two bytes or, from version 2, in four; then
//! a dictionary in Python syntax, padding, and a line feed.
//!
//! # Source
//! The format is described at `numpy.lib.format`.

use std::io::Read;

use super::MAGIC;
use super::array::{Array, Number};
use super::stamp::Stamp;
use crate::base::size::Size;

/// The alignment of the array in a file, in bytes.
const ALIGNMENT: usize = 64;
/// The longest accepted header, in bytes; NumPy's own limit for untrusted files is a sixth of it.
const LONGEST: usize = 1 << 16;

/// The contents of a header.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Header {
    pub(super) array: Array,
    /// `None` in files of other programs.
    pub(super) stamp: Option<Stamp>,
    /// The offset of the array in the file, in bytes.
    pub(super) start: u64,
}

/// The bytes of a file before its array.
pub(super) fn bytes(array: &Array, stamp: Option<&Stamp>) -> Vec<u8> {
    const VERSION: [u8; 2] = [1, 0];
    const LENGTH_BYTES: usize = 2;
    let Size { width, height } = array.size;
    let mut shape = format!("{height}, {width}");
    if let Some(channels) = array.channels {
        shape.push_str(&format!(", {channels}"));
    }
    let name = array.number.name();
    let dictionary = format!("{{'descr': '{name}', 'fortran_order': False, 'shape': ({shape}), }}");
    let mut text = dictionary.into_bytes();
    if let Some(stamp) = stamp {
        text.extend(stamp.padding());
    }
    let before = MAGIC.len() + VERSION.len() + LENGTH_BYTES;
    let end = (before + text.len() + 1).next_multiple_of(ALIGNMENT);
    text.resize(end - before - 1, b' ');
    text.push(b'\n');
    // Less than a thousand.
    let length = (text.len() as u16).to_le_bytes();
    [MAGIC, &VERSION, &length, &text].concat()
}

/// Reads the header at the start of a file, or returns an error.
pub(super) fn read(file: &mut impl Read) -> Result<Header, String> {
    const CUT: &str = "its header is cut off";
    let mut start = [0; 8];
    file.read_exact(&mut start).map_err(|_| CUT)?;
    let version = start[MAGIC.len()];
    let length_bytes = match version {
        1 => 2,
        2 | 3 => 4,
        _ => return Err(format!("expected version 1, 2 or 3, found {version}")),
    };
    let mut length = [0; 4];
    file.read_exact(&mut length[..length_bytes])
        .map_err(|_| CUT)?;
    let length = u32::from_le_bytes(length) as usize;
    if length > LONGEST {
        return Err(format!("its header has {length} bytes"));
    }
    let mut text = vec![0; length];
    file.read_exact(&mut text).map_err(|_| CUT)?;
    let end = text.iter().rposition(|&byte| byte == b'}');
    let (dictionary, padding) = text.split_at(end.map_or(text.len(), |end| end + 1));
    Ok(Header {
        array: array_of(&String::from_utf8_lossy(dictionary))?,
        stamp: Stamp::of(padding),
        start: (start.len() + length_bytes + length) as u64,
    })
}

/// The array that a dictionary describes.
fn array_of(dictionary: &str) -> Result<Array, String> {
    let value = |key: &str| {
        let key = [format!("'{key}'"), format!("\"{key}\"")];
        let value = key.iter().find_map(|key| dictionary.split_once(&**key));
        value.and_then(|(_, rest)| rest.trim_start().strip_prefix(':').map(str::trim_start))
    };
    let (Some(kind), Some(order), Some(shape)) =
        (value("descr"), value("fortran_order"), value("shape"))
    else {
        return Err("its header does not describe an array".to_owned());
    };
    let kind = kind.split(['\'', '"']).nth(1).unwrap_or_default();
    let number = Number::of(kind);
    let number =
        number.ok_or_else(|| format!("expected numbers <f8, <f4 or <u4, found `{kind}`"))?;
    if !order.starts_with("False") {
        return Err("expected its numbers row by row, found them column by column".to_owned());
    }
    let shape = shape
        .strip_prefix('(')
        .and_then(|rest| rest.split(')').next());
    let shape = shape.unwrap_or_default();
    let sides = shape.split(',').map(str::trim);
    let sides: Option<Vec<u32>> = sides
        .filter(|side| !side.is_empty())
        .map(|side| side.parse().ok())
        .collect();
    let (height, width, channels) = match sides.as_deref() {
        Some(&[height, width]) => (height, width, None),
        Some(&[height, width, channels]) => (height, width, Some(channels)),
        _ => {
            return Err(format!(
                "expected an array of height x width, or height x width x channels, found ({shape})"
            ));
        }
    };
    Ok(Array {
        size: Size { width, height },
        channels,
        number,
    })
}

#[cfg(test)]
mod tests;
