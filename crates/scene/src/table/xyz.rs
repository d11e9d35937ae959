//! XYZ and extended XYZ: the number of atoms, a comment, a line for each atom, and so on for each frame.
//!
//! An extended comment says in `Properties=name:type:columns:…` what the columns are; without one
//! they are the element and its place, and what follows is passed over.

use std::ops::Range;

use glam::{DMat3, DVec3};

use super::cell::{Cell, ToldCell, numbers};
use super::columns::{MOST_COLUMNS, Slot, components};
use super::element;
use super::error::TableError;
use super::fields::{self, Division};
use super::form::{ElementOf, Form, LineKind, Rest};
use super::guess::{self, Guess};
use super::header::Header;
use super::input::Input;
use crate::text::{LocatedFault, show};

/// The header of the next frame, behind another one's where that is given; `None` behind the last one.
pub(crate) fn header(
    input: &mut Input<'_>,
    previous: Option<&Header>,
) -> Result<Option<Header>, TableError> {
    let is_first = input.number == 0;
    while !is_first
        && input
            .peek()?
            .is_some_and(|line| line.trim_ascii().is_empty())
    {
        input.next()?;
    }
    let first = input.number + 1;
    if !is_first && input.peek()?.is_none() {
        return Ok(None);
    }
    let count = count(input)?;
    let comment = input.next()?.map(<[u8]>::to_vec);
    let comment = comment.ok_or_else(|| LocatedFault::at_end(first + 1, "a comment"))?;
    let columns = columns(&comment, first + 1)?;
    let is_extended = columns.is_some();
    let columns = columns.unwrap_or_else(|| ["element", "x", "y", "z"].map(String::from).into());
    let form = Form {
        rest: match is_extended {
            true => Rest::Nothing,
            false => Rest::Anything,
        },
        element: |_, line, field| element::of_label(&line[field]),
        ..Form::new(Division::Words)
    };
    let noun = match is_first {
        true => "atoms, according to the first line",
        false => "atoms, according to the first line of the frame",
    };
    let guess = match previous {
        Some(previous) => previous.guess.clone(),
        None => guess(input, &columns, &comment, count)?,
    };
    let header = Header::new(columns, form, (first + 1, &comment));
    Ok(Some(Header {
        cell: cell(&comment, first + 1),
        count: Some((count, noun)),
        guess,
        ..header
    }))
}

/// The meaning of numbers in place of symbols of elements: types, as LAMMPS writes them, or atomic numbers.
/// `None` where there are symbols.
fn guess(
    input: &mut Input<'_>,
    columns: &[String],
    comment: &[u8],
    count: u64,
) -> Result<Option<Guess>, TableError> {
    const ROWS: usize = 1000;
    let mut is_element = Slot::Element.names().iter();
    let Some(column) = is_element.find_map(|name| {
        let mut names = columns.iter();
        names.position(|column| column.eq_ignore_ascii_case(name))
    }) else {
        return Ok(None);
    };
    let number = input.number + 1;
    let Some(first) = input.peek()?.map(<[u8]>::to_vec) else {
        return Ok(None);
    };
    let rows = usize::try_from(count).unwrap_or(ROWS).min(ROWS);
    let all_are_rows = |_: &[u8]| LineKind::Row;
    let Some(numbers) = guess::numbers(input, column, &Division::Words, all_are_rows, rows) else {
        return Ok(None);
    };
    let is_by_lammps = comment.trim_ascii_start().starts_with(b"Atoms");
    let are_types = is_by_lammps || guess::are_of_types(&numbers);
    let column = &columns[column];
    let (element, told): (ElementOf, _) = match are_types {
        true => (
            |_, line, field| element::of_lettered_label(&line[field]),
            format!(
                "the numbers in the column `{column}` are read as types of atoms, not as atomic numbers; if they \
                 are atomic numbers, use `columns: (element: {column:?})`; if not, set radii and colors of the \
                 types with `radii: {{\"1\": …}}` and `palette: {{\"1\": …}}`"
            ),
        ),
        false => (
            |_, line, field| element::of_label(&line[field]),
            guess::as_atomic_numbers(column),
        ),
    };
    let told = LocatedFault::in_line(number, &first, 0..first.len(), told);
    Ok(Some(Guess { element, told }))
}

/// The number in the first line of a frame.
fn count(input: &mut Input<'_>) -> Result<u64, TableError> {
    let expected = "the number of atoms";
    let number = input.number + 1;
    let Some(line) = input.next()? else {
        return Err(LocatedFault::at_end(number, expected).into());
    };
    let text = line.trim_ascii();
    let count = str::from_utf8(text).ok().and_then(|text| text.parse().ok());
    count.ok_or_else(|| {
        let start = line.len() - line.trim_ascii_start().len();
        LocatedFault::expected(number, line, start..start + text.len(), expected).into()
    })
}

