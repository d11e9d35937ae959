//! GRO, the structures of GROMACS, in nanometers: a title, the number of atoms, a line for each, the box.
//!
//! # Source
//! The reference manual of GROMACS, "gro".

use std::ops::Range;

use glam::{DMat3, DVec3};

use super::cell::{Cell, ToldCell, numbers};
use super::error::TableError;
use super::fields::{self, Division};
use super::form::{Form, coordinates_run_together};
use super::header::Header;
use super::input::Input;
use super::number::parse;
use super::residue;
use crate::text::LocatedFault;

/// The columns before the numbers: number and name of the residue, name and number of the atom.
const PLACES: [Range<usize>; 4] = [0..5, 5..10, 10..15, 15..20];
/// The element follows from the atom's name.
const NAMES: [&str; 11] = [
    "residue_number",
    "residue",
    "name",
    "id",
    "x",
    "y",
    "z",
    "vx",
    "vy",
    "vz",
    "element",
];

/// The header of the next frame; `None` behind the last one.
pub(crate) fn header(input: &mut Input<'_>) -> Result<Option<Header>, TableError> {
    let is_first = input.number == 0;
    let Some(title) = input.next()?.map(<[u8]>::to_vec) else {
        return match is_first {
            true => Err(LocatedFault::at_end(1, "a title").into()),
            false => Ok(None),
        };
    };
    let number = input.number + 1;
    let line = input.next()?.map(<[u8]>::to_vec);
    if !is_first
        && title.trim_ascii().is_empty()
        && line
            .as_ref()
            .is_none_or(|line| line.trim_ascii().is_empty())
    {
        return Ok(None);
    }
    let expected = "the number of atoms";
    let line = line.ok_or_else(|| LocatedFault::at_end(number, expected))?;
    let count = str::from_utf8(line.trim_ascii())
        .ok()
        .and_then(|text| text.parse().ok());
    let count: u64 =
        count.ok_or_else(|| LocatedFault::expected(number, &line, 0..line.len(), expected))?;
    let row = input.peek()?.unwrap_or_default();
    let width = width(row);
    let mut places = PLACES.to_vec();
    places.extend((0..6).map(|column| 20 + column * width..20 + (column + 1) * width));
    places.push(10..15);
    let form = Form {
        element: |_, line, field| {
            let residue = line.get(5..10).unwrap_or_default();
            residue::of_atom(&line[field], residue)
        },
        coordinates: 20..20 + 3 * width,
        check: coordinates_run_together,
        ..Form::new(Division::Fixed(places.into()))
    };
    let names = NAMES.map(String::from).into();
    let texts = NAMES
        .iter()
        .map(|name| ["residue", "name", "element"].contains(name))
        .collect();
    Ok(Some(Header {
        count: Some((count, "atoms, according to the line above")),
        close,
        angstrom: 0.1,
        texts: Some(texts),
        ..Header::new(names, form, (number, &line))
    }))
}

/// Reads the box, which ends a frame.
fn close(input: &mut Input<'_>, _: bool) -> Result<Option<ToldCell>, TableError> {
    let expected = "the three or nine numbers of the box after the atoms";
    let number = input.number + 1;
    let Some(line) = input.next()? else {
        return Err(LocatedFault::at_end(number, expected).into());
    };
    let words = fields::all(line, &Division::Words);
    let is_box = words.len() >= 3 && words.iter().all(|word| parse(word, false).is_some());
    // Wide numbers have no spaces between them.
    let is_of_digits = line.iter().all(|byte| b"0123456789.- ".contains(byte));
    let is_box = is_box || is_of_digits && memchr::memchr_iter(b'.', line).count() >= 3;
    match is_box {
        true => Ok(cell(number, line)),
        false => Err(LocatedFault::expected(number, line, 0..line.len(), expected).into()),
    }
}

/// The cell of a box: the lengths of its edges, or all components in the order of the format; `None` if all are 0, as
/// they are without a box.
fn cell(number: u64, line: &[u8]) -> Option<ToldCell> {
    let words = fields::all(line, &Division::Words);
    let edges = match (numbers::<9>(&words), numbers::<3>(&words)) {
        (Some([ax, by, cz, ay, az, bx, bz, cx, cy]), _) => DMat3::from_cols(
            DVec3::new(ax, ay, az),
            DVec3::new(bx, by, bz),
            DVec3::new(cx, cy, cz),
        ),
        (None, Some(lengths)) => DMat3::from_diagonal(DVec3::from_array(lengths)),
        (None, None) => {
            let expected = "three or nine numbers of the box, with spaces between them";
            return Some(Err(LocatedFault::expected(
                number,
                line,
                0..line.len(),
                expected,
            )));
        }
    };
    if edges == DMat3::ZERO {
        return None;
    }
    let cell = Cell::new(edges, DVec3::ZERO);
    Some(cell.map_err(|message| LocatedFault::in_line(number, line, 0..line.len(), message)))
}

/// The width of numbers, which is that between their points.
fn width(row: &[u8]) -> usize {
    const USUAL: usize = 8;
    const WIDEST: usize = 32;
    let mut points = memchr::memchr_iter(b'.', row.get(20..).unwrap_or_default());
    let width = match (points.next(), points.next()) {
        (Some(first), Some(second)) => second - first,
        _ => USUAL,
    };
    width.min(WIDEST)
}
