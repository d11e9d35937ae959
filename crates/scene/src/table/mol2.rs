//! MOL2: sections `@<TRIPOS>…`, of which `MOLECULE` tells the number of atoms and `ATOM` has a line for each; molecules are
//! frames.
//!
//! # Source
//! Tripos, "Tripos Mol2 File Format", 2005.

use std::ops::Range;

use super::element;
use super::error::TableError;
use super::fields::{self, Division};
use super::form::{Form, LineKind, Rest, of_table};
use super::header::Header;
use super::input::Input;
use super::residue;
use crate::text::LocatedFault;

/// The columns of an atom. The type tells the element, too. What follows the type may be left out.
const NAMES: [&str; 10] = [
    "id",
    "name",
    "x",
    "y",
    "z",
    "type",
    "element",
    "residue_number",
    "residue",
    "charge",
];
/// The place of the type among the words of a line.
const TYPE: usize = 5;

const SECTION: &[u8] = b"@<TRIPOS>";
const MOLECULE: &[u8] = b"@<TRIPOS>MOLECULE";
const ATOM: &[u8] = b"@<TRIPOS>ATOM";

/// Says whether a text that begins so has a section of MOL2.
pub(crate) fn is_like(head: &[u8]) -> bool {
    let mut lines = head.split(|&byte| byte == b'\n').map(<[u8]>::trim_ascii);
    let first = lines.find(|line| of_table(line) == LineKind::Row);
    first.is_some_and(|line| line.starts_with(SECTION))
}

/// The header of the next molecule that has atoms; `None` behind the last one.
pub(crate) fn header(input: &mut Input<'_>) -> Result<Option<Header>, TableError> {
    let is_first = input.number == 0;
    let mut count = None;
    loop {
        let number = input.number + 1;
        let Some(line) = input.next()? else {
            return match (is_first, count) {
                (_, Some(_)) => {
                    Err(LocatedFault::at_end(number, "`@<TRIPOS>ATOM` of this molecule").into())
                }
                (true, None) => Err(LocatedFault::at_end(number, "`@<TRIPOS>MOLECULE`").into()),
                (false, None) => Ok(None),
            };
        };
        match line.trim_ascii_end() {
            MOLECULE if count.is_none() => {
                count = Some(self::count(input)?).filter(|count| *count > 0);
            }
            ATOM => {
                let line = line.to_vec();
                let Some(count) = count else {
                    let expected = "`@<TRIPOS>MOLECULE` with the number of atoms before";
                    let place = 0..line.len();
                    return Err(LocatedFault::expected(number, &line, place, expected).into());
                };
                return atoms(input, count, (number, &line)).map(Some);
            }
            MOLECULE => {
                let expected = "`@<TRIPOS>ATOM` of the molecule before";
                return Err(LocatedFault::expected(number, line, 0..line.len(), expected).into());
            }
            _ => {}
        }
    }
}

/// The number of atoms, which is the first one in the second line of a molecule.
fn count(input: &mut Input<'_>) -> Result<u64, TableError> {
    let expected = "the numbers of atoms and bonds";
    input.next()?;
    let number = input.number + 1;
    let Some(line) = input.next()? else {
        return Err(LocatedFault::at_end(number, expected).into());
    };
    let words = fields::all(line, &Division::Words);
    let count = words.first().and_then(|word| str::from_utf8(word).ok());
    let count = count.and_then(|word| word.parse().ok());
    count.ok_or_else(|| LocatedFault::expected(number, line, 0..line.len(), expected).into())
}

/// The header of so many atoms, behind this line.
fn atoms(input: &mut Input<'_>, count: u64, place: (u64, &[u8])) -> Result<Header, TableError> {
    while input
        .peek()?
        .is_some_and(|line| of_table(line) == LineKind::Other)
    {
        input.next()?;
    }
    let row = input.peek()?.unwrap_or_default();
    let columns = fields::all(row, &Division::Words).len() + 1;
    let names = &NAMES[..columns.clamp(TYPE + 2, NAMES.len())];
    const TEXTS: [&str; 4] = ["name", "type", "element", "residue"];
    let texts = names.iter().map(|name| TEXTS.contains(name)).collect();
    let form = Form {
        kind: |line| match line {
            [b'@', ..] => LineKind::End,
            line => of_table(line),
        },
        rest: Rest::Anything,
        element: |_, line, field| element(line, field),
        ..Form::new(Division::Repeated(TYPE))
    };
    let names = names.iter().map(|name| (*name).to_owned()).collect();
    Ok(Header {
        count: Some((count, "atoms, according to `@<TRIPOS>MOLECULE`")),
        close: |input, ends_with_row| close(input, ends_with_row).map(|()| None),
        texts: Some(texts),
        ..Header::new(names, form, place)
    })
}

/// Refuses more atoms than the molecule is said to have, and doubts the last one if nothing ends its line.
fn close(input: &mut Input<'_>, ends_with_row: bool) -> Result<(), TableError> {
    if ends_with_row && input.is_open_at_end() {
        let doubt = "the file ends within this line: its last number may have been cut off";
        input.doubt_line(doubt);
    }
    let number = input.number + 1;
    match input.peek()? {
        Some(line) if of_table(line) == LineKind::Row && !line.starts_with(SECTION) => {
            let expected = "a line `@<TRIPOS>…` after the atoms that `@<TRIPOS>MOLECULE` counts";
            Err(LocatedFault::expected(number, line, 0..line.len(), expected).into())
        }
        _ => Ok(()),
    }
}

/// The element that the type of an atom tells, as Tripos writes it: `C.3`, `Ca`; or else its name, since programs write the
/// types of other force fields there, such as `ca` of carbon.
fn element(line: &[u8], field: Range<usize>) -> Option<u8> {
    /// Types that stand for no element, or for any.
    const NONE: [&[u8]; 6] = [b"Du", b"LP", b"Any", b"Hal", b"Het", b"Hev"];
    let text = &line[field];
    let symbol = text.split(|byte| *byte == b'.').next().unwrap_or_default();
    if NONE.contains(&symbol) {
        return None;
    }
    element::of_exact_symbol(symbol).or_else(|| {
        let words = fields::all(line, &Division::Words);
        let residue = words.get(7).copied().unwrap_or_default();
        residue::of_atom(words.get(1)?, residue)
    })
}
