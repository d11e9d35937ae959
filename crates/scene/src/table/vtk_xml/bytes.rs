//! The bytes of a file, of which any can be read next.

use std::io::Read;

use super::super::error::TableError;
use super::super::input::Input;

/// The bytes of a file, of which any can be read next.
pub(super) enum Bytes<'a, 'watch> {
    /// Those of a file.
    Stored(&'a mut Input<'watch>),
    /// Those of a compressed file, which come in their order only, and the place of the next one.
    Decompressed(Vec<u8>, usize),
}

impl<'a, 'watch> Bytes<'a, 'watch> {
    /// The bytes of a file from its start.
    pub(super) fn new(input: &'a mut Input<'watch>) -> Result<Self, TableError> {
        if input.can_seek() {
            return Ok(Self::Stored(input));
        }
        let mut bytes = Vec::new();
        input.read_to_end(&mut bytes)?;
        Ok(Self::Decompressed(bytes, 0))
    }

    /// Some bytes that come next; none at the end of the file.
    pub(super) fn ahead(&mut self) -> Result<&[u8], TableError> {
        match self {
            Self::Stored(input) => input.ahead(),
            Self::Decompressed(bytes, at) => Ok(bytes.get(*at..).unwrap_or_default()),
        }
    }

    /// Passes over bytes that were ahead.
    pub(super) fn pass(&mut self, count: usize) {
        match self {
            Self::Stored(input) => input.pass(count),
            Self::Decompressed(_, at) => *at += count,
        }
    }

    /// The place of the next byte.
    pub(super) fn position(&self) -> u64 {
        match self {
            Self::Stored(input) => input.position,
            Self::Decompressed(_, at) => *at as u64,
        }
    }

    /// The number of bytes that the file holds behind this place.
    pub(super) fn behind(&self, position: u64) -> u64 {
        let size = match self {
            Self::Stored(input) => input.size().unwrap_or(u64::MAX),
            Self::Decompressed(bytes, _) => bytes.len() as u64,
        };
        size.saturating_sub(position)
    }

    /// Continues at this byte, or at the end of the file if it lies behind that.
    pub(super) fn go_to(&mut self, position: u64) -> Result<(), TableError> {
        match self {
            Self::Stored(input) => {
                let end = input.size().unwrap_or(u64::MAX);
                Ok(input.skip_to(position.min(end), 0)?)
            }
            Self::Decompressed(bytes, at) => {
                *at = usize::try_from(position).map_or(bytes.len(), |at| at.min(bytes.len()));
                Ok(())
            }
        }
    }

    /// The next bytes, so many or as many as there are.
    pub(super) fn take(&mut self, count: u64) -> Result<Vec<u8>, TableError> {
        let mut taken = Vec::new();
        match self {
            Self::Stored(input) => {
                input.by_ref().take(count).read_to_end(&mut taken)?;
            }
            Self::Decompressed(bytes, at) => {
                let rest = bytes.get(*at..).unwrap_or_default();
                let count = usize::try_from(count).map_or(rest.len(), |all| all.min(rest.len()));
                taken.extend(&rest[..count]);
                *at += count;
            }
        }
        Ok(taken)
    }
}
