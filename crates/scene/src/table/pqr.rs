//! PQR: lines `ATOM` and `HETATM` of words, the last two of which are the charge and the radius; models are frames.
//!
//! # Source
//! The documentation of APBS and PDB2PQR, "PQR molecular structure format".

use super::error::TableError;
use super::fields::{self, Division};
use super::form::{Form, LineKind};
use super::header::Header;
use super::input::Input;
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

/// The header of the next model; `None` behind the last one.
pub(crate) fn header(input: &mut Input<'_>) -> Result<Option<Header>, TableError> {
    let Some(Model { number, row, close }) = pdb::model(input, kind)? else {
        return Ok(None);
    };
    let form = Form {
        kind,
        element: |line, field| {
            let words = fields::all(line, &Division::Pqr);
            let residue = words.get(3).copied().unwrap_or_default();
            residue::of_atom(&line[field], residue)
        },
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
        ..Header::new(NAMES.map(String::from).into(), form, (number, &row))
    }))
}

fn kind(line: &[u8]) -> LineKind {
    let word = line.split(u8::is_ascii_whitespace).next();
    pdb::kind(word.unwrap_or_default())
}
