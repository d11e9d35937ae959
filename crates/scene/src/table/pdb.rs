//! PDB: lines `ATOM` and `HETATM` with fields at fixed places, and models, which are frames.
//!
//! # Source
//! The format of the Protein Data Bank, version 3.3.

use std::ops::Range;

use super::cell::{Cell, ToldCell, numbers};
use super::element;
use super::error::TableError;
use super::fields::{self, Division};
use super::form::{Form, LineKind, coordinates_run_together};
use super::header::{Close, Header};
use super::input::Input;
use super::number::parse;
use super::residue;
use crate::text::LocatedFault;

/// The names of the columns, and their places.
const COLUMNS: [(&str, Range<usize>); 13] = [
    ("record", 0..6),
    ("id", 6..11),
    ("name", 12..16),
    ("alternate", 16..17),
    ("residue", 17..20),
    ("chain", 21..22),
    ("residue_number", 22..26),
    ("x", 30..38),
    ("y", 38..46),
    ("z", 46..54),
    ("occupancy", 54..60),
    ("b_factor", 60..66),
    ("element", 76..78),
];

/// The header of the next model, behind another one's where that is given; `None` behind the last one.
pub(crate) fn header(
    input: &mut Input<'_>,
    previous: Option<&Header>,
) -> Result<Option<Header>, TableError> {
    let Some(Model {
        number,
        row,
        close,
        cell,
    }) = model(input, kind)?
    else {
        return Ok(None);
    };
    // It stands before the first of several models.
    let cell = cell.or_else(|| previous?.cell.clone());
    // Some programs begin all names in the first column.
    let rows = input.head().split(|byte| *byte == b'\n');
    let mut rows = rows.filter(|line| kind(line) == LineKind::Row);
    let is_aligned = rows.any(|line| line.get(12..14).is_some_and(|name| name[0] == b' '));
    let places: Vec<Range<usize>> = COLUMNS.iter().map(|column| column.1.clone()).collect();
    let form = Form {
        kind,
        element: match is_aligned {
            true => |_, line, field| element(line, field, residue::of_aligned_atom),
            false => |_, line, field| element(line, field, residue::of_atom),
        },
        name: 12..16,
        coordinates: 30..54,
        check: coordinates_run_together,
        ..Form::new(Division::Fixed(places.into()))
    };
    let names = COLUMNS.iter().map(|column| column.0.to_owned()).collect();
    const TEXTS: [&str; 6] = ["record", "name", "alternate", "residue", "chain", "element"];
    let texts = COLUMNS.iter().map(|column| TEXTS.contains(&column.0));
    Ok(Some(Header {
        texts: Some(texts.collect()),
        close,
        cell,
        ..Header::new(names, form, (number, &row))
    }))
}

/// The first row of a model, and what has to stand behind its rows.
pub(super) struct Model {
    /// The number of the row's line.
    pub(super) number: u64,
    pub(super) row: Vec<u8>,
    pub(super) close: Close,
    pub(super) cell: Option<ToldCell>,
}

/// Goes on to the next model of lines that are of these kinds; `None` behind the last one.
pub(super) fn model(
    input: &mut Input<'_>,
    kind: fn(&[u8]) -> LineKind,
) -> Result<Option<Model>, TableError> {
    let is_first = input.number == 0;
    let (mut is_model, mut cell) = (false, None);
    loop {
        let number = input.number + 1;
        let Some(line) = input.peek()? else {
            break;
        };
        match kind(line) {
            LineKind::Row => break,
            LineKind::End => is_model = line.starts_with(b"MODEL"),
            LineKind::Other if line.starts_with(CELL) => cell = self::cell(number, line),
            LineKind::Other => {}
        }
        input.next()?;
    }
    let number = input.number + 1;
    let Some(row) = input.peek()?.map(<[u8]>::to_vec) else {
        let expected = "a line `ATOM` or `HETATM`";
        return match is_first || is_model {
            true => Err(LocatedFault::at_end(number, expected).into()),
            false => Ok(None),
        };
    };
    let close: Close = match (is_model, is_first) {
        (true, _) => close_model,
        // The frame before it ended so.
        (false, false) => close_frame,
        (false, true) => close_file,
    };
    Ok(Some(Model {
        number,
        row,
        close,
        cell,
    }))
}

/// The record of the cell.
const CELL: &[u8] = b"CRYST1";

