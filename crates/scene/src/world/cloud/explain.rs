//! Why there is no table.

use std::fs;
use std::io;
use std::ops::RangeInclusive;
use std::path::Path;

use crate::table::{self, TableError};
use crate::text::{closest, list, quoted, reason};

/// The reason for which there is no table at `path`, which the scene file calls `name`.
pub(super) fn explain(name: &str, path: &Path, error: &TableError) -> String {
    let shown = quoted(name);
    let error = match error {
        TableError::Fault(fault) => return fault.message.clone(),
        TableError::UnknownFormat(foreign) => {
            let endings = table::ENDINGS.map(|ending| format!("`.{}`", ending.0));
            let endings = list(&endings);
            return match foreign {
                Some(foreign) => {
                    let (kind, remedy) = (foreign.kind, foreign.remedy);
                    format!("expected a table ({endings}), found {shown}, {kind}: {remedy}")
                }
                None => {
                    format!("expected a table ({endings}), found {shown}, which is not a table")
                }
            };
        }
        TableError::OutOfMemory(count) => {
            return format!("expected a table that fits into memory, found {count} rows");
        }
        TableError::InScene(message) | TableError::InTopology(message) => return message.clone(),
        TableError::InOther(other, error) => return explain(&other.name, &other.path, error),
        TableError::NoTrajectory(format) => {
            return format!(
                "expected a trajectory (XTC or DCD) for `topology`, found {shown}, whose format is {format}"
            );
        }
        TableError::NoCell(field) => {
            return format!(
                "expected a table with a cell for `{field}`, found none in {shown} (extended XYZ with `Lattice`, PDB, CIF, \
                 GRO, POSCAR, trajectories, dumps and data files of LAMMPS have one)"
            );
        }
        TableError::Changed => {
            return format!(
                "expected the table {shown} to stay the same while its frames are rendered, found a change: start \
                 again when no program writes to it"
            );
        }
        TableError::Unreadable(error) => error,
    };
    match error.kind() {
        io::ErrorKind::NotFound => {
            let message = format!("expected a table, found no file {shown}");
            match neighbor(name, path) {
                Some(other) => format!("{message}, did you mean {}?", quoted(&other)),
                None => message,
            }
        }
        io::ErrorKind::IsADirectory => format!("expected a table, found the folder {shown}"),
        io::ErrorKind::PermissionDenied => {
            format!("expected a table, found {shown}, which you have no permission to read")
        }
        _ => {
            let why = reason(error);
            format!("expected a table, found {shown}, which cannot be read: {why}")
        }
    }
}

/// Why a cloud of this name shows no steps: those that it has lie between these ends.
pub(super) fn no_steps(
    name: &str,
    range: Option<&RangeInclusive<i32>>,
    ends: Option<(i64, i64)>,
) -> String {
    let found = match ends {
        Some((first, last)) => format!("those from {first} to {last}"),
        None => String::from("none"),
    };
    let wanted = range.map_or(String::new(), |range| {
        format!(" with a number from {} to {}", range.start(), range.end())
    });
    format!("expected steps {name}{wanted}, found {found}")
}

/// Why a table of this name and format has no frames to be shown one after another.
pub(super) fn without_frames(name: &str, format: &str) -> String {
    format!(
        "expected a table with frames for `frames: All`, found {name}, whose format ({format}) has no frames: for \
         a series, use one file per step, with names such as `run.####.csv`, or `time: \"frame\"` for the steps in \
         a column"
    )
}

/// The name of a file beside `path` that is probably meant.
fn neighbor(name: &str, path: &Path) -> Option<String> {
    const MOST_COMPARED: usize = 10_000;
    let entries = fs::read_dir(path.parent()?).ok()?.take(MOST_COMPARED);
    let mut names: Vec<String> = entries
        .filter_map(|entry| entry.ok()?.file_name().into_string().ok())
        .collect();
    names.sort_unstable();
    let names = names.iter().map(String::as_str);
    let close = closest(path.file_name()?.to_str()?, names)?;
    let close = Path::new(name).with_file_name(close);
    Some(close.display().to_string())
}
