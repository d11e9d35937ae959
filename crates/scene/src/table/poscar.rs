//! POSCAR, CONTCAR and XDATCAR, the structures and trajectories of VASP.
//!
//! # Source
//! The wiki of VASP, "POSCAR" and "XDATCAR".

use std::sync::Arc;

use glam::{DMat3, DVec3};

use super::cell::{Cell, numbers};
use super::element;
use super::error::TableError;
use super::fields::{self, Division};
use super::form::{FixedAtom, Form, Rest};
use super::header::{Header, Species};
use super::input::Input;
use super::number::parse;
use crate::text::LocatedFault;

/// The header of the next structure, behind another one's where that is given; `None` behind the last one.
pub(crate) fn header(
    input: &mut Input<'_>,
    previous: Option<&Header>,
) -> Result<Option<Header>, TableError> {
    let Some(previous) = previous else {
        return first(input).map(Some);
    };
    let is_blank = |line: &[u8]| line.trim_ascii().is_empty();
    let is_trajectory = is_configuration(&previous.place.1);
    let mut has_blank = false;
    while input.peek()?.is_some_and(is_blank) {
        input.next()?;
        has_blank = true;
    }
    let number = input.number + 1;
    match input.peek()?.map(<[u8]>::to_vec) {
        None => Ok(None),
        Some(line) if is_trajectory && is_configuration(&line) => {
            input.next()?;
            Ok(Some(Header {
                place: (number, line.clone(), 0..line.len()),
                ..previous.clone()
            }))
        }
        // The cell changes, and is told once more.
        Some(_) if is_trajectory => first(input).map(Some),
        Some(line) => {
            let words = fields::all(&line, &Division::Words);
            let is_atom = numbers::<3>(words.get(..3).unwrap_or_default()).is_some();
            // Velocities and what molecular dynamics needs follow a blank line, or a line that says so.
            if has_blank || !is_atom {
                return Ok(None);
            }
            let expected = "the end of the atoms, according to their numbers above";
            Err(LocatedFault::expected(number, &line, 0..line.len(), expected).into())
        }
    }
}

/// Says whether a line starts a configuration of a trajectory.
fn is_configuration(line: &[u8]) -> bool {
    let words = fields::all(line, &Division::Words);
    let starts = |word: Option<&&[u8]>, start: &[u8]| {
        word.and_then(|word| word.get(..start.len()))
            .is_some_and(|word| word.eq_ignore_ascii_case(start))
    };
    starts(words.first(), b"direct") && starts(words.get(1), b"configuration")
}

/// The header of a structure that tells everything.
fn first(input: &mut Input<'_>) -> Result<Header, TableError> {
    let title = line(input, "a title")?;
    let scale = scale(input)?;
    let mut edges = [DVec3::ZERO; 3];
    for edge in &mut edges {
        let expected = "three numbers, an edge of the cell";
        *edge = DVec3::from_array(read(input, expected, |words| numbers(words.get(..3)?))?);
    }
    let at = input.number;
    let edges = DMat3::from_cols(edges[0], edges[1], edges[2]);
    let (edges, scale) = scaled(edges, scale);
    let cell = Cell::new(edges, DVec3::ZERO);
    let cell = cell.map_err(|message| LocatedFault::in_line(at, b"", 0..0, message))?;
    let species = species(input, &title.text)?;
    let mut mode = line(input, MODE)?;
    let is_selective = matches!(mode.text.first(), Some(b's' | b'S'));
    if is_selective {
        mode = line(input, MODE)?;
    }
    let is_direct = match mode.text.first().map(u8::to_ascii_lowercase) {
        Some(b'd') => true,
        Some(b'c' | b'k') => false,
        _ => return Err(mode.refuse(MODE)),
    };
    let positions = match is_direct {
        true => ["xs", "ys", "zs"],
        false => ["x", "y", "z"],
    };
    const SELECTIVE: [&str; 3] = ["moves_along_a", "moves_along_b", "moves_along_c"];
    let mut names: Vec<&str> = ["element"].into_iter().chain(positions).collect();
    if is_selective {
        names.extend(SELECTIVE);
    }
    let form = Form {
        // Comments and symbols of elements may follow.
        rest: Rest::Anything,
        ..Form::new(Division::BehindNothing)
    };
    let texts = (0..names.len()).map(|column| !(1..4).contains(&column));
    let count = species.iter().map(|species| species.count).sum();
    Ok(Header {
        count: Some((count, "atoms, according to the numbers above")),
        scaled: is_direct.then_some((edges, DVec3::ZERO)),
        scale,
        cell: Some(Ok(cell)),
        species,
        texts: Some(texts.collect()),
        ..Header::new(
            names.into_iter().map(String::from).collect(),
            form,
            (mode.number, &mode.text),
        )
    })
}

