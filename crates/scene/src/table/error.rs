//! The reasons for which there is no table.

use std::io;

use crate::text::LocatedFault;

/// The reason for which there is no table.
#[derive(Debug)]
pub(crate) enum TableError {
    /// The file cannot be opened or read.
    Unreadable(io::Error),
    /// Neither the name nor the contents tell a format that is read; the remedy, where one is known.
    UnknownFormat(Option<&'static str>),
    /// There is no memory for it.
    OutOfMemory(u64),
    /// Something is wrong in it.
    Fault(LocatedFault),
}

impl From<io::Error> for TableError {
    fn from(error: io::Error) -> Self {
        Self::Unreadable(error)
    }
}

impl From<LocatedFault> for TableError {
    fn from(fault: LocatedFault) -> Self {
        Self::Fault(fault)
    }
}
