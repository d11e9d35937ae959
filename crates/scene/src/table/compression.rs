//! Files compressed by gzip, Zstandard, bzip2 or xz: how they are told, and how much they may hold.

use std::fmt;
use std::fs::File;
use std::io::{self, Read, Seek, SeekFrom};
use std::ops::RangeInclusive;

use crate::text::LocatedFault;

/// The number with which a frame of Zstandard begins.
pub(super) const ZSTANDARD_FRAME: u32 = 0xfd2f_b528;
/// The numbers with which frames of Zstandard begin that are to be passed over.
pub(super) const ZSTANDARD_SKIPPABLE: RangeInclusive<u32> = 0x184d_2a50..=0x184d_2a5f;

/// The ways in which files are compressed.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub(crate) enum Compression {
    Bzip2,
    Gzip,
    Xz,
    Zstandard,
}

/// The bytes that any compressed file may hold.
const FREE_BYTES: u64 = 1 << 26;
const FREE_COUNT: u64 = 1 << 17;
/// Bytes, and rows or steps, that they may hold for each byte that they have: many times what any table of different
/// spheres is compressed to. A megabyte of nothing else than zeros would take all memory, or hours.
const MOST_FOR_A_BYTE: u64 = 250;
const COUNT_FOR_A_BYTE: u64 = 4;

/// Says whether a file that begins so is compressed.
pub(crate) fn is_compressed(head: &[u8]) -> bool {
    Compression::of_bytes(head).is_some()
}

/// The most bytes that a compressed file of this size may hold.
pub(super) fn most_bytes(stored: u64) -> u64 {
    FREE_BYTES.max(stored.saturating_mul(MOST_FOR_A_BYTE))
}

/// Refuses more rows or steps, which `noun` calls, than a compressed file of this size may hold.
pub(super) fn check_count(stored: u64, count: u64, noun: &str) -> Result<(), LocatedFault> {
    let most = FREE_COUNT.max(stored.saturating_mul(COUNT_FOR_A_BYTE));
    if count <= most {
        return Ok(());
    }
    let message = format!(
        "expected at most {most} {noun} in a compressed file of {stored} bytes, found more: {REMEDY}"
    );
    Err(LocatedFault::of_file(message))
}

/// Refuses more bytes in memory, of what `noun` calls, than a compressed file of this size may hold.
pub(super) fn check_bytes(stored: u64, bytes: u64, noun: &str) -> Result<(), LocatedFault> {
    let most = most_bytes(stored);
    if bytes <= most {
        return Ok(());
    }
    let message = format!(
        "expected {noun} of at most {most} bytes in a compressed file of {stored} bytes, found more: {REMEDY}"
    );
    Err(LocatedFault::of_file(message))
}

/// The way to read a file that holds more.
pub(super) const REMEDY: &str = "decompress it if you want to read it anyway";

impl fmt::Display for Compression {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str(match self {
            Self::Bzip2 => "bzip2",
            Self::Gzip => "gzip",
            Self::Xz => "xz",
            Self::Zstandard => "Zstandard",
        })
    }
}

impl Compression {
    /// The way in which a file is compressed, by its first bytes; the file is at its start afterwards.
    pub(crate) fn of(file: &mut File) -> io::Result<Option<Self>> {
        let mut start = Vec::new();
        file.by_ref().take(HEAD).read_to_end(&mut start)?;
        file.seek(SeekFrom::Start(0))?;
        Ok(Self::of_bytes(&start))
    }

    /// The way in which bytes that begin so are compressed.
    pub(crate) fn of_bytes(bytes: &[u8]) -> Option<Self> {
        match bytes {
            [0x1f, 0x8b, ..] => Some(Self::Gzip),
            [0xfd, b'7', b'z', b'X', b'Z', 0, ..] => Some(Self::Xz),
            [b'B', b'Z', b'h', b'1'..=b'9', rest @ ..] if is_of_bzip2(rest) => Some(Self::Bzip2),
            _ => {
                let magic = u32::from_le_bytes(*bytes.first_chunk()?);
                let is_frame = magic == ZSTANDARD_FRAME || ZSTANDARD_SKIPPABLE.contains(&magic);
                is_frame.then_some(Self::Zstandard)
            }
        }
    }
}

/// The bytes that tell how a file is compressed.
const HEAD: u64 = 10;

/// Says whether bytes behind `BZh` and the level begin a block of bzip2, or end its stream.
fn is_of_bzip2(bytes: &[u8]) -> bool {
    /// The digits of π, and of its square root.
    const MARKS: [[u8; 6]; 2] = [
        [0x31, 0x41, 0x59, 0x26, 0x53, 0x59],
        [0x17, 0x72, 0x45, 0x38, 0x50, 0x90],
    ];
    MARKS
        .iter()
        .any(|mark| bytes.iter().zip(mark).all(|(byte, wanted)| byte == wanted))
}

/// The endings of the names of compressed tables.
///
/// # Example
/// ```
/// assert!(marbles_scene::COMPRESSED_ENDINGS.contains(&"gz"));
/// ```
pub const COMPRESSED_ENDINGS: [&str; 4] = ["gz", "zst", "bz2", "xz"];
