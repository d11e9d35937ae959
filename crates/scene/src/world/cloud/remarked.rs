//! Possible oversights about a cloud, with their places.

use std::collections::HashSet;
use std::path::PathBuf;

use crate::text::{Fault, LocatedFault};

/// Something about a table that may be an oversight.
#[derive(Clone, Debug)]
pub(crate) enum Oversight {
    /// In the scene file.
    Scene(Fault),
    /// In the table with this path.
    Table(PathBuf, LocatedFault),
}

/// Doubts in steps that are read after the first.
#[derive(Debug, Default)]
pub(super) struct LateRemarks {
    /// The names that tell no element of the steps that were read.
    pub(super) names: HashSet<Box<[u8]>>,
    pub(super) oversights: Vec<Oversight>,
}
