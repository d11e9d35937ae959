//! Text dumps of LAMMPS: `ITEM:` sections for each step, the last of which has a line for each atom.
//!
//! Positions are `x y z`, unwrapped `xu yu zu`, or `xs ys zs`, which are parts of the box.
//!
//! # Source
//! The documentation of LAMMPS, `dump` and `Howto_triclinic`.

use glam::{DMat3, DVec3};

use super::cell::Cell;
use super::error::TableError;
use super::fields::{self, Division};
use super::form::Form;
use super::header::Header;
use super::input::Input;
use super::number::parse;
use crate::text::LocatedFault;

/// The header of the next step; `None` behind the last one.
pub(crate) fn header(input: &mut Input<'_>) -> Result<Option<Header>, TableError> {
    let (mut count, mut scaled, mut cell) = (None, None, None);
    // Before it, only the file may end.
    let mut is_begun = input.number == 0;
    loop {
        let number = input.number + 1;
        let Some(line) = input.next()?.map(<[u8]>::to_vec) else {
            return match is_begun {
                false => Ok(None),
                true => Err(LocatedFault::at_end(number, "`ITEM: ATOMS …`").into()),
            };
        };
        let words = fields::all(&line, &Division::Words);
        match words[..] {
            [] => continue,
            [b"ITEM:", b"NUMBER", b"OF", b"ATOMS"] => count = Some(self::count(input)?),
            [b"ITEM:", b"BOX", b"BOUNDS", ref kinds @ ..] => {
                let (edges, origin) = bounds(input, kinds)?;
                scaled = Some((edges, origin));
                let told = Cell::new(edges, origin);
                let told = told.map(|cell| cell.periodic_along(is_periodic(kinds)));
                let fault = |message| LocatedFault::in_line(number, &line, 0..line.len(), message);
                cell = Some(told.map_err(fault));
            }
            [b"ITEM:", b"ATOMS", ref names @ ..] => {
                let Some(count) = count else {
                    let expected = "`ITEM: NUMBER OF ATOMS` before";
                    return Err(
                        LocatedFault::expected(number, &line, 0..line.len(), expected).into(),
                    );
                };
                let name = |name: &&[u8]| String::from_utf8_lossy(name).into_owned();
                let names = names.iter().map(name).collect();
                let form = Form::new(Division::Words);
                let header = Header::new(names, form, (number, &line));
                return Ok(Some(Header {
                    count: Some((count, "atoms, according to `ITEM: NUMBER OF ATOMS`")),
                    scaled,
                    cell,
                    ..header
                }));
            }
            // The number of the step, and what only some programs write, as LIGGGHTS its label.
            [b"ITEM:", ..] => {
                while input.peek()?.is_some_and(|line| !line.starts_with(ITEM)) {
                    input.next()?;
                }
            }
            _ => {
                let expected = "a line `ITEM: …`";
                return Err(LocatedFault::expected(number, &line, 0..line.len(), expected).into());
            }
        }
        is_begun = true;
    }
}

/// The edges along which the box is periodic, by the last words about it: `pp`, or others such as `ff`; all of them if no
/// words say so.
fn is_periodic(kinds: &[&[u8]]) -> [bool; 3] {
    let is_boundary = |kind: &&[u8]| kind.len() == 2 && kind.iter().all(|at| b"pfsm".contains(at));
    match kinds.last_chunk() {
        Some(kinds) if kinds.iter().all(is_boundary) => kinds.map(|kind| kind.starts_with(b"p")),
        _ => [true; 3],
    }
}

/// The start of a section.
const ITEM: &[u8] = b"ITEM:";

fn count(input: &mut Input<'_>) -> Result<u64, TableError> {
    let expected = "the number of atoms";
    let number = input.number + 1;
    let Some(line) = input.next()? else {
        return Err(LocatedFault::at_end(number, expected).into());
    };
    let count = str::from_utf8(line.trim_ascii())
        .ok()
        .and_then(|text| text.parse().ok());
    count.ok_or_else(|| LocatedFault::expected(number, line, 0..line.len(), expected).into())
}

/// The edges of the box, and its corner.
fn bounds(input: &mut Input<'_>, kinds: &[&[u8]]) -> Result<(DMat3, DVec3), TableError> {
    let is_general = kinds.starts_with(&[b"abc", b"origin"]);
    let is_triclinic = kinds.starts_with(&[b"xy", b"xz", b"yz"]);
    let size = match (is_general, is_triclinic) {
        (true, _) => 4,
        (_, true) => 3,
        _ => 2,
    };
    let mut rows = [[0.0; 4]; 3];
    for row in &mut rows {
        let number = input.number + 1;
        let expected = format!("{size} numbers of the box");
        let Some(line) = input.next()? else {
            return Err(LocatedFault::at_end(number, &expected).into());
        };
        let words = fields::all(line, &Division::Words);
        let found: Option<Vec<f64>> = words.iter().map(|word| parse(word, false)).collect();
        match found.as_deref() {
            Some(numbers) if numbers.len() >= size => row[..size].copy_from_slice(&numbers[..size]),
            _ => return Err(LocatedFault::expected(number, line, 0..line.len(), &expected).into()),
        }
    }
    if is_general {
        let edge = |row: [f64; 4]| DVec3::new(row[0], row[1], row[2]);
        let [a, b, c] = rows.map(edge);
        let origin = DVec3::from_array(rows.map(|row| row[3]));
        return Ok((DMat3::from_cols(a, b, c), origin));
    }
    let [mut x, mut y, z] = rows;
    let (xy, xz, yz) = (rows[0][2], rows[1][2], rows[2][2]);
    // The bounds of a tilted box are those of the box around it.
    x[0] -= xy.min(xz).min(xy + xz).min(0.0);
    x[1] -= xy.max(xz).max(xy + xz).max(0.0);
    y[0] -= yz.min(0.0);
    y[1] -= yz.max(0.0);
    let edges = DMat3::from_cols(
        DVec3::new(x[1] - x[0], 0.0, 0.0),
        DVec3::new(xy, y[1] - y[0], 0.0),
        DVec3::new(xz, yz, z[1] - z[0]),
    );
    Ok((edges, DVec3::new(x[0], y[0], z[0])))
}
