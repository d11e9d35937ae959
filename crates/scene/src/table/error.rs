//! The reasons for which there is no table.

use std::io;

use super::foreign::Foreign;
use super::other_file::OtherName;
use crate::text::LocatedFault;

/// The reason for which there is no table.
#[derive(Debug)]
pub(crate) enum TableError {
    /// The file cannot be opened or read.
    Unreadable(io::Error),
    /// Neither the name nor the contents tell a format that is read; what it is instead, where that is known.
    UnknownFormat(Option<&'static Foreign>),
    /// There is no memory for it.
    OutOfMemory(u64),
    /// Something is wrong in it.
    Fault(LocatedFault),
    /// It has no cell, and this field of the scene file needs one.
    NoCell(&'static str),
    /// It has this format and no atoms that a topology could tell.
    NoTrajectory(&'static str),
    /// What the scene file asks of the positions of a trajectory cannot be shown, as this message says.
    InTopology(String),
    /// What the scene file asks for cannot be shown, as this message says.
    InScene(String),
    /// Something is wrong with another file, which it names or the scene does.
    InOther(OtherName, Box<Self>),
    /// It is not the file any more that was read before.
    Changed,
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
