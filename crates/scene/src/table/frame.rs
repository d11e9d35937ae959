//! A frame of a trajectory.

use std::io::Read;

use super::cell::ToldCell;
use super::error::TableError;
use super::input::Input;
use crate::text::LocatedFault;

/// The positions of all atoms at a moment.
pub(crate) struct Frame {
    pub(super) positions: Vec<[f32; 3]>,
    pub(super) cell: Option<ToldCell>,
}

/// So many bytes that come next.
pub(super) fn take(input: &mut Input<'_>, count: u64) -> Result<Vec<u8>, TableError> {
    let start = input.position;
    let left = input.size().unwrap_or(0).saturating_sub(start);
    let mut bytes = Vec::new();
    if count <= left {
        input.by_ref().take(count).read_to_end(&mut bytes)?;
    }
    match bytes.len() as u64 == count {
        true => Ok(bytes),
        false => Err(damaged(format!(
            "expected {count} bytes at byte {start}, found {left}: the file is cut or damaged"
        ))),
    }
}

pub(super) fn damaged(message: String) -> TableError {
    LocatedFault::of_file(message).into()
}
