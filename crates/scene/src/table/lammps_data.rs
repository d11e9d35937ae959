//! Data files of LAMMPS: a title, counts and the box, and sections, of which `Atoms` has a line for each atom.
//!
//! # Source
//! The documentation of LAMMPS, `read_data`.

use super::atom_style::{IMAGES, Style, Words};
use super::element;
use super::error::TableError;
use super::fields::{self, Division};
use super::form::{AtomType, Form, LineKind, Rest, of_table};
use super::header::Header;
use super::input::{Input, without_return};
use super::lammps_box::SimulationBox;
use super::number::parse;
use crate::text::{LocatedFault, list};

/// Says whether the lines at the start of a text tell the numbers of atoms and of their types, or the bounds of a box.
pub(crate) fn is_like(head: &[u8]) -> bool {
    /// The lines that are looked at.
    const LINES: usize = 64;
    let lines = head.split(|&byte| byte == b'\n').take(LINES);
    let lines: Vec<Vec<&[u8]>> = lines.map(|line| words(without_return(line))).collect();
    let has = |names: &[&[u8]]| {
        lines.iter().any(|words| {
            let numbers = words.len().saturating_sub(names.len());
            let is_number = |word: &&[u8]| parse(word, false).is_some();
            words.ends_with(names) && numbers > 0 && words[..numbers].iter().all(is_number)
        })
    };
    has(&[b"atoms"]) && (has(&[b"atom", b"types"]) || has(&[b"xlo", b"xhi"]))
}

/// The words of a line before its comment.
fn words(line: &[u8]) -> Vec<&[u8]> {
    let said = line.split(|&byte| byte == b'#').next().unwrap_or_default();
    fields::all(said, &Division::Words)
}

/// The first word of a line's comment.
fn comment(line: &[u8]) -> Option<&[u8]> {
    let at = memchr::memchr(b'#', line)?;
    fields::all(&line[at + 1..], &Division::Words)
        .first()
        .copied()
}

/// What a file says of its atoms before they come.
#[derive(Default)]
struct Said {
    /// The number of atoms.
    count: Option<u64>,
    /// The number of types.
    types: Option<u64>,
    /// The names of types.
    names: Vec<TypeName>,
    /// The names are the labels of types.
    has_labels: bool,
    cell: SimulationBox,
}

/// The name of a type.
struct TypeName {
    /// What atoms have in the place of their type.
    label: Box<[u8]>,
    /// What a comment calls it, or else the label.
    name: Box<[u8]>,
}

/// The most types whose names may tell elements.
const MOST_TYPES: usize = 256;

/// The header of the atoms.
pub(crate) fn header(input: &mut Input<'_>) -> Result<Header, TableError> {
    let mut said = Said::default();
    // The title may be anything.
    input.next()?;
    loop {
        let number = input.number + 1;
        let Some(line) = input.next()?.map(<[u8]>::to_vec) else {
            return Err(LocatedFault::at_end(number, "the section `Atoms`").into());
        };
        let refused = |expected| LocatedFault::expected(number, &line, 0..line.len(), expected);
        match words(&line)[..] {
            [word, b"atoms"] => {
                said.count = Some(whole(word).ok_or_else(|| refused("the number of atoms"))?);
            }
            [word, b"atom", b"types"] => said.types = whole(word),
            [b"Masses"] => said.read_masses(input)?,
            [b"Atom", b"Type", b"Labels"] => said.read_labels(input)?,
            [b"Atoms"] => {
                let count = said
                    .count
                    .ok_or_else(|| refused("the number of atoms before"))?;
                return atoms(input, &said, count, (number, &line));
            }
            [b"Velocities"] => input.leave_out(unread_velocities(number, &line)),
            // The box, or other counts and other sections.
            ref words => said.cell.read(words, (number, &line)),
        }
    }
}

impl Said {
    /// Reads the section of masses, behind which comments may name the types.
    fn read_masses(&mut self, input: &mut Input<'_>) -> Result<(), TableError> {
        while let Some(line) = input.peek()? {
            match words(line)[..] {
                [] => {}
                [kind, mass] if parse(mass, false).is_some() => {
                    if !self.has_labels {
                        self.add(kind, comment(line).unwrap_or_default());
                    }
                }
                _ => break,
            }
            input.next()?;
        }
        Ok(())
    }

