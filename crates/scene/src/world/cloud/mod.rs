//! Clouds: the spheres of tables.

mod coloring;
mod explain;
mod observed;
mod open;
mod oversights;
mod pattern;
mod remarked;
mod settings;
mod steps;
mod summary;

use std::path::{Path, PathBuf};

pub use coloring::ScaleKind;
pub(crate) use coloring::{Learned, Scale};
pub(crate) use open::{FIRST_OF_SEVERAL, OpenCloud, Step};
pub(crate) use remarked::Oversight;
pub(crate) use settings::Cloud;
pub use summary::{ColumnContents, ColumnSummary};

use crate::text::{Fault, LocatedFault};

/// The reason for which a table was refused.
#[derive(Debug)]
pub(crate) enum CloudError {
    /// Something is wrong in what the scene file says of it.
    Scene(Fault),
    /// Something is wrong in the table with this path.
    Table(PathBuf, LocatedFault),
    /// A table is not the one any more that was read before.
    Changed(Fault),
}

impl CloudError {
    /// The message without the place.
    pub(crate) fn message(&self) -> String {
        match self {
            Self::Scene(fault) | Self::Changed(fault) => fault.message.clone(),
            Self::Table(_, fault) => fault.message.clone(),
        }
    }
}

/// The state of reading a table.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub struct Progress<'scene> {
    /// The table as the scene file names it, or the file of one of its steps.
    pub table: &'scene Path,
    /// Bytes that were read.
    pub read: u64,
    /// Bytes of the whole file; 0 where it does not say.
    pub size: u64,
}
