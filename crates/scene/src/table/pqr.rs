//! PQR: lines `ATOM` and `HETATM` of words, the last two of which are the charge and the radius; models are frames.
//!
//! # Source
//! The documentation of APBS and PDB2PQR, "PQR molecular structure format".

use std::ops::Range;

use super::error::TableError;
use super::fields::{self, Division, Fields};
use super::form::{Form, LineKind};
use super::header::Header;
use super::input::{Input, without_return};
use super::number::parse;
use super::pdb::Model;
use super::{pdb, residue};

/// The words of a line, of which the chain may be left out; the name tells the element.
const NAMES: [&str; 12] = [
    "record",
    "id",
    "name",
    "residue",
    "chain",
    "residue_number",
    "x",
    "y",
    "z",
    "charge",
    "radius",
    "element",
];

/// Says whether the comments at the start say that this is PQR and not PDB.
pub(crate) fn is_named(head: &[u8]) -> bool {
    let mut lines = head.split(|byte| *byte == b'\n');
    let is_comment = |line: &&[u8]| line.starts_with(b"REMARK") || line.starts_with(b"HEADER");
    let mut words = lines.by_ref().take_while(is_comment).flat_map(|line| {
        let words = line.split(u8::is_ascii_whitespace);
        words.filter(|word| !word.is_empty())
    });
    words.any(|word| word == b"PQR")
}

/// Says whether the first atom of a file that begins so has its numbers where PQR has them, and not in the columns of PDB.
pub(crate) fn is_like(head: &[u8]) -> bool {
    /// Occupancy and temperature factor, where PDB has them.
    const NUMBERS: [Range<usize>; 2] = [54..60, 60..66];
    let mut lines = head.split(|byte| *byte == b'\n').map(without_return);
    let Some(row) = lines.find(|line| kind(line) == LineKind::Row) else {
        return false;
    };
    let is_of_pdb = NUMBERS.iter().all(|place| {
        let end = place.end.min(row.len());
        let field = row[place.start.min(end)..end].trim_ascii();
        field.is_empty() || parse(field, false).is_some()
    });
    let words = fields::all(row, &Division::Pqr);
    let numbers = words.get(FIRST_NUMBER..FIRST_NUMBER + NUMBERS_OF_ROW);
    !is_of_pdb
        && check(row).is_none()
        && numbers.is_some_and(|words| words.iter().all(|word| parse(word, false).is_some()))
}

/// The place of the first of the numbers, and how many there are.
const FIRST_NUMBER: usize = 6;
const NUMBERS_OF_ROW: usize = 5;

/// The part of a row that should be the number of a residue and is not: a row with a word less or more has others there.
fn check(line: &[u8]) -> Option<(Range<usize>, &'static str)> {
    const RESIDUE: usize = 5;
    let mut words = Fields::new(line, &Division::Pqr);
    let mut words = std::iter::from_fn(|| words.next()).skip(RESIDUE);
    let (number, x) = (words.next()?, words.next()?);
    let text = &line[number.clone()];
    let is_number = text.iter().any(u8::is_ascii_digit) && !text.contains(&b'.');
    let insertion = line.get(number.end..x.start).unwrap_or_default();
    let is_letter = insertion.trim_ascii().iter().all(u8::is_ascii_alphabetic);
    (!is_number || !is_letter).then_some((
        number,
        "the number of a residue before x, y, z, the charge and the radius",
    ))
}

/// The header of the next model; `None` behind the last one.
pub(crate) fn header(input: &mut Input<'_>) -> Result<Option<Header>, TableError> {
    let Some(Model {
        number,
        row,
        close,
        cell,
    }) = pdb::model(input, kind)?
    else {
        return Ok(None);
    };
    let form = Form {
        kind,
        element: |_, line, field| {
            let words = fields::all(line, &Division::Pqr);
            let residue = words.get(3).copied().unwrap_or_default();
            residue::of_atom(&line[field], residue)
        },
        check: |_, line| check(line),
        has_points: true,
        ..Form::new(Division::Pqr)
    };
    const TEXTS: [&str; 6] = [
        "record",
        "name",
        "residue",
        "chain",
        "residue_number",
        "element",
    ];
    let texts = NAMES.map(|name| TEXTS.contains(&name));
    Ok(Some(Header {
        texts: Some(texts.into()),
        close,
        cell,
        ..Header::new(NAMES.map(String::from).into(), form, (number, &row))
    }))
}

fn kind(line: &[u8]) -> LineKind {
    let mut words = line.split(u8::is_ascii_whitespace);
    match pdb::kind(words.next().unwrap_or_default()) {
        LineKind::Other => pdb::kind(line),
        kind => kind,
    }
}
