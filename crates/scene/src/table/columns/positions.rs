//! The kinds of positions that programs tell by what follows the letter of an axis: `x`, `xu`, `xs`, `xsu`.
//!
//! # Source
//! The documentation of LAMMPS, `dump custom`.

use glam::{DMat3, DVec3};

use super::names::marked;
use crate::text::list;

/// The kind of a position.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Kind {
    /// It is a part of the edges of the cell, and not a length.
    is_part_of_cell: bool,
    /// It goes on beyond the cell, if the particle left it.
    is_unwrapped: bool,
}

/// The axes and the origin of positions in columns of these names; `None` if their numbers are lengths.
///
/// The names are those of x, y and z, without those that are constant; the scene file may have chosen all of them.
///
/// # Errors
/// Refuses parts of a cell that the table does not have, and names of several kinds.
pub(super) fn axes(
    names: [Option<&str>; 3],
    are_chosen: bool,
    cell: Option<(DMat3, DVec3)>,
) -> Result<Option<(DMat3, DVec3)>, String> {
    let kinds: Vec<Kind> = names.into_iter().flatten().map(kind).collect();
    let is_any_part = kinds.iter().any(|kind| kind.is_part_of_cell);
    let are_alike = kinds.windows(2).all(|pair| pair[0] == pair[1]);
    let is_in_order = names.iter().enumerate().all(|(axis, name)| {
        let of_name = name.and_then(axis_of_part);
        of_name.is_none_or(|of_name| of_name == axis)
    });
    let shown = || {
        let names: Vec<String> = names.into_iter().flatten().map(marked).collect();
        list(&names).replace(" or ", " and ")
    };
    match cell {
        _ if !are_alike && !are_chosen => Err(format!(
            "expected x, y and z of one kind, found {} (choose them with `columns: (x: …, y: …, z: …)`)",
            shown()
        )),
        Some(_) if is_any_part && !(are_alike && is_in_order) => Err(format!(
            "expected `xs`, `ys` and `zs` together, which are fractions of the cell, found {} for x, y and z",
            shown()
        )),
        Some(cell) if is_any_part => Ok(Some(cell)),
        None if is_any_part && !are_chosen => Err(format!(
            "expected a cell, because {} are fractions of it, found none (`columns: (x: …, y: …, z: …)` uses them as they are)",
            shown()
        )),
        _ => Ok(None),
    }
}

/// Says whether positions in columns of these names go on beyond the cell.
pub(super) fn are_unwrapped(names: [Option<&str>; 3]) -> bool {
    let mut names = names.into_iter().flatten().peekable();
    names.peek().is_some() && names.all(|name| kind(name).is_unwrapped)
}

fn kind(name: &str) -> Kind {
    let name = name.to_ascii_lowercase();
    let behind = name.strip_prefix(['x', 'y', 'z']).unwrap_or_default();
    Kind {
        is_part_of_cell: ["s", "su"].contains(&behind),
        is_unwrapped: ["u", "su"].contains(&behind),
    }
}

/// The axis of a part of the cell, by its name.
fn axis_of_part(name: &str) -> Option<usize> {
    let letter = name.chars().next()?.to_ascii_lowercase();
    let axis = ['x', 'y', 'z'].iter().position(|axis| *axis == letter);
    axis.filter(|_| kind(name).is_part_of_cell)
}