const MODE: &str = "`Direct` or `Cartesian`";

/// The factors on the edges and on positions that are lengths: one for each axis, or the volume of the cell.
enum Scale {
    Factors(DVec3),
    Volume(f64),
}

fn scale(input: &mut Input<'_>) -> Result<Scale, TableError> {
    let expected = "a scaling factor, the volume of the cell as a negative number, or three factors greater than 0";
    read(input, expected, |words| {
        // A comment may follow.
        match (
            numbers::<3>(words.get(..3).unwrap_or_default()),
            numbers::<1>(words.get(..1)?)?,
        ) {
            (Some(factors), _) if factors.iter().all(|factor| *factor > 0.0) => {
                Some(Scale::Factors(DVec3::from_array(factors)))
            }
            (Some(_), _) => None,
            (None, [factor]) if factor > 0.0 => Some(Scale::Factors(DVec3::splat(factor))),
            (None, [volume]) if volume < 0.0 => Some(Scale::Volume(-volume)),
            (None, _) => None,
        }
    })
}

/// The edges times the factors, and the factors.
fn scaled(edges: DMat3, scale: Scale) -> (DMat3, DVec3) {
    let factors = match scale {
        Scale::Factors(factors) => factors,
        Scale::Volume(volume) => DVec3::splat(libm::cbrt(volume / edges.determinant().abs())),
    };
    (DMat3::from_diagonal(factors) * edges, factors)
}

/// The kinds of atoms and their numbers; before version 5 the title may tell the kinds.
fn species(input: &mut Input<'_>, title: &[u8]) -> Result<Vec<Species>, TableError> {
    let expected = "the symbols of the elements, or the numbers of their atoms";
    let named = line(input, expected)?;
    let words = fields::all(&named.text, &Division::Words);
    let (labels, counts) = match counts(&words) {
        Some(counts) => {
            let title = fields::all(title, &Division::Words);
            let is_symbol = |word: &&[u8]| element::of_symbol(symbol(word)).is_some();
            let labels: Vec<Arc<[u8]>> = match title.get(..counts.len()) {
                Some(title) if title.iter().all(is_symbol) => {
                    title.iter().map(|word| symbol(word).into()).collect()
                }
                _ => (1..=counts.len())
                    .map(|kind| kind.to_string().into_bytes().into())
                    .collect(),
            };
            (labels, counts)
        }
        None => {
            let is_name = |word: &&[u8]| word.first().is_some_and(u8::is_ascii_alphabetic);
            if words.is_empty() || !words.iter().all(is_name) {
                return Err(named.refuse(expected));
            }
            let expected = format!(
                "{} numbers of atoms, one for each element above",
                words.len()
            );
            let found = read(input, &expected, |numbers| {
                counts(numbers).filter(|counts| counts.len() == words.len())
            })?;
            let labels = words.iter().map(|word| symbol(word).into()).collect();
            (labels, found)
        }
    };
    let total = counts
        .iter()
        .try_fold(0u64, |sum, count| sum.checked_add(*count));
    if total.is_none() {
        let message = "expected fewer than 2^64 atoms, found more";
        return Err(LocatedFault::in_line(input.number, b"", 0..0, message.to_owned()).into());
    }
    let is_named = |label: &[u8]| label.first().is_some_and(u8::is_ascii_alphabetic);
    let atom = |label: Arc<[u8]>| FixedAtom {
        number: element::of_symbol(&label)
            .filter(|_| is_named(&label))
            .unwrap_or(0),
        label,
    };
    let species = counts.into_iter().zip(labels);
    Ok(species
        .map(|(count, label)| Species {
            count,
            atom: atom(label),
        })
        .collect())
}

