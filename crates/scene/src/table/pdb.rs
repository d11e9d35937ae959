//! PDB: lines `ATOM` and `HETATM` with fields at fixed places, and models, which are frames.
//!
//! # Source
//! The format of the Protein Data Bank, version 3.3.

use std::ops::Range;

use super::element;
use super::error::TableError;
use super::fields::Division;
use super::form::{Form, LineKind};
use super::header::Header;
use super::input::Input;
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

/// The header of the next model; `None` behind the last one.
pub(crate) fn header(input: &mut Input<'_>) -> Result<Option<Header>, TableError> {
    let is_first = input.number == 0;
    let mut is_model = false;
    while let Some(line) = input.peek()? {
        match kind(line) {
            LineKind::Row => break,
            LineKind::End => is_model = line.starts_with(b"MODEL"),
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
    let places: Vec<Range<usize>> = COLUMNS.iter().map(|column| column.1.clone()).collect();
    let form = Form {
        kind,
        element: self::element,
        ..Form::new(Division::Fixed(places.into()))
    };
    let names = COLUMNS.iter().map(|column| column.0.to_owned()).collect();
    const TEXTS: [&str; 6] = ["record", "name", "alternate", "residue", "chain", "element"];
    let texts = COLUMNS.iter().map(|column| TEXTS.contains(&column.0));
    Ok(Some(Header {
        texts: Some(texts.collect()),
        close: match (is_model, is_first) {
            (true, _) => close_model,
            // The frame before it ended so.
            (false, false) => close_frame,
            (false, true) => close_file,
        },
        ..Header::new(names, form, (number, &row))
    }))
}

/// Refuses a model that nothing ends.
fn close_model(input: &mut Input<'_>, _: bool) -> Result<(), TableError> {
    expect_end(input, "`ENDMDL` behind the atoms of this model")
}

/// Refuses a frame that nothing ends, as others in the file end.
fn close_frame(input: &mut Input<'_>, _: bool) -> Result<(), TableError> {
    expect_end(
        input,
        "`END` behind the atoms of this frame, as behind those before",
    )
}

/// Doubts a file that ends with an atom.
fn close_file(input: &mut Input<'_>, ends_with_row: bool) -> Result<(), TableError> {
    if (ends_with_row || input.is_open_at_end()) && input.peek()?.is_none() {
        let doubt = match ends_with_row {
            true => {
                "the file ends with an atom, without `TER` or `END`: others may have been cut off"
            }
            false => "the file ends within this line, without `END`: atoms may have been cut off",
        };
        input.doubt(LocatedFault::in_line(
            input.number,
            b"",
            0..0,
            doubt.to_owned(),
        ));
    }
    Ok(())
}

fn expect_end(input: &mut Input<'_>, expected: &str) -> Result<(), TableError> {
    let number = input.number + 1;
    let fault = match input.peek()? {
        None => LocatedFault::at_end(number, expected),
        Some(line) if line.starts_with(b"END") => return Ok(()),
        Some(line) => LocatedFault::expected(number, line, 0..line.len(), expected),
    };
    Err(fault.into())
}

fn kind(line: &[u8]) -> LineKind {
    let word = line.get(..6).unwrap_or(line).trim_ascii_end();
    match word {
        b"ATOM" | b"HETATM" => LineKind::Row,
        b"ENDMDL" | b"END" | b"MODEL" => LineKind::End,
        _ => LineKind::Other,
    }
}

/// The element, or else what the name of the atom tells of it.
fn element(line: &[u8], field: Range<usize>) -> Option<u8> {
    if !field.is_empty()
        && let Some(element) = element::number(&line[field])
    {
        return Some(element);
    }
    let name = line.get(12..16)?;
    let residue = line.get(17..20).unwrap_or_default();
    // Symbols of one letter begin at the second place.
    match name[0].is_ascii_alphabetic() && name[3] == b' ' {
        true if name[1].is_ascii_alphabetic() => element::number(&name[..2]),
        true => None,
        false => None,
    }
    .or_else(|| element::of_atom(name, residue))
}
