//! The names of columns, as programs write them.

use std::sync::Arc;

use super::super::request::ColumnRef;
use super::slot::Slot;
use crate::text::{did_you_mean, show};

/// The most columns that a table may have, whose header may multiply what it asks for.
pub(crate) const MOST_COLUMNS: usize = 10_000;

/// The names of a table's columns.
#[derive(Clone, Debug, Default)]
pub(crate) struct Names(pub(crate) Arc<Vec<String>>);

impl Names {
    /// The column that the scene file means.
    ///
    /// # Errors
    /// Returns the message that says which columns there are.
    pub(crate) fn chosen(&self, column: &ColumnRef) -> Result<usize, String> {
        match column {
            ColumnRef::Number(number) => {
                let index = number.checked_sub(1).filter(|index| *index < self.0.len());
                index.ok_or_else(|| {
                    let count = self.0.len();
                    format!("expected the number of a column, from 1 to {count}, found {number}")
                })
            }
            ColumnRef::Constant(number) => Err(format!(
                "expected a column, found the constant `{number:?}`, which is allowed only for `x`, `y`, `z`, `radius` and in `Length`"
            )),
            ColumnRef::Name(name) => {
                let found = self.find(name).or_else(|| self.find_synonym(name));
                let index = found.ok_or_else(|| self.missing(name))?;
                self.once(index, name)
            }
        }
    }

    /// The only column for this purpose, by the first of its names that there is.
    ///
    /// # Errors
    /// Returns the message that says that there is none.
    pub(super) fn of(&self, slot: Slot) -> Result<usize, String> {
        let found = self.find_slot(slot);
        let index = found.ok_or_else(|| self.missing(slot.names()[0]))?;
        self.once(index, bare(&self.0[index]))
    }

    /// The column for this purpose, if there is one.
    pub(super) fn find_slot(&self, slot: Slot) -> Option<usize> {
        let plain = slot.names().iter().find_map(|name| self.find(name));
        let axis = match slot {
            Slot::X => Some(0),
            Slot::Y => Some(1),
            Slot::Z => Some(2),
            _ => None,
        };
        plain.or_else(|| self.find_position(axis?))
    }

    /// The column of this name, in upper or lower case, with or without a unit behind it.
    pub(super) fn find(&self, name: &str) -> Option<usize> {
        let same = |other: &String| other.eq_ignore_ascii_case(name);
        let bare = |other: &String| bare(other).eq_ignore_ascii_case(name);
        let mut names = self.0.iter();
        let exact = names.position(same);
        exact.or_else(|| self.0.iter().position(bare))
    }

    /// The column of radii; one called `r` may be red instead.
    pub(super) fn find_radius(&self, has_colors: bool) -> Option<(usize, &'static str)> {
        let is_red = has_colors && self.find("red").is_none();
        let names = Slot::Radius.names().iter();
        let mut names = names.filter(|name| !(is_red && **name == "r"));
        names.find_map(|name| Some((self.find(name)?, *name)))
    }

    /// The column with this coordinate of positions, by the names that programs give it.
    fn find_position(&self, axis: usize) -> Option<usize> {
        let letter = ["x", "y", "z"][axis];
        let mut names = [
            "points",
            "position",
            "positions",
            "pos",
            "coordinates",
            "coords",
            "center",
            "centroid",
        ]
        .into_iter()
        .flat_map(|stem| {
            [
                format!("{stem}:{axis}"),
                format!("{stem}_{axis}"),
                format!("{stem}.{letter}"),
                format!("{stem}_{letter}"),
                format!("{stem}-{letter}"),
                format!("{stem} {letter}"),
                format!("{stem}{letter}"),
                format!("{stem}[{axis}]"),
                format!("{letter}_{stem}"),
            ]
        });
        names.find_map(|name| self.find(&name))
    }

    /// The column that other formats call otherwise: `residue` for `label_comp_id`, and the like.
    fn find_synonym(&self, name: &str) -> Option<usize> {
        const SYNONYMS: [&[&str]; 4] = [
            &["residue", "resname", "label_comp_id", "auth_comp_id"],
            &["chain", "label_asym_id", "auth_asym_id"],
            &["name", "atom", "label_atom_id", "auth_atom_id"],
            &["b_factor", "bfactor", "B_iso_or_equiv"],
        ];
        let is_name = |other: &&str| other.eq_ignore_ascii_case(name);
        let slots = [Slot::X, Slot::Y, Slot::Z, Slot::Element].map(Slot::names);
        let mut groups = slots.into_iter().chain(SYNONYMS);
        let group = groups.find(|group| group.iter().any(is_name))?;
        group.iter().find_map(|other| self.find(other))
    }

