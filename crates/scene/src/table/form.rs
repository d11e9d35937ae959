//! The form of a text's rows.

use std::ops::Range;
use std::sync::Arc;

use super::element;
use super::elements::Atom;
use super::fields::Division;

/// The form of the rows of a text.
#[derive(Clone, Debug)]
pub(crate) struct Form {
    pub(crate) division: Division,
    /// What may stand behind the columns.
    pub(crate) rest: Rest,
    /// Numbers have commas where others have points.
    pub(crate) has_decimal_commas: bool,
    /// The kind of a line, used if the header does not tell how many rows follow.
    pub(crate) kind: fn(&[u8]) -> LineKind,
    /// The atomic number that a line tells in this field.
    pub(crate) element: ElementOf,
    /// The atom that all rows are, where no field tells it.
    pub(crate) atom: Option<FixedAtom>,
    /// The place of what atoms are called where nothing is in the field of the element.
    pub(crate) name: Range<usize>,
    /// The place of coordinates that have so many columns each, where they have.
    pub(crate) coordinates: Range<usize>,
    /// The part of a row whose fields are not where the form has them, and what was expected there.
    pub(crate) check: Check,
    /// The elements of types of atoms that the file names.
    pub(crate) types: Arc<[AtomType]>,
    /// Rows with a radius of 0 are atoms that have no surface: they are left out, and not refused.
    pub(crate) has_points: bool,
    /// Rows end before one that has something else in this column.
    pub(crate) same: Option<(usize, Vec<u8>)>,
}

/// What may stand behind the columns of a line.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub(crate) enum Rest {
    Nothing,
    /// A comment behind `#`.
    Comment,
    Anything,
}

/// A type of atoms that are an element.
#[derive(Clone, Debug)]
pub(crate) struct AtomType {
    /// What atoms have in the place of their type.
    pub(crate) label: Box<[u8]>,
    /// The atomic number.
    pub(crate) element: u8,
}

/// The atom that rows are.
#[derive(Clone, Debug)]
pub(crate) struct FixedAtom {
    /// The atomic number, 0 where there is none.
    pub(crate) number: u8,
    pub(crate) label: Arc<[u8]>,
}

/// The atomic number that a line tells in a field.
pub(crate) type ElementOf = fn(&Form, &[u8], Range<usize>) -> Option<u8>;

/// The part of a row that is not as the form has it, and what was expected.
pub(crate) type Check = fn(&Form, &[u8]) -> Option<(Range<usize>, &'static str)>;

/// The kind of a line.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub(crate) enum LineKind {
    Row,
    /// It says nothing of spheres.
    Other,
    /// It is not of this table any more.
    End,
}

impl Form {
    /// Rows that are divided so, as long as the header says; blank lines and comments are passed over.
    pub(crate) fn new(division: Division) -> Self {
        Self {
            division,
            rest: Rest::Nothing,
            has_decimal_commas: false,
            kind: of_table,
            element: |_, line, field| element::of_label(&line[field]),
            atom: None,
            name: 0..0,
            coordinates: 0..0,
            check: |_, _| None,
            types: Arc::new([]),
            has_points: false,
            same: None,
        }
    }

    /// The atom of a line that has its element in this field.
    #[inline]
    pub(crate) fn atom<'a>(&'a self, line: &'a [u8], field: Range<usize>) -> Atom<'a> {
        if let Some(atom) = &self.atom {
            return Atom {
                number: atom.number,
                label: &atom.label,
            };
        }
        let number = (self.element)(self, line, field.clone()).unwrap_or(0);
        let label = match line[field.clone()].is_empty() {
            true => line.get(self.name.clone()).unwrap_or_default(),
            false => &line[field],
        };
        Atom {
            number,
            label: label.trim_ascii(),
        }
    }
}

/// Finds coordinates that have left their columns: numbers that are too long for them push those that follow to the
/// right, so that digits of one are read as those of the next. Numbers that fill their columns have equally many decimals.
pub(crate) fn coordinates_run_together(
    form: &Form,
    line: &[u8],
) -> Option<(Range<usize>, &'static str)> {
    let all = form.coordinates.clone();
    let width = all.len() / 3;
    let is_of_number = |at: usize| {
        let byte = line.get(at);
        byte.is_some_and(|byte| byte.is_ascii_digit() || *byte == b'.')
    };
    let ends = (1..=3).map(|number| all.start + number * width);
    let mut touching = ends.filter(|end| is_of_number(end - 1) && is_of_number(*end));
    touching.next()?;
    let decimals = |number: usize| {
        let field = line.get(all.start + number * width..all.start + (number + 1) * width)?;
        let field = field.trim_ascii();
        let point = field.iter().position(|byte| *byte == b'.')?;
        Some(field.len() - point)
    };
    let is_even = decimals(0) == decimals(1) && decimals(1) == decimals(2);
    let end = all.end.min(line.len());
    (!is_even).then_some((
        all.start.min(end)..end,
        "coordinates that fit into their columns",
    ))
}

/// The kind of a line in a table that may have comments.
pub(crate) fn of_table(line: &[u8]) -> LineKind {
    match line.trim_ascii_start().first() {
        None | Some(b'#' | b'%') => LineKind::Other,
        Some(_) => LineKind::Row,
    }
}
