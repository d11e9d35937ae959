//! Doubts and guesses while a table was read.

use std::ops::Range;
use std::path::Path;
use std::sync::Arc;

use super::columns::Plan;
use super::element;
use crate::text::{LocatedFault, Place, show};

/// Doubts and guesses while a table was read.
#[derive(Clone, Debug, Default)]
pub(crate) struct Remarks {
    /// Names of atoms that tell no element, and how many rows have each.
    unknown: Vec<(Box<[u8]>, u64)>,
    /// The rows whose names are not listed.
    others: u64,
    /// The first of these rows.
    first: Option<Place>,
    /// The rows that are left out because their radius is 0, and the first of them.
    points: u64,
    first_point: Option<Place>,
    /// The guesses.
    guesses: Vec<LocatedFault>,
    /// The names of `radii` that a row had.
    used_radii: Vec<bool>,
    /// The file in which all of this is, if it is not the table.
    pub(crate) file: Option<Arc<Path>>,
}

/// The most names that are listed.
const MOST_NAMES: usize = 8;

impl Remarks {
    /// Nothing, of a table for which the scene gives radii to so many names.
    pub(crate) fn new(own_radii: usize) -> Self {
        Self {
            used_radii: vec![false; own_radii],
            ..Self::default()
        }
    }

    /// The assumptions of the plan by which rows are read.
    pub(crate) fn of_plan(plan: &Plan) -> Self {
        let doubts = plan.doubts.iter();
        Self {
            guesses: doubts
                .map(|doubt| LocatedFault::of_file(doubt.as_str()))
                .collect(),
            ..Self::new(plan.elements.own_radii())
        }
    }

    /// Takes in a row whose label tells no element.
    #[cold]
    pub(crate) fn add_unknown(&mut self, label: &[u8], place: impl FnOnce() -> Place) {
        self.count(label, 1);
        self.first.get_or_insert_with(place);
    }

    /// Takes in a row that is left out because its radius is 0.
    #[cold]
    pub(crate) fn add_point(&mut self, place: impl FnOnce() -> Place) {
        self.points += 1;
        self.first_point.get_or_insert_with(place);
    }

    fn count(&mut self, label: &[u8], rows: u64) {
        let known = self.unknown.iter().position(|known| *known.0 == *label);
        match known {
            Some(place) => self.unknown[place].1 += rows,
            None if self.unknown.len() < MOST_NAMES => self.unknown.push((label.into(), rows)),
            None => self.others += rows,
        }
    }

    /// Takes in a guess.
    pub(crate) fn add_guess(&mut self, guess: LocatedFault) {
        if !self.guesses.contains(&guess) {
            self.guesses.push(guess);
        }
    }

    /// Takes in that a row has the radius that the scene gives to a name.
    #[inline]
    pub(crate) fn use_radius(&mut self, name: usize) {
        if let Some(used) = self.used_radii.get_mut(name) {
            *used = true;
        }
    }

    /// The names of `radii` that no row had.
    pub(crate) fn unused_radii(&self) -> impl Iterator<Item = usize> {
        let used = self.used_radii.iter().enumerate();
        used.filter(|(_, is_used)| !**is_used)
            .map(|(place, _)| place)
    }

    /// Takes in those of rows that follow.
    pub(crate) fn append(&mut self, others: Self) {
        for (name, rows) in &others.unknown {
            self.count(name, *rows);
        }
        self.others += others.others;
        self.first = self.first.take().or(others.first);
        self.points += others.points;
        self.first_point = self.first_point.take().or(others.first_point);
        self.file = self.file.take().or(others.file);
        for guess in others.guesses {
            self.add_guess(guess);
        }
        for (used, other) in self.used_radii.iter_mut().zip(others.used_radii) {
            *used |= other;
        }
    }

    /// The same so many lines further down.
    pub(crate) fn lower(mut self, lines: u64) -> Self {
        for place in [&mut self.first, &mut self.first_point] {
            if let Some(Place::Text { line, .. }) = place {
                *line += lines;
            }
        }
        self
    }

    /// True where a row tells no element.
    pub(crate) fn has_place(&self) -> bool {
        self.first.is_some()
    }

    /// Names that tell no element, the first some of them.
    pub(crate) fn unknown(&self) -> impl Iterator<Item = &[u8]> {
        self.unknown.iter().map(|(name, _)| &**name)
    }

    /// The guesses, and, with `unknown`, the names that tell no element; each with its place.
    pub(crate) fn told(&self, unknown: bool) -> Vec<LocatedFault> {
        let mut told = self.guesses.clone();
        if let Some(place) = &self.first_point {
            told.push(LocatedFault {
                place: place.clone(),
                message: format!(
                    "atoms with a radius of 0 are left out: {}, of which this is the first (`radius: 1` shows all \
                     atoms, with one radius)",
                    self.points,
                ),
            });
        }
        if let Some(place) = self.first.as_ref().filter(|_| unknown) {
            let rows = |count: u64| match count {
                1 => String::from("1 row"),
                count => format!("{count} rows"),
            };
            let name = |(name, count): &(Box<[u8]>, u64)| {
                let name = String::from_utf8_lossy(name);
                let shown = match show(&name) {
                    _ if name.is_empty() => String::from("no name"),
                    shown if shown.starts_with('`') => shown,
                    shown => format!("`{shown}`"),
                };
                format!("{shown} ({})", rows(*count))
            };
            let mut names: Vec<String> = self.unknown.iter().map(name).collect();
            if self.others > 0 {
                names.push(format!("others ({})", rows(self.others)));
            }
            let meant = self.unknown.first().and_then(|(name, _)| {
                let name = String::from_utf8_lossy(name);
                element::suggestion(&name)
            });
            let meant =
                meant.map_or_else(String::new, |symbol| format!(", did you mean {symbol}?"));
            told.push(LocatedFault {
                place: place.clone(),
                message: format!(
                    "expected elements with known radii and colors, found {}{meant} (for these, marbles uses \
                     `others: (radius: 1, color: \"#ff80c0\")`)",
                    names.join(", "),
                ),
            });
        }
        told
    }
}

/// The place of a part of a line.
pub(crate) fn place_in_line(number: u64, line: &[u8], span: Range<usize>) -> Place {
    LocatedFault::in_line(number, line, span, String::new()).place
}
