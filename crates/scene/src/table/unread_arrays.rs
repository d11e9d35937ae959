//! Arrays of an archive that would say something of spheres if they had a row for each.

use super::columns::{MOST_COLUMNS, Slot, components, marked};
use super::request::Request;
use crate::text::LocatedFault;

/// The purposes that an array may have by its name.
const PURPOSES: [Slot; 9] = [
    Slot::X,
    Slot::Y,
    Slot::Z,
    Slot::Radius,
    Slot::Red,
    Slot::Green,
    Slot::Blue,
    Slot::Value,
    Slot::Element,
];

/// Those of arrays with these names and shapes that are not read, and say nothing that the scene file says instead.
pub(super) fn of<'a>(
    arrays: impl Iterator<Item = (&'a str, &'a [u64])>,
    rows: u64,
    request: &Request,
) -> impl Iterator<Item = LocatedFault> {
    let has_radius = request.radius.is_some() || request.columns.radius.is_some();
    let is_unread = move |(name, shape): &(&str, &[u64])| {
        let is_read = matches!(shape.len(), 1 | 2) && shape.first() == Some(&rows);
        !is_read && has_purpose(name, shape) && !(has_radius && is_radius(name))
    };
    arrays.filter(is_unread).map(move |(name, shape)| {
        let lengths: Vec<String> = shape.iter().map(u64::to_string).collect();
        let (name, shape) = (marked(name), lengths.join(", "));
        LocatedFault::of_file(format!(
            "the array {name} has the shape ({shape}), but there are {rows} spheres: it is not read"
        ))
    })
}

/// Says whether an array of this name has a purpose if it has a row for each sphere.
pub(super) fn has_purpose(name: &str, shape: &[u64]) -> bool {
    let count = shape.get(1..).and_then(|rest| rest.last());
    let count = count.map_or(1, |count| (*count).min(MOST_COLUMNS as u64));
    components(name, count).iter().any(|column| {
        let mut names = PURPOSES.iter().flat_map(|slot| slot.names());
        names.any(|known| known.eq_ignore_ascii_case(column)) || is_radius(column)
    })
}

fn is_radius(name: &str) -> bool {
    let mut names = Slot::Radius.names().iter().chain(&["diameter"]);
    names.any(|known| known.eq_ignore_ascii_case(name))
}
