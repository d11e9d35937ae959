//! Reads the first frame of a table as often as a figure asks for it, each time for other columns.

use std::path::Path;
use std::sync::Arc;

use glam::DVec3;

use crate::table::{Coloring, ColumnRef, Columns, Frames, Missing, Paint, Request, Rows, Value};

/// The table, and the columns that are taken.
pub(super) struct Reader<'a> {
    pub(super) path: &'a Path,
    pub(super) names: &'a Arc<Vec<String>>,
    /// The numbers, from 1, of columns without names that are positions or radii.
    pub(super) used: &'a [usize],
}

/// Facts about a table beside its rows.
#[derive(Clone, Copy, Debug)]
pub(super) struct Facts {
    /// In the table, z points up.
    pub(super) has_z_up: bool,
    /// Frames follow the first.
    pub(super) has_more: bool,
    /// The table has nothing but the positions of atoms.
    pub(super) is_trajectory: bool,
    /// The table lists the atoms of a crystal's cell.
    pub(super) is_crystal: bool,
}

/// Progress that nobody watches.
const UNWATCHED: &(dyn Fn(u64, u64) + Sync) = &|_, _| {};

impl Reader<'_> {
    /// What a column, or a vector, would color; `None` if it cannot.
    pub(super) fn paint(&self, value: Value, coloring: Coloring) -> Option<Paint> {
        let request = Request {
            value: Some(value),
            coloring: Some(coloring),
            missing: Missing::Color(DVec3::ZERO),
            ..ignoring_positions()
        };
        first(self.path, &request).map(|(_, rows)| rows.paint)
    }
}

/// The request for a table of which no positions are looked at.
pub(super) fn ignoring_positions() -> Request {
    Request {
        radius: Some(1.0),
        coloring: Some(Coloring::Material),
        columns: Columns {
            position: [(); 3].map(|()| Some(ColumnRef::Constant(0.0))),
            ..Columns::default()
        },
        ..Request::default()
    }
}

/// The first frame of the table at `path`; `None` if it cannot be read so.
pub(super) fn first(path: &Path, request: &Request) -> Option<(Facts, Rows)> {
    let mut frames = Frames::open(path, UNWATCHED).ok()?;
    let rows = frames.read(request).ok()??;
    let facts = Facts {
        has_z_up: frames.has_z_up(),
        is_trajectory: frames.is_trajectory(),
        is_crystal: frames.is_crystal(),
        has_more: frames.has_more(),
    };
    Some((facts, rows))
}
