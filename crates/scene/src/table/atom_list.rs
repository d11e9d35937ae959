//! The list of atoms of a crystal in CIF, whose values may lie on several lines.

use super::cif::{self, Value};
use crate::text::LocatedFault;

/// An atom of the list.
#[derive(Debug)]
pub(super) struct AtomLine {
    /// The number of the line with its first value.
    pub(super) number: u64,
    /// The values, as in the file, but without uncertainties, and in one line.
    pub(super) line: Vec<u8>,
}

/// The atoms of a list while it is read.
pub(super) struct Atoms {
    columns: usize,
    /// The columns of the fractions.
    places: Vec<usize>,
    atoms: Vec<AtomLine>,
    /// Values of the last atom that were read.
    filled: usize,
    /// The last atom has no place.
    is_nowhere: bool,
    /// The line of the last value, and where it ends there.
    last: (u64, usize),
    /// Atoms that have no place, and the first of them.
    nowhere: (u64, Option<LocatedFault>),
}

impl Atoms {
    pub(super) fn new(names: &[String]) -> Self {
        let is_place = |name: &String| PLACES.iter().any(|place| name.eq_ignore_ascii_case(place));
        let columns = names.iter().enumerate();
        Self {
            columns: names.len(),
            places: columns
                .filter(|(_, name)| is_place(name))
                .map(|(at, _)| at)
                .collect(),
            atoms: Vec::new(),
            filled: 0,
            is_nowhere: false,
            last: (0, 0),
            nowhere: (0, None),
        }
    }

    /// Takes in the next value, which stands in this line.
    pub(super) fn take(&mut self, number: u64, line: &[u8], value: &Value<'_>) {
        let is_same_line = self.last.0 == number;
        let between = match (self.filled, is_same_line) {
            (_, _) if value.span.is_empty() => &b" "[..],
            (0, false) => &line[..value.span.start],
            (0, true) => b"",
            (_, true) => &line[self.last.1..value.span.start],
            (_, false) => b" ",
        };
        if self.filled == 0 {
            let line = Vec::new();
            self.atoms.push(AtomLine { number, line });
        }
        let is_nothing = value.is_plain && cif::is_nothing(value.text);
        self.is_nowhere |= is_nothing && self.places.contains(&self.filled);
        if let Some(AtomLine { line: written, .. }) = self.atoms.last_mut() {
            written.extend(between);
            match value.is_plain {
                _ if is_nothing => written.push(b'?'),
                true => {
                    // As long as it was, so that columns in messages are right.
                    let end = cif::uncertainty(value.text).unwrap_or(value.text.len());
                    written.extend(&value.text[..end]);
                    written.extend(value.text[end..].iter().map(|_| b' '));
                }
                false if value.span.is_empty() => {
                    let plain = |byte: &u8| if *byte == b'"' { b'\'' } else { *byte };
                    written.push(b'"');
                    written.extend(value.text.iter().map(plain));
                    written.push(b'"');
                }
                false => written.extend(&line[value.span.clone()]),
            }
        }
        // Behind the semicolon that ends a text of several lines.
        self.last = (number, value.span.end.max(1));
        self.filled += 1;
        if self.filled == self.columns {
            self.end_row();
        }
    }

    fn end_row(&mut self) {
        self.filled = 0;
        if std::mem::take(&mut self.is_nowhere)
            && let Some(AtomLine { number, line }) = self.atoms.pop()
        {
            self.nowhere.0 += 1;
            let place = || LocatedFault::in_line(number, &line, 0..line.len(), String::new());
            self.nowhere.1.get_or_insert_with(place);
        }
    }

    /// The atoms that have places.
    pub(super) fn finish(mut self) -> Result<Listed, LocatedFault> {
        if self.filled > 0
            && let Some(AtomLine { number, line }) = self.atoms.pop()
        {
            let (filled, columns) = (self.filled, self.columns);
            let expected = format!("{columns} values for this atom, one for each column");
            let message = format!("expected {expected}, found {filled}");
            return Err(LocatedFault::in_line(number, &line, 0..line.len(), message));
        }
        let (count, place) = self.nowhere;
        let told = place.map(|place| LocatedFault {
            message: format!(
                "atoms without coordinates are left out: {count}, of which this is the first"
            ),
            ..place
        });
        Ok(Listed {
            atoms: self.atoms,
            told,
        })
    }
}

/// The names of the columns of fractions.
const PLACES: [&str; 3] = ["fract_x", "fract_y", "fract_z"];

/// The atoms of a list that have places, and what is said of the others.
pub(super) struct Listed {
    pub(super) atoms: Vec<AtomLine>,
    pub(super) told: Option<LocatedFault>,
}

impl Listed {
    pub(super) fn len(&self) -> usize {
        self.atoms.len()
    }
}