/// The place of the value that a comment gives to a key: `Key=…`, perhaps with spaces around the sign.
fn value_of(comment: &[u8], key: &[u8]) -> Option<usize> {
    let keys = comment.windows(key.len()).enumerate();
    let mut keys = keys.filter(|(_, part)| part.eq_ignore_ascii_case(key));
    let spaces = |from: usize| {
        let rest = comment[from..].iter();
        from + rest.take_while(|byte| **byte == b' ').count()
    };
    let sign = keys.find_map(|(at, _)| {
        let sign = spaces(at + key.len());
        (comment.get(sign) == Some(&b'=')).then_some(sign)
    })?;
    Some(spaces(sign + 1))
}

/// The words between quotation marks or brackets that a comment gives to a key, and their place.
fn words<'a>(comment: &'a [u8], key: &[u8]) -> Option<(Vec<&'a [u8]>, Range<usize>)> {
    let start = value_of(comment, key)?;
    let end = match comment.get(start)? {
        quote @ (b'"' | b'\'') => *quote,
        b'{' => b'}',
        b'[' => b']',
        _ => return None,
    };
    let length = memchr::memchr(end, &comment[start + 1..])?;
    let span = start + 1..start + 1 + length;
    let words = fields::all(&comment[span.clone()], &Division::Words);
    Some((words, span))
}

/// The cell that an extended comment tells: `Lattice` has the three edges one after another, `Origin` the corner, and
/// `pbc` says along which edges the cell repeats.
fn cell(comment: &[u8], number: u64) -> Option<ToldCell> {
    let (lattice, span) = words(comment, b"Lattice")?;
    let told = match numbers::<9>(&lattice) {
        Some(edges) => {
            let origin = words(comment, b"Origin").and_then(|(words, _)| numbers::<3>(&words));
            let edges = DMat3::from_cols_array(&edges);
            let told = Cell::new(edges, DVec3::from_array(origin.unwrap_or_default()));
            told.map_err(|message| LocatedFault::in_line(number, comment, span, message))
        }
        None => {
            let expected = "the nine numbers of the edges of the cell";
            Err(LocatedFault::expected(number, comment, span, expected))
        }
    };
    let pbc = words(comment, b"pbc").map(|(words, _)| words);
    let is_periodic = match pbc.as_deref() {
        Some([a, b, c]) => [a, b, c].map(|word| !b"Ff0".contains(&word[0])),
        _ => [true; 3],
    };
    Some(told.map(|cell| cell.periodic_along(is_periodic)))
}

/// The names of the columns that an extended comment lists.
fn columns(comment: &[u8], number: u64) -> Result<Option<Vec<String>>, LocatedFault> {
    let Some(start) = value_of(comment, b"Properties") else {
        return Ok(None);
    };
    let is_quoted = comment.get(start) == Some(&b'"');
    let start = start + usize::from(is_quoted);
    let is_end = |byte: &u8| byte.is_ascii_whitespace() || *byte == b'"';
    let length = comment[start..].iter().position(is_end);
    let span = start..length.map_or(comment.len(), |length| start + length);
    let text = String::from_utf8_lossy(&comment[span.clone()]).into_owned();
    let parts: Vec<&str> = text.split(':').collect();
    let mut names = Vec::new();
    for property in parts.chunks(3) {
        const MOST_OF_A_PROPERTY: u64 = 1000;
        let count = match property {
            [_, "S" | "R" | "I" | "L", count] => count.parse::<u64>().ok(),
            _ => None,
        };
        let count = count.filter(|count| (1..=MOST_OF_A_PROPERTY).contains(count));
        let Some(count) = count else {
            let expected = "expected properties `name:type:columns`, of type S, R, I or L";
            let message = format!("{expected}, found {}", show(&property.join(":")));
            return Err(LocatedFault::in_line(number, comment, span, message));
        };
        if count > (MOST_COLUMNS - names.len()) as u64 {
            let message = format!("expected at most {MOST_COLUMNS} columns, found more");
            return Err(LocatedFault::in_line(number, comment, span, message));
        }
        names.extend(match (property[0], count) {
            // The atomic number, beside a species.
            ("z" | "Z", 1) => vec![String::from("atomic number")],
            (name, _) => components(name, count),
        });
    }
    Ok(Some(names))
}