/// The cell of a record; `None` if it has edges of length 1 or 0, as files have that are not of a crystal.
fn cell(number: u64, line: &[u8]) -> Option<ToldCell> {
    const PLACES: [Range<usize>; 6] = [6..15, 15..24, 24..33, 33..40, 40..47, 47..54];
    let fields = fields::all(line, &Division::Fixed(PLACES.to_vec().into()));
    let words = fields::all(line, &Division::Words);
    // Some programs write it with spaces alone.
    let found = numbers::<6>(&fields).or_else(|| numbers::<6>(words.get(1..7)?));
    let told = match found {
        Some([a, b, c, ..]) if [a, b, c] == [1.0; 3] || [a, b, c] == [0.0; 3] => return None,
        Some([a, b, c, alpha, beta, gamma]) => {
            let cell = Cell::of_lengths([a, b, c], [alpha, beta, gamma]);
            cell.map_err(|message| LocatedFault::in_line(number, line, 0..line.len(), message))
        }
        None => {
            let expected = "three lengths and three angles of the cell";
            let start = CELL.len().min(line.len());
            Err(LocatedFault::expected(
                number,
                line,
                start..line.len(),
                expected,
            ))
        }
    };
    Some(told)
}

/// Refuses a model that nothing ends.
fn close_model(input: &mut Input<'_>, _: bool) -> Result<Option<ToldCell>, TableError> {
    expect_end(input, "`ENDMDL` after the atoms of this model")
}

/// Refuses a frame that nothing ends, as others in the file end.
fn close_frame(input: &mut Input<'_>, _: bool) -> Result<Option<ToldCell>, TableError> {
    expect_end(
        input,
        "`END` after the atoms of this frame, as in the frames before",
    )
}

/// Doubts a file that ends with an atom.
fn close_file(input: &mut Input<'_>, ends_with_row: bool) -> Result<Option<ToldCell>, TableError> {
    if (ends_with_row || input.is_open_at_end()) && input.peek()?.is_none() {
        let doubt = match ends_with_row {
            true => {
                "the file ends with an atom, without `TER` or `END`: others may have been cut off"
            }
            false => "the file ends within this line, without `END`: atoms may have been cut off",
        };
        input.doubt_line(doubt);
    }
    Ok(None)
}

fn expect_end(input: &mut Input<'_>, expected: &str) -> Result<Option<ToldCell>, TableError> {
    let number = input.number + 1;
    let fault = match input.peek()? {
        None => LocatedFault::at_end(number, expected),
        Some(line) if line.starts_with(b"END") => return Ok(None),
        Some(line) => LocatedFault::expected(number, line, 0..line.len(), expected),
    };
    Err(fault.into())
}

pub(super) fn kind(line: &[u8]) -> LineKind {
    let word = line.get(..6).unwrap_or(line).trim_ascii_end();
    match word {
        b"ATOM" | b"HETATM" => LineKind::Row,
        b"ENDMDL" | b"END" | b"MODEL" => LineKind::End,
        _ if is_irregular_row(line) => LineKind::Row,
        _ => LineKind::Other,
    }
}

/// Says whether a line that does not begin as the format says is an atom all the same: in lower case, with spaces before it, or
/// with a number that begins too early. Whether its fields are where they should be is found out when it is read.
fn is_irregular_row(line: &[u8]) -> bool {
    const RECORDS: [&[u8]; 2] = [b"ATOM", b"HETATM"];
    /// Three coordinates have as many.
    const POINTS: usize = 3;
    let line = line.trim_ascii_start();
    let mut records = RECORDS.iter();
    let is_begun = records.any(|record| {
        let (start, rest) = line.split_at_checked(record.len()).unwrap_or_default();
        let is_end = |byte: &u8| byte.is_ascii_digit() || byte.is_ascii_whitespace();
        start.eq_ignore_ascii_case(record) && rest.first().is_some_and(is_end)
    });
    is_begun && memchr::memchr_iter(b'.', line).count() >= POINTS
}

/// The element, or else what the name of the atom tells of it.
fn element(
    line: &[u8],
    field: Range<usize>,
    by_name: fn(&[u8], &[u8]) -> Option<u8>,
) -> Option<u8> {
    if let Some(kind) = docking_type(line) {
        return residue::of_docking_type(kind);
    }
    // Old files have numbers of lines there.
    element::of_symbol(&line[field]).or_else(|| {
        let residue = line.get(17..21).unwrap_or_default();
        by_name(line.get(12..16)?, residue)
    })
}

/// The type of an atom in PDBQT, which has a charge before it where PDB has none.
fn docking_type(line: &[u8]) -> Option<&[u8]> {
    let charge = line.get(70..76)?.trim_ascii();
    let is_charge = charge.contains(&b'.') && parse(charge, false).is_some();
    let kind = line.get(77..line.len().min(79))?.trim_ascii();
    (is_charge && !kind.is_empty()).then_some(kind)
}