    /// Refuses a column that was found by this name if another one has it, too, with the same unit or another one.
    pub(super) fn once(&self, column: usize, wanted: &str) -> Result<usize, String> {
        let name = &self.0[column];
        let is_exact = name.eq_ignore_ascii_case(wanted);
        let same = |other: &&String| {
            other.eq_ignore_ascii_case(name)
                || !is_exact && bare(other).eq_ignore_ascii_case(bare(name))
        };
        if self.0.iter().filter(same).count() > 1 {
            let name = marked(name);
            return Err(format!(
                "expected every column once, found {name} a second time"
            ));
        }
        Ok(column)
    }

    /// The message that there is no column of this name.
    fn missing(&self, name: &str) -> String {
        let known = self.0.iter().map(String::as_str);
        let meant = did_you_mean(name, known, marked);
        let are_numbers = self.0.iter().all(|name| name.parse::<u32>().is_ok());
        let is_flat = name == "z" && ["x", "y"].iter().all(|name| self.find(name).is_some());
        let (name, list) = (marked(name), self.list());
        let hint = match self.0.is_empty() {
            false if are_numbers => {
                " (you can use numbers for columns: `columns: (x: 1, y: 2, z: 3)`)"
            }
            false if is_flat => " (for a two-dimensional table, use `columns: (z: 0.0)`)",
            _ => "",
        };
        format!("expected a column {name}, found {list}{meant}{hint}")
    }

    /// The names of the columns as a message shows them.
    pub(super) fn list(&self) -> String {
        const LONGEST_LIST: usize = 12;
        let names = self.0.iter().take(LONGEST_LIST);
        let mut names: Vec<String> = names.map(|name| marked(name)).collect();
        if self.0.len() > LONGEST_LIST {
            names.push(String::from("…"));
        }
        match names.is_empty() {
            true => String::from("none"),
            false => names.join(", "),
        }
    }
}

/// The part of a name that several columns share, in characters: each of them has a copy.
const LONGEST_SHARED: usize = 1000;

/// Says whether a column with one of these names holds the positions along an axis, from 0 to 2.
pub(crate) fn has_axis(names: &Arc<Vec<String>>, axis: usize) -> bool {
    let slot = [Slot::X, Slot::Y, Slot::Z][axis];
    Names(Arc::clone(names)).find_slot(slot).is_some()
}

/// The axis, from 0 to 2, whose positions a column has that the scene file names: one of these columns, or one that a
/// trajectory has besides them.
pub(crate) fn axis_of(names: &Arc<Vec<String>>, column: &ColumnRef) -> Option<usize> {
    let known = Names(Arc::clone(names));
    let chosen = known.chosen(column).ok();
    let slots = [Slot::X, Slot::Y, Slot::Z].into_iter().enumerate();
    let mut slots = slots.filter(|(_, slot)| match column {
        ColumnRef::Name(name) if name.eq_ignore_ascii_case(slot.names()[0]) => true,
        _ => chosen.is_some() && known.find_slot(*slot) == chosen,
    });
    slots.next().map(|(axis, _)| axis)
}

/// Says whether a column with one of these names holds radii or diameters.
pub(crate) fn tells_radius(names: &Arc<Vec<String>>) -> bool {
    let names = Names(Arc::clone(names));
    let mut colors = [Slot::Red, Slot::Green, Slot::Blue].into_iter();
    let has_colors = colors.all(|slot| names.find_slot(slot).is_some());
    names.find_radius(has_colors).is_some() || names.find("diameter").is_some()
}

/// The names of the columns that hold `count` values called `name` together.
pub(crate) fn components(name: &str, count: u64) -> Vec<String> {
    let names = match (name.to_ascii_lowercase().as_str(), count) {
        ("pos" | "position" | "positions" | "coordinates" | "coords" | "points" | "xyz", 3) => {
            ["x", "y", "z"]
        }
        ("color" | "colour", 3) => ["red", "green", "blue"],
        (_, 1) => return vec![name.to_owned()],
        _ => {
            let shared: String = name.chars().take(LONGEST_SHARED).collect();
            let numbers = 1..=count;
            return numbers.map(|number| format!("{shared}_{number}")).collect();
        }
    };
    names.map(String::from).into()
}

/// The unit behind a name: `mm` of `X (mm)` and of `x [mm]`.
pub(crate) fn unit(name: &str) -> Option<&str> {
    let (start, end) = match name.chars().last()? {
        ')' => ('(', ')'),
        ']' => ('[', ']'),
        _ => return None,
    };
    let (before, unit) = name.strip_suffix(end)?.rsplit_once(start)?;
    let is_unit = !before.trim().is_empty() && unit.parse::<u32>().is_err();
    is_unit.then_some(unit.trim())
}

/// The name without its unit.
fn bare(name: &str) -> &str {
    match unit(name) {
        Some(_) => name
            .rfind(['(', '['])
            .map_or(name, |at| name[..at].trim_end()),
        None => name,
    }
}

/// A name between marks, as a message shows it.
pub(crate) fn marked(name: &str) -> String {
    let shown = show(name);
    match shown.starts_with('`') {
        true => shown,
        false => format!("`{shown}`"),
    }
}
