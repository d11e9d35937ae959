//! The numbers of an array, in each of the ways in which VTK XML files hold them.

use std::io::Read;

use flate2::bufread::ZlibDecoder;

use super::super::error::TableError;
use super::super::kind::{Kind, Number};
use super::super::number::parse;
use super::base64::Base64;
use super::bytes::Bytes;
use super::document::{Array, Document, Encoding, Source};
use crate::text::LocatedFault;

/// The numbers of an array.
#[derive(Clone, Debug)]
pub(super) enum Numbers {
    /// They stand in the file as they are, from this byte on.
    Stored(u64),
    /// They were decoded, to numbers of this kind.
    Decoded(Vec<u8>, Kind),
}

/// Bytes of an array.
enum Stream {
    Raw,
    Base64(Base64),
}

impl Numbers {
    /// Finds the numbers of an array that has so many rows.
    pub(super) fn of(
        array: &Array,
        rows: u64,
        document: &Document,
        bytes: &mut Bytes<'_, '_>,
    ) -> Result<Self, TableError> {
        let encoding = document.encoding;
        let numbers = rows.checked_mul(array.size);
        let numbers = numbers.ok_or(TableError::OutOfMemory(rows))?;
        let mut stream = match array.source {
            Source::Text(start) => {
                bytes.go_to(start)?;
                let decoded = text_numbers(array, numbers, bytes)?;
                return Ok(Self::Decoded(decoded, Kind::little(Number::F64)));
            }
            Source::Base64(start) => {
                bytes.go_to(start)?;
                Stream::Base64(Base64::default())
            }
            Source::Appended(offset) => {
                let appended = document.appended.ok_or_else(|| {
                    array
                        .place
                        .told("expected `<AppendedData …>` for this array, found none".to_owned())
                })?;
                bytes.go_to(appended.start.saturating_add(offset))?;
                match appended.is_base64 {
                    true => Stream::Base64(Base64::default()),
                    false => Stream::Raw,
                }
            }
        };
        let size = numbers.checked_mul(array.kind.size());
        let size = size.ok_or(TableError::OutOfMemory(rows))?;
        let decoded = match encoding.is_compressed {
            true => stream.blocks(array, size, encoding, bytes)?,
            false => {
                let found = stream.length(array, encoding, bytes)?;
                array.check_size(size, found)?;
                let start = bytes.position();
                if matches!(stream, Stream::Raw) {
                    array.check_size(size, size.min(bytes.behind(start)))?;
                    return Ok(Self::Stored(start));
                }
                let decoded = stream.take(bytes, size)?;
                array.check_size(size, decoded.len() as u64)?;
                decoded
            }
        };
        Ok(Self::Decoded(decoded, array.kind))
    }
}

impl Stream {
    /// The next bytes, so many or as many as there are.
    fn take(&mut self, bytes: &mut Bytes<'_, '_>, count: u64) -> Result<Vec<u8>, TableError> {
        match self {
            Self::Raw => bytes.take(count),
            Self::Base64(decoder) => {
                decoder.take(bytes, usize::try_from(count).unwrap_or(usize::MAX))
            }
        }
    }

    /// The next length before numbers.
    fn length(
        &mut self,
        array: &Array,
        encoding: Encoding,
        bytes: &mut Bytes<'_, '_>,
    ) -> Result<u64, TableError> {
        let size = Kind::Number(encoding.length, encoding.order).size();
        let taken = self.take(bytes, size)?;
        let length = encoding.whole(&taken);
        Ok(length.ok_or_else(|| array.cut("its length"))?)
    }

