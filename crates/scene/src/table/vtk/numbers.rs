//! The numbers of a legacy VTK file: text, or big-endian.

use std::io::Read;

use super::super::error::TableError;
use super::super::fields::{self, Division};
use super::super::input::Input;
use super::super::kind::{Kind, Number, Order};
use super::super::number::parse;
use crate::text::LocatedFault;

/// The type of an array's numbers.
#[derive(Clone, Copy)]
pub(super) enum Type {
    Number(Number),
    /// Eight to a byte in a binary file, from its highest bit.
    Bit,
    /// Bytes that a text writes as fractions of 255.
    Color,
}

impl Type {
    /// The way in which numbers of this type are stored, or held where they are bits; big-endian.
    pub(super) fn kind(self) -> Kind {
        let number = match self {
            Self::Number(number) => number,
            // No codes of colors, which are bytes without a sign.
            Self::Bit => Number::I8,
            Self::Color => Number::U8,
        };
        Kind::Number(number, Order::Big)
    }

    /// The bytes of so many numbers in a binary file.
    pub(super) fn bytes(self, count: u64) -> u64 {
        match self {
            Self::Bit => count.div_ceil(8),
            _ => count.saturating_mul(self.kind().size()),
        }
    }

    /// The number that a text writes as this.
    ///
    /// # Errors
    /// Returns what was expected instead.
    pub(super) fn of_text(self, value: f64) -> Result<f64, &'static str> {
        match self {
            // The codes that binary files and VTK itself hold.
            Self::Color if (0.0..=1.0).contains(&value) => Ok((255.0 * value).round()),
            Self::Color => Err("a number from 0 to 1 for `COLOR_SCALARS`"),
            _ => Ok(value),
        }
    }
}

/// The type of this name.
pub(super) fn kind(name: &[u8]) -> Option<Type> {
    let number = match name.to_ascii_lowercase().as_slice() {
        b"bit" => return Some(Type::Bit),
        b"unsigned_char" => Number::U8,
        b"char" => Number::I8,
        b"unsigned_short" => Number::U16,
        b"short" => Number::I16,
        b"unsigned_int" => Number::U32,
        b"int" => Number::I32,
        b"unsigned_long" | b"vtktypeuint64" => Number::U64,
        b"long" | b"vtktypeint64" | b"vtkidtype" => Number::I64,
        b"float" => Number::F32,
        b"double" => Number::F64,
        _ => return None,
    };
    Some(Type::Number(number))
}

/// The bytes of so many numbers of a binary file, with a byte for each bit.
pub(super) fn binary_numbers(
    input: &mut Input<'_>,
    count: u64,
    kind: Type,
) -> Result<Vec<u8>, TableError> {
    let all = kind.bytes(count);
    let mut bytes = Vec::new();
    input.by_ref().take(all).read_to_end(&mut bytes)?;
    check_length(all, bytes.len() as u64)?;
    let bit = |at: u64| bytes[(at / 8) as usize] >> (7 - at % 8) & 1;
    Ok(match kind {
        Type::Bit => (0..count).map(bit).collect(),
        _ => bytes,
    })
}

/// Refuses numbers that the end of the file cuts.
pub(super) fn check_length(expected: u64, found: u64) -> Result<(), TableError> {
    if found < expected {
        let message = format!("expected {expected} bytes of numbers, found {found}");
        return Err(LocatedFault::of_file(message).into());
    }
    Ok(())
}

/// Hands out so many numbers of a text; `take` returns what it expects instead of one.
pub(super) fn text_numbers(
    input: &mut Input<'_>,
    count: u64,
    mut take: impl FnMut(f64) -> Result<(), &'static str>,
) -> Result<(), TableError> {
    let mut found = 0;
    while found < count {
        let number = input.number + 1;
        let expected = format!("{count} numbers ({found} read)");
        let line = input.next()?;
        let line = line.ok_or_else(|| LocatedFault::at_end(number, &expected))?;
        let mut words = fields::Fields::new(line, &Division::Words);
        while let Some(word) = words.next() {
            let taken = match parse(&line[word.clone()], false) {
                Some(value) if found < count => take(value),
                _ => Err(&*expected),
            };
            taken.map_err(|expected| LocatedFault::expected(number, line, word, expected))?;
            found += 1;
        }
    }
    Ok(())
}
