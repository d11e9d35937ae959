//! MOL and SDF: three lines about a molecule, its counts, a line for each atom, and bonds; in an SDF, molecules are frames.
//!
//! In the version V2000, fields stand in fixed columns; in V3000, they are words behind `M  V30`.
//!
//! # Source
//! Dassault Systèmes, "CTfile Formats", 2020.

use std::ops::Range;

use super::element;
use super::error::TableError;
use super::fields::{self, Division};
use super::form::{Form, LineKind, Rest, coordinates_run_together};
use super::header::Header;
use super::input::{Input, without_return};
use crate::text::LocatedFault;

/// The places of the fields of an atom in V2000.
const PLACES: [(&str, Range<usize>); 4] = [
    ("x", 0..10),
    ("y", 10..20),
    ("z", 20..30),
    ("element", 31..34),
];
/// The words of an atom in V3000, the first of them.
const WORDS: [&str; 5] = ["id", "element", "x", "y", "z"];

/// The start of a line of V3000, and the end of a molecule and of its entry in an SDF.
const V30: &[u8] = b"M  V30 ";
const END: &[u8] = b"M  END";
const END_OF_ENTRY: &[u8] = b"$$$$";

/// The lines before those of the counts.
const LINES_BEFORE: usize = 3;

/// Says whether the fourth line of a text that begins so has counts and the version.
pub(crate) fn is_like(head: &[u8]) -> bool {
    let mut lines = head.split(|&byte| byte == b'\n').map(without_return);
    let counts = lines.nth(LINES_BEFORE).unwrap_or_default();
    let counts = counts.trim_ascii_end();
    counts.ends_with(b"V2000") || counts.ends_with(b"V3000")
}

/// The header of the next molecule; `None` behind the last one.
pub(crate) fn header(input: &mut Input<'_>) -> Result<Option<Header>, TableError> {
    const EXPECTED: &str = "the numbers of atoms and bonds in the fourth line of a molecule";
    let is_first = input.number == 0;
    let mut is_blank = true;
    for _ in 0..LINES_BEFORE {
        is_blank &= input
            .next()?
            .is_none_or(|line| line.trim_ascii().is_empty());
    }
    let number = input.number + 1;
    let Some(line) = input.next()?.map(<[u8]>::to_vec) else {
        return match is_blank && !is_first {
            true => Ok(None),
            false => Err(LocatedFault::at_end(number, EXPECTED).into()),
        };
    };
    if line.trim_ascii_end().ends_with(b"V3000") {
        return extended(input).map(Some);
    }
    let counts = [0..3, 3..6].map(|place| whole(line.get(place).unwrap_or_default()));
    let [Some(count), Some(_)] = counts else {
        return Err(LocatedFault::expected(number, &line, 0..line.len(), EXPECTED).into());
    };
    let places: Vec<Range<usize>> = PLACES.iter().map(|place| place.1.clone()).collect();
    let form = Form {
        kind: |line| match line.starts_with(b"M  ") {
            true => LineKind::End,
            false => LineKind::Row,
        },
        element: |_, line, field| element::of_symbol(&line[field]),
        coordinates: 0..30,
        check: coordinates_run_together,
        ..Form::new(Division::Fixed(places.into()))
    };
    let names: Vec<String> = PLACES.iter().map(|place| place.0.to_owned()).collect();
    Ok(Some(Header {
        count: Some((count, "atoms, according to the fourth line of the molecule")),
        close: |input, _| close(input).map(|()| None),
        texts: Some(names.iter().map(|name| name == "element").collect()),
        ..Header::new(names, form, (number, &line))
    }))
}

/// The header of a molecule of V3000, whose counts and atoms are in blocks.
fn extended(input: &mut Input<'_>) -> Result<Header, TableError> {
    let mut count = None;
    loop {
        let number = input.number + 1;
        let expected = match count {
            None => "`M  V30 COUNTS` with the number of atoms",
            Some(_) => "`M  V30 BEGIN ATOM`",
        };
        let Some(line) = input.next()?.map(<[u8]>::to_vec) else {
            return Err(LocatedFault::at_end(number, expected).into());
        };
        let refused = || LocatedFault::expected(number, &line, 0..line.len(), expected);
        let words = fields::all(
            line.strip_prefix(V30).ok_or_else(refused)?,
            &Division::Words,
        );
        match (&words[..], count) {
            ([b"COUNTS", atoms, ..], None) => {
                count = Some(whole(atoms).ok_or_else(refused)?);
                if count == Some(0) {
                    return Ok(of_words(0, (number, &line)));
                }
            }
            ([b"BEGIN", b"ATOM"], Some(count)) => return Ok(of_words(count, (number, &line))),
            ([b"END", b"CTAB"], _) => return Err(refused().into()),
            _ => {}
        }
    }
}

/// The header of so many atoms of V3000.
fn of_words(count: u64, place: (u64, &[u8])) -> Header {
    let form = Form {
        kind: |line| match line.starts_with(b"M  V30 END") {
            true => LineKind::End,
            false => LineKind::Row,
        },
        rest: Rest::Anything,
        element: |_, line, field| element::of_symbol(&line[field]),
        check: |_, line| check(line),
        ..Form::new(Division::Behind(V30.len()))
    };
    let names = WORDS.map(String::from).into();
    Header {
        count: Some((count, "atoms, according to `M  V30 COUNTS`")),
        close: |input, has_rows| close_extended(input, has_rows).map(|()| None),
        texts: Some(WORDS.map(|name| name == "element").into()),
        ..Header::new(names, form, place)
    }
}

/// The part of a line of V3000 that is not as an atom on one line has it.
fn check(line: &[u8]) -> Option<(Range<usize>, &'static str)> {
    if !line.starts_with(V30) {
        return Some((0..line.len(), "an atom behind `M  V30`"));
    }
    let end = line.trim_ascii_end().len();
    let is_continued = line[..end].ends_with(b"-");
    is_continued.then_some((end - 1..end, "an atom on one line, without `-` at its end"))
}

/// A whole number in a field.
fn whole(field: &[u8]) -> Option<u64> {
    str::from_utf8(field.trim_ascii()).ok()?.parse().ok()
}

/// Passes over what stands behind the atoms of V3000, and refuses others.
fn close_extended(input: &mut Input<'_>, has_rows: bool) -> Result<(), TableError> {
    let number = input.number + 1;
    if let Some(line) = input.peek()?
        && has_rows
        && line.trim_ascii_end() != b"M  V30 END ATOM"
    {
        let expected = "`M  V30 END ATOM` after the atoms that `M  V30 COUNTS` counts";
        return Err(LocatedFault::expected(number, line, 0..line.len(), expected).into());
    }
    close(input)
}

/// Passes over what stands behind the atoms, to the end of the molecule and of its entry.
///
/// # Errors
/// Refuses a molecule that nothing ends.
fn close(input: &mut Input<'_>) -> Result<(), TableError> {
    let mut is_ended = false;
    loop {
        let number = input.number + 1;
        let Some(line) = input.next()? else {
            return match is_ended {
                true => Ok(()),
                false => Err(LocatedFault::at_end(number, EXPECTED).into()),
            };
        };
        const EXPECTED: &str = "`M  END` after the atoms and bonds of a molecule";
        if line.starts_with(END) {
            is_ended = true;
        } else if line.starts_with(END_OF_ENTRY) {
            return match is_ended {
                true => Ok(()),
                false => Err(LocatedFault::expected(number, line, 0..4, EXPECTED).into()),
            };
        }
    }
}
