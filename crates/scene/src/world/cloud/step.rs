//! A step of a cloud, as it is shown.

use marbles_core::{Albedos, Sphere};

use super::coloring::Learned;
use crate::table::{Cell, Remarks};

/// The spheres of a step.
#[derive(Clone, Debug)]
pub(crate) struct Step {
    pub(crate) spheres: Vec<Sphere>,
    pub(crate) albedos: Option<Albedos>,
    /// The rows of the table, those that were not kept among them.
    pub(crate) rows: u64,
    /// The column of the numbers or names that colors stand for.
    pub(crate) value_name: Option<String>,
    /// The meaning of the colors.
    pub(crate) learned: Learned,
    /// The table has frames that are not read.
    pub(crate) has_more: bool,
    /// The axes of the table are right-handed.
    pub(crate) is_right_handed: bool,
    /// Doubts and guesses.
    pub(super) remarks: Remarks,
    /// The values are times, in seconds.
    pub(crate) has_times: bool,
    /// The rows that were kept.
    pub(crate) kept: u64,
    /// The cell, where the table tells one that has a volume.
    pub(crate) cell: Option<Cell>,
}