    /// The bytes of compressed blocks, which hold so many together.
    fn blocks(
        &mut self,
        array: &Array,
        size: u64,
        encoding: Encoding,
        bytes: &mut Bytes<'_, '_>,
    ) -> Result<Vec<u8>, TableError> {
        let mut length = |bytes: &mut Bytes<'_, '_>| self.length(array, encoding, bytes);
        let [count, whole] = [length(bytes)?, length(bytes)?];
        // Zero where the last block is as large as the others.
        let last = match length(bytes)? {
            0 => whole,
            last => last,
        };
        let found = count
            .checked_sub(1)
            .map_or(Some(0), |full| full.checked_mul(whole)?.checked_add(last));
        array.check_size(size, found.unwrap_or(u64::MAX))?;
        if count > bytes.behind(bytes.position()) {
            return Err(array.cut("the lengths of its blocks").into());
        }
        let mut lengths = Vec::new();
        for _ in 0..count {
            lengths.push(length(bytes)?);
        }
        let mut all = Vec::new();
        for (index, length) in lengths.into_iter().enumerate() {
            let packed = self.take(bytes, length)?;
            if (packed.len() as u64) < length {
                return Err(array.cut("its blocks").into());
            }
            let size = if index as u64 + 1 == count {
                last
            } else {
                whole
            };
            let before = all.len() as u64;
            // A byte more, so that the checksum is looked at.
            let mut decoder = ZlibDecoder::new(&packed[..]).take(size.saturating_add(1));
            let is_read = decoder.read_to_end(&mut all).is_ok();
            if !is_read || all.len() as u64 - before != size {
                let message = format!(
                    "the compressed block {} of this array is damaged",
                    index + 1
                );
                return Err(array.place.told(message).into());
            }
        }
        Ok(all)
    }
}

impl Encoding {
    /// The length that these bytes hold; `None` if there are too few.
    fn whole(self, bytes: &[u8]) -> Option<u64> {
        use super::super::kind::Order::{Big, Little};
        Some(match (self.length, self.order) {
            (Number::U32, Little) => u64::from(u32::from_le_bytes(*bytes.first_chunk()?)),
            (Number::U32, Big) => u64::from(u32::from_be_bytes(*bytes.first_chunk()?)),
            (_, Little) => u64::from_le_bytes(*bytes.first_chunk()?),
            (_, Big) => u64::from_be_bytes(*bytes.first_chunk()?),
        })
    }
}

impl Array {
    /// Refuses another number of bytes than expected.
    fn check_size(&self, expected: u64, found: u64) -> Result<(), LocatedFault> {
        if expected == found {
            return Ok(());
        }
        let message = format!("expected {expected} bytes of numbers for this array, found {found}");
        Err(self.place.told(message))
    }

    /// The fault of an array that ends too early.
    fn cut(&self, within: &str) -> LocatedFault {
        self.place
            .told(format!("this array is cut: its data end within {within}"))
    }
}

/// The numbers of a text, as little-endian doubles.
fn text_numbers(
    array: &Array,
    count: u64,
    bytes: &mut Bytes<'_, '_>,
) -> Result<Vec<u8>, TableError> {
    let mut text = Vec::new();
    loop {
        let ahead = bytes.ahead()?;
        let end = memchr::memchr(b'<', ahead);
        let part = &ahead[..end.unwrap_or(ahead.len())];
        if part.is_empty() {
            break;
        }
        text.extend_from_slice(part);
        let length = part.len();
        bytes.pass(length);
    }
    let mut decoded = Vec::new();
    let mut found = 0;
    let words = text.split(u8::is_ascii_whitespace);
    for word in words.filter(|word| !word.is_empty()) {
        let Some(number) = parse(word, false) else {
            let word = String::from_utf8_lossy(&word[..word.len().min(40)]).into_owned();
            let message = format!(
                "expected {count} numbers for this array ({found} read), found {}",
                crate::text::show(&word)
            );
            return Err(array.place.told(message).into());
        };
        found += 1;
        if found <= count {
            decoded.extend(number.to_le_bytes());
        }
    }
    if found != count {
        let message = format!("expected {count} numbers for this array, found {found}");
        return Err(array.place.told(message).into());
    }
    Ok(decoded)
}
