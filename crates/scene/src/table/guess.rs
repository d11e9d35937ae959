//! Numbers in the column of elements, which may be atomic numbers or the numbers of something else.

use std::collections::BTreeSet;

use super::fields::{self, Division, Fields};
use super::form::{ElementOf, Form, LineKind};
use super::input::{Input, without_return};
use crate::text::LocatedFault;

/// A guess about the numbers in the column of elements.
#[derive(Clone, Debug)]
pub(crate) struct Guess {
    /// The meaning of the numbers.
    pub(crate) element: ElementOf,
    /// The message and its place.
    pub(crate) told: LocatedFault,
}

/// The different numbers in a column of the next rows; `None` if one of the values is not a number.
pub(super) fn numbers(
    input: &Input<'_>,
    column: usize,
    division: &Division,
    kind: fn(&[u8]) -> LineKind,
    rows: usize,
) -> Option<BTreeSet<u32>> {
    let lines = input.head().split(|byte| *byte == b'\n');
    let lines = lines.map(without_return);
    let mut numbers = BTreeSet::new();
    for line in lines.filter(|line| kind(line) == LineKind::Row).take(rows) {
        let fields = fields::all(line, division);
        let Some(field) = fields.get(column) else {
            break;
        };
        if field.is_empty() || !field.iter().all(u8::is_ascii_digit) {
            return None;
        }
        let number = str::from_utf8(field).ok();
        numbers.extend(number.and_then(|number| number.parse::<u32>().ok()));
    }
    Some(numbers)
}

/// Whether these look like the numbers of types: nothing consists of exactly the elements from hydrogen on.
pub(super) fn are_of_types(numbers: &BTreeSet<u32>) -> bool {
    !numbers.is_empty() && numbers.iter().copied().eq(1..=numbers.len() as u32)
}

/// Says whether the number in a column of a line is the element of this line: that of an old PDB file, which has the numbers
/// of its lines there, is not.
pub(super) fn is_atomic_number(line: &[u8], column: usize, form: &Form) -> bool {
    let mut fields = Fields::new(line, &form.division);
    let field = std::iter::from_fn(|| fields.next()).nth(column);
    field.is_some_and(|field| {
        let number = str::from_utf8(&line[field.clone()]).ok();
        let number = number.and_then(|number| number.parse::<u8>().ok());
        number.is_some_and(|number| form.atom(line, field).number == number)
    })
}

/// The message for numbers in this column that are read as atomic numbers.
pub(super) fn as_atomic_numbers(column: &str) -> String {
    format!(
        "the numbers in the column `{column}` are read as atomic numbers; confirm this with `columns: (element: \
         {column:?})`"
    )
}