    /// Reads the section of labels, which atoms may have in place of the numbers of types.
    fn read_labels(&mut self, input: &mut Input<'_>) -> Result<(), TableError> {
        self.names.clear();
        self.has_labels = true;
        while let Some(line) = input.peek()? {
            match words(line)[..] {
                [] => {}
                [kind, label] if kind.iter().all(u8::is_ascii_digit) => {
                    self.add(kind, label);
                    self.add(label, label);
                }
                _ => break,
            }
            input.next()?;
        }
        Ok(())
    }

    fn add(&mut self, label: &[u8], name: &[u8]) {
        if self.names.len() <= MOST_TYPES {
            let (label, name) = (label.into(), name.into());
            self.names.push(TypeName { label, name });
        }
    }

    /// Says whether atoms may have this in the place of their type.
    fn may_be_type(&self, word: &[u8]) -> bool {
        let known = 1..=self.types.unwrap_or(u64::MAX);
        match self.names.is_empty() {
            true => whole(word).is_some_and(|number| known.contains(&number)),
            false => self.names.iter().any(|name| *name.label == *word),
        }
    }

    /// The elements of the types, if the names of all are symbols, which numbers and charges may follow.
    fn elements(&self) -> Vec<AtomType> {
        let element = |TypeName { label, name }: &TypeName| {
            let letters = name.iter().take_while(|byte| byte.is_ascii_alphabetic());
            let (symbol, rest) = name.split_at(letters.count());
            let is_end = |byte: &u8| byte.is_ascii_digit() || b"+-_".contains(byte);
            Some(AtomType {
                label: label.clone(),
                element: element::of_exact_symbol(symbol).filter(|_| rest.iter().all(is_end))?,
            })
        };
        let elements: Option<Vec<_>> = match self.names.len() <= MOST_TYPES {
            true => self.names.iter().map(element).collect(),
            false => None,
        };
        elements.unwrap_or_default()
    }
}

/// The header of so many atoms, behind this line, whose comment may tell their style.
fn atoms(
    input: &mut Input<'_>,
    said: &Said,
    count: u64,
    (number, line): (u64, &[u8]),
) -> Result<Header, TableError> {
    while count > 0
        && input
            .peek()?
            .is_some_and(|line| of_table(line) == LineKind::Other)
    {
        input.next()?;
    }
    let (first, row) = (input.number + 1, input.peek()?.unwrap_or_default().to_vec());
    let rows = sample(input, count);
    let style = match comment(line) {
        Some(name) if Style::is_name(name) => stated(name, number, line)?,
        _ if rows.is_empty() => Style::USUAL,
        _ => {
            let style = Style::guessed(&rows, &|word| said.may_be_type(word));
            let style = style.ok_or_else(|| {
                let expected = "the style of the atoms, such as `Atoms # full`, before this row";
                LocatedFault::expected(first, &row, 0..row.len(), expected)
            })?;
            let told = format!(
                "the style of the atoms is not stated: they are read as `{}`, with the columns {}; confirm this with \
                 `Atoms # {}`",
                style.name,
                style.columns.join(", "),
                style.name
            );
            input.leave_out(LocatedFault::in_line(number, line, 0..line.len(), told));
            style
        }
    };
    let mut names: Vec<&str> = style.columns.to_vec();
    let elements = said.elements();
    let kind = names.iter().position(|name| *name == "type");
    let division = match kind.filter(|_| !elements.is_empty()) {
        Some(kind) => {
            names.insert(kind + 1, "element");
            Division::Repeated(kind)
        }
        None => Division::Words,
    };
    if rows.first().is_some_and(|row| style.has_images(row)) {
        names.extend(IMAGES);
    }
    let form = Form {
        // A section ends with a blank line.
        kind: |line| match line.trim_ascii_start().first() {
            Some(first) if !first.is_ascii_alphabetic() => LineKind::Row,
            _ => LineKind::End,
        },
        rest: Rest::Comment,
        element: |form, line, field| {
            let mut types = form.types.iter();
            let kind = types.find(|kind| *kind.label == line[field.clone()]);
            kind.map(|kind| kind.element)
        },
        types: elements.into(),
        ..Form::new(division)
    };
    let names = names.into_iter().map(str::to_owned).collect();
    Ok(Header {
        count: Some((count, "atoms, according to the start of the file")),
        cell: said.cell.cell(),
        close: |input, ends_with_row| close(input, ends_with_row).map(|()| None),
        ..Header::new(names, form, (number, line))
    })
}

