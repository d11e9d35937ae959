//! CIF: the loop `_atom_site` of a file of the Protein Data Bank (mmCIF), whose models and data blocks are frames, or of a
//! crystal; the loop `_chem_comp_atom` of a chemical component.
//!
//! # Source
//! Hall, Allen and Brown, "The crystallographic information file (CIF)", 1991; the dictionary PDBx/mmCIF.

use std::sync::Arc;

use memchr::memmem;

use super::cell::ToldCell;
use super::cif::{Items, Lexer};
use super::crystal;
use super::error::TableError;
use super::fields::{self, Division};
use super::form::{Form, LineKind};
use super::header::Header;
use super::input::Input;
use crate::text::LocatedFault;

/// The category of atoms, of molecules, of crystals, and of chemical components.
const CATEGORIES: [&str; 3] = ["_atom_site.", "_atom_site_", COMPONENT];
const COMPONENT: &str = "_chem_comp_atom.";
const MODEL: &str = "pdbx_PDB_model_num";

/// The header of the next model, behind another one's where that is given; `None` behind the last one.
pub(crate) fn header(
    input: &mut Input<'_>,
    previous: Option<&Header>,
) -> Result<Option<Header>, TableError> {
    if let Some(previous) = previous {
        while input
            .peek()?
            .is_some_and(|line| kind(line) == LineKind::Other)
        {
            input.next()?;
        }
        if let Some(row) = input.peek()?.filter(|line| kind(line) == LineKind::Row) {
            let mut header = previous.clone();
            header.form.same = same(&header.names, row);
            return Ok(Some(header));
        }
    }
    let (mut items, mut lexer) = (Items::default(), Lexer::default());
    loop {
        let number = input.number + 1;
        let Some(line) = input.next()? else {
            return match previous {
                Some(_) => Ok(None),
                None => {
                    let expected = "a loop of `_atom_site.…`, of `_atom_site_fract_x` and others, or of \
                                    `_chem_comp_atom.model_Cartn_x` and others";
                    Err(LocatedFault::at_end(number, expected).into())
                }
            };
        };
        let is_in_text = lexer.is_in_text();
        if is_in_text || !items.is_unneeded(line) {
            lexer.feed(line, |token| items.take(number, line, token));
        }
        let line = line.trim_ascii();
        let category = CATEGORIES
            .iter()
            .find(|category| starts_with(line, category));
        let (false, Some(category)) = (is_in_text, category) else {
            continue;
        };
        let is_molecule = *category == CATEGORIES[0];
        if let [_, value, ..] = fields::all(line, &Division::QuotedWords)[..]
            && !value.starts_with(b"#")
        {
            if !is_molecule {
                continue;
            }
            let expected = "a loop of `_atom_site.…`, whose rows are atoms";
            return Err(LocatedFault::expected(number, line, 0..line.len(), expected).into());
        }
        let first = (number, line.to_vec());
        let mut names = vec![name(line, category)];
        add_names(input, (&mut lexer, &mut items), category, &mut names)?;
        let has = |wanted: &str| names.iter().any(|name| name.eq_ignore_ascii_case(wanted));
        if *category == COMPONENT {
            // Files of structures may list the atoms of their components, too.
            let is_behind = previous.is_some_and(|previous| previous.names != names);
            let is_ahead = memmem::find(input.head(), CATEGORIES[0].as_bytes()).is_some();
            if is_behind || is_ahead || !(has("model_Cartn_x") || has("x")) {
                continue;
            }
            return Ok(Some(Header {
                close,
                ..Header::new(
                    names,
                    Form {
                        kind,
                        ..Form::new(Division::QuotedWords)
                    },
                    (first.0, &first.1),
                )
            }));
        }
        match (has("Cartn_x") && is_molecule, has("fract_x")) {
            (false, true) => {
                let crystal = crystal::read(input, items, &names)?;
                let form = Form::new(Division::QuotedWords);
                return Ok(Some(Header {
                    cell: Some(crystal.cell().clone()),
                    crystal: Some(Arc::new(crystal)),
                    ..Header::new(names, form, (first.0, &first.1))
                }));
            }
            // Displacements and the like.
            (false, false) if !is_molecule => continue,
            _ => {}
        }
        // Any frame may be read after any other.
        if let Some(previous) = previous
            && previous.names != names
        {
            let expected = "the columns of the atoms before, in the same order";
            return Err(
                LocatedFault::expected(first.0, &first.1, 0..first.1.len(), expected).into(),
            );
        }
        let mut form = Form {
            kind,
            ..Form::new(Division::QuotedWords)
        };
        form.same = input.peek()?.and_then(|row| same(&names, row));
        return Ok(Some(Header {
            close,
            cell: items.cell_of_molecule(),
            ..Header::new(names, form, (first.0, &first.1))
        }));
    }
}

/// Adds the names of the next lines that are of this category.
fn add_names(
    input: &mut Input<'_>,
    (lexer, items): (&mut Lexer, &mut Items),
    category: &str,
    names: &mut Vec<String>,
) -> Result<(), TableError> {
    loop {
        let number = input.number + 1;
        let Some(line) = input.peek()? else {
            return Ok(());
        };
        let word = line.trim_ascii();
        if starts_with(word, category) {
            names.push(name(word, category));
        } else if kind(word) != LineKind::Other {
            return Ok(());
        }
        let line = input.next()?.unwrap_or_default();
        lexer.feed(line, |token| items.take(number, line, token));
    }
}

/// Doubts a file that ends with an atom: programs write a line `#` behind the loop.
fn close(input: &mut Input<'_>, ends_with_row: bool) -> Result<Option<ToldCell>, TableError> {
    let number = input.number + 1;
    match input.peek()? {
        None if ends_with_row => {
            let doubt =
                "the file ends with an atom, without a line `#`: others may have been cut off";
            input.doubt_line(doubt);
        }
        Some(line) if line.starts_with(b";") => {
            let expected = "an atom on one line, without text of several lines";
            return Err(LocatedFault::expected(number, line, 0..line.len(), expected).into());
        }
        _ => {}
    }
    Ok(None)
}

/// The model of a row, which all rows of a frame have.
fn same(names: &[String], row: &[u8]) -> Option<(usize, Vec<u8>)> {
    let column = names
        .iter()
        .position(|name| name.eq_ignore_ascii_case(MODEL))?;
    let fields = fields::all(row, &Division::QuotedWords);
    Some((column, fields.get(column)?.to_vec()))
}

fn starts_with(line: &[u8], prefix: &str) -> bool {
    line.get(..prefix.len())
        .is_some_and(|start| start.eq_ignore_ascii_case(prefix.as_bytes()))
}

/// The name behind that of the category.
fn name(line: &[u8], category: &str) -> String {
    let word = line
        .split(u8::is_ascii_whitespace)
        .next()
        .unwrap_or_default();
    String::from_utf8_lossy(&word[category.len().min(word.len())..]).into_owned()
}

fn kind(line: &[u8]) -> LineKind {
    const RESERVED: [&str; 5] = ["loop_", "data_", "save_", "global_", "stop_"];
    match line.trim_ascii_start() {
        [] | [b'#', ..] => LineKind::Other,
        _ if line.starts_with(b";") => LineKind::End,
        [b'_', ..] => LineKind::End,
        line if RESERVED.iter().any(|word| starts_with(line, word)) => LineKind::End,
        _ => LineKind::Row,
    }
}