/// The symbol in the name of a potential: `Fe` of `Fe_pv` and of `Fe/0a1b`.
fn symbol(word: &[u8]) -> &[u8] {
    let end = word.iter().position(|byte| b"_/:.".contains(byte));
    &word[..end.unwrap_or(word.len())]
}

/// The numbers of atoms at the start of a line; `None` if it does not start with one.
fn counts(words: &[&[u8]]) -> Option<Vec<u64>> {
    let count = |word: &&[u8]| {
        let is_count = word.iter().all(u8::is_ascii_digit);
        str::from_utf8(word).ok()?.parse().ok().filter(|_| is_count)
    };
    let counts: Vec<u64> = words.iter().map_while(count).collect();
    (!counts.is_empty()).then_some(counts)
}

/// A line with its number, without the spaces around it.
struct Line {
    number: u64,
    text: Vec<u8>,
}

impl Line {
    fn refuse(&self, expected: &str) -> TableError {
        let span = 0..self.text.len();
        LocatedFault::expected(self.number, &self.text, span, expected).into()
    }
}

fn line(input: &mut Input<'_>, expected: &str) -> Result<Line, TableError> {
    let number = input.number + 1;
    match input.next()? {
        Some(line) => Ok(Line {
            number,
            text: line.trim_ascii().to_vec(),
        }),
        None => Err(LocatedFault::at_end(number, expected).into()),
    }
}

/// Reads what the words of the next line say.
fn read<T>(
    input: &mut Input<'_>,
    expected: &str,
    of: impl Fn(&[&[u8]]) -> Option<T>,
) -> Result<T, TableError> {
    let line = line(input, expected)?;
    let words = fields::all(&line.text, &Division::Words);
    of(&words).ok_or_else(|| line.refuse(expected))
}

/// Says whether a text that begins so is a structure: a title, a factor, three edges, the elements or the
/// numbers of atoms.
pub(crate) fn is_like(head: &[u8]) -> bool {
    let lines: Vec<&[u8]> = head.split(|&byte| byte == b'\n').take(9).collect();
    let words = |number: usize| {
        let line = lines.get(number).copied().unwrap_or_default();
        fields::all(line.trim_ascii(), &Division::Words)
    };
    let are_numbers = |number: usize| {
        let words = words(number);
        let is_number = |word: &&[u8]| parse(word, false).is_some();
        words.iter().all(is_number).then_some(words.len())
    };
    let has_edges = (2..5).all(|number| are_numbers(number) == Some(3));
    // A comment may follow.
    let has_factor = words(1)
        .first()
        .is_some_and(|word| parse(word, false).is_some());
    has_edges && has_factor && has_species([words(5), words(6), words(7)])
}

/// Says whether lines have the names of elements and their numbers, or numbers alone and what positions are.
fn has_species([names, counts, modes]: [Vec<&[u8]>; 3]) -> bool {
    let is_count = |word: &&[u8]| word.iter().all(u8::is_ascii_digit);
    let is_name = |word: &&[u8]| word.first().is_some_and(u8::is_ascii_alphabetic);
    let is_mode = |words: &[&[u8]]| {
        let first = words.first().and_then(|word| word.first());
        first.is_some_and(|first| b"dcks".contains(&first.to_ascii_lowercase()))
    };
    let of_counts = !names.is_empty() && names.iter().all(is_count) && is_mode(&counts);
    let named = !names.is_empty()
        && names.len() == counts.len()
        && names.iter().all(is_name)
        && counts.iter().all(is_count)
        && (modes.is_empty() || is_mode(&modes));
    named || of_counts
}