/// The style of this name, which stands behind `Atoms` in this line.
fn stated(name: &[u8], number: u64, line: &[u8]) -> Result<Style, LocatedFault> {
    Style::of(name).ok_or_else(|| {
        let names = Style::names().map(|name| format!("`{name}`"));
        let expected = format!("atoms of the style {}", list(&names));
        let at = memchr::memmem::find(line, name).unwrap_or(0);
        LocatedFault::expected(number, line, at..at + name.len(), &expected)
    })
}

fn whole(word: &[u8]) -> Option<u64> {
    str::from_utf8(word).ok()?.parse().ok()
}

/// The words of some of the next rows.
fn sample(input: &Input<'_>, count: u64) -> Vec<Words> {
    const ROWS: usize = 1000;
    let lines = input.head().split(|&byte| byte == b'\n');
    let rows = lines.map(|line| words(without_return(line)));
    let rows = rows.take_while(|words| !words.is_empty());
    let most = usize::try_from(count).unwrap_or(ROWS).min(ROWS);
    let owned = |words: Vec<&[u8]>| words.into_iter().map(<[u8]>::to_vec).collect();
    let mut rows: Vec<Words> = rows.take(most).map(owned).collect();
    if rows.len() > 1 && !input.head().ends_with(b"\n") {
        // The last one may go on.
        rows.pop();
    }
    rows
}

/// Refuses more atoms than the file is said to have, behind which only the name of a section may stand, and doubts the last
/// one if nothing ends its line.
fn close(input: &mut Input<'_>, ends_with_row: bool) -> Result<(), TableError> {
    if ends_with_row && input.is_open_at_end() {
        let doubt = "the file ends within this line: its last number may have been cut off";
        input.doubt_line(doubt);
    }
    while input
        .peek()?
        .is_some_and(|line| of_table(line) == LineKind::Other)
    {
        input.next()?;
    }
    let number = input.number + 1;
    match input.peek()? {
        Some(line)
            if !line
                .trim_ascii_start()
                .first()
                .is_some_and(u8::is_ascii_alphabetic) =>
        {
            let expected = "the name of a section after the atoms that the file counts";
            Err(LocatedFault::expected(number, line, 0..line.len(), expected).into())
        }
        _ => tell_velocities(input),
    }
}

/// Says that velocities are left out, if a section behind the atoms has some.
fn tell_velocities(input: &mut Input<'_>) -> Result<(), TableError> {
    const NAME: &[u8] = b"Velocities";
    /// About how many bytes are looked at as one.
    const BLOCK: usize = 1 << 20;
    while let Some(block) = input.next_block(u64::MAX, BLOCK)? {
        let is_start = |at: &usize| *at == 0 || block[at - 1] == b'\n';
        let found = memchr::memmem::find_iter(block, NAME).find(is_start);
        let lines = |bytes: &[u8]| memchr::memchr_iter(b'\n', bytes).count() as u64;
        let (before, all) = (found.map(|at| lines(&block[..at])), lines(block));
        let number = input.number;
        input.number += all;
        if let Some(before) = before {
            input.leave_out(unread_velocities(number + before + 1, NAME));
            break;
        }
    }
    Ok(())
}

/// The warning about velocities, whose section begins in this line.
fn unread_velocities(number: u64, line: &[u8]) -> LocatedFault {
    let told =
        "the velocities of this section are not read: a dump with `vx vy vz` has them as columns";
    LocatedFault::in_line(number, line, 0..line.len(), told.to_owned())
}
