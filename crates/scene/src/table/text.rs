//! Rows of text: numbers between spaces, or between commas and the like.

use std::ops::Range;

use rayon::prelude::*;

use super::columns::{Plan, RadiusSource, Slot, Uses};
use super::element;
use super::error::TableError;
use super::fields::Fields;
use super::form::{Form, LineKind};
use super::input::{Input, without_return};
use super::number::{is_missing, parse};
use super::request::Coloring;
use super::rows::{Numbers, Row, Rows};
use crate::text::{LocatedFault, show};

/// About how many bytes of text are one piece of work.
const PIECE: usize = 1 << 18;
/// About how many bytes tell how long lines are.
const TELLING: usize = 1 << 20;
/// About how many bytes are read first where the rows may end at any line, as those of small models do.
const FIRST_PIECE: usize = 1 << 12;

/// Reads rows: `count` of them, or all up to the end that the form tells.
///
/// The pieces of a block are read on all threads of the current pool; what comes of it does not
/// depend on their number. Afterwards comes what stands behind the rows.
pub(crate) fn read(
    input: &mut Input<'_>,
    plan: &Plan,
    form: &Form,
    count: Option<u64>,
) -> Result<Rows, TableError> {
    let mut rows = Rows::new(plan);
    let wanted = |rows: &Rows| count.map_or(u64::MAX, |count| count - rows.read);
    let (size, mut number) = (input.size().unwrap_or(0), input.number);
    let (mut is_at_end, mut is_reserved) = (false, false);
    // What stands behind the rows is handed out in vain: no more than the rows themselves, and a little.
    let mut window = match count {
        Some(_) => usize::MAX,
        None => FIRST_PIECE,
    };
    while wanted(&rows) > 0 && !is_at_end {
        let start = input.position;
        let Some(block) = input.next_block(wanted(&rows), window)? else {
            break;
        };
        window = window.saturating_mul(4);
        let bytes = block.len();
        let pieces: Vec<&[u8]> = pieces(block).collect();
        let pieces: Vec<Piece> = pieces
            .into_par_iter()
            .map(|text| read_piece(text, plan, form, count.is_some()))
            .collect();
        let is_telling = count.is_some() || bytes >= TELLING;
        if !is_reserved
            && is_telling
            && plan.filters.is_empty()
            && pieces.iter().all(|piece| !piece.is_at_end)
        {
            is_reserved = true;
            // As if all lines were as long as those of this block.
            let found: usize = pieces.iter().map(|piece| piece.rows.spheres.len()).sum();
            let share = size.saturating_sub(start) as f64 / bytes as f64;
            let more = (1.01 * share * found as f64) as u64;
            rows.reserve(more.min(wanted(&rows)))?;
        }
        let mut taken = 0;
        for piece in pieces {
            rows.append(piece.rows)?;
            if let Some(fault) = piece.fault {
                return Err(fault.lower(number).into());
            }
            number += piece.lines;
            taken += piece.bytes;
            if piece.lines > 0 {
                rows.ends_with_row = piece.ends_with_row;
            }
            is_at_end = piece.is_at_end;
            if is_at_end {
                break;
            }
        }
        input.take_back(bytes - taken);
        input.check_count(rows.read, "rows")?;
    }
    input.number = number;
    Ok(rows)
}

/// Reads `count` rows, which are called by `noun` where there are fewer.
pub(crate) fn read_count(
    input: &mut Input<'_>,
    plan: &Plan,
    form: &Form,
    count: u64,
    noun: &str,
) -> Result<Rows, TableError> {
    let rows = read(input, plan, form, Some(count))?;
    match rows.read < count {
        true => Err(too_few(input.number, rows.read, count, noun).into()),
        false => Ok(rows),
    }
}

/// Passes over rows as [`read`] does; says whether the last line is one.
pub(crate) fn skip(input: &mut Input<'_>, form: &Form) -> Result<bool, TableError> {
    let mut ends_with_row = false;
    let is_of_this = |line: &[u8]| (form.kind)(line) != LineKind::End && !is_of_another(line, form);
    while input.peek()?.is_some_and(is_of_this) {
        let line = input.next()?.unwrap_or_default();
        ends_with_row = (form.kind)(line) == LineKind::Row;
    }
    Ok(ends_with_row)
}

/// The file has ended before so many rows.
pub(crate) fn too_few(lines: u64, found: u64, count: u64, noun: &str) -> LocatedFault {
    let expected = format!("{count} {noun}, and after {found} of them another");
    LocatedFault::at_end(lines + 1, &expected)
}

/// Parts of a block, each of whole lines.
fn pieces(block: &[u8]) -> impl Iterator<Item = &[u8]> {
    let mut rest = block;
    std::iter::from_fn(move || {
        if rest.is_empty() {
            return None;
        }
        let ahead = rest
            .get(PIECE..)
            .and_then(|ahead| memchr::memchr(b'\n', ahead));
        let length = ahead.map_or(rest.len(), |ahead| PIECE + ahead + 1);
        let (piece, after) = rest.split_at(length);
        rest = after;
        Some(piece)
    })
}

/// The rows of a piece.
struct Piece {
    rows: Rows,
    /// Lines that were looked at, the one with the fault included.
    lines: u64,
    /// The bytes of these lines.
    bytes: usize,
    /// The next line is not of this table any more.
    is_at_end: bool,
    /// The last line that was looked at is a row.
    ends_with_row: bool,
    /// The first fault, by the line in the piece.
    fault: Option<LocatedFault>,
}

fn read_piece(text: &[u8], plan: &Plan, form: &Form, all_are_rows: bool) -> Piece {
    let mut piece = Piece {
        rows: Rows::new(plan),
        lines: 0,
        bytes: 0,
        is_at_end: false,
        ends_with_row: false,
        fault: None,
    };
    let mut numbers: Numbers = [0.0; Slot::COUNT];
    while piece.bytes < text.len() {
        let rest = &text[piece.bytes..];
        let length = memchr::memchr(b'\n', rest).unwrap_or(rest.len());
        let line = without_return(&rest[..length]);
        let kind = if all_are_rows {
            LineKind::Row
        } else {
            (form.kind)(line)
        };
        piece.is_at_end = kind == LineKind::End || is_of_another(line, form);
        if piece.is_at_end {
            break;
        }
        piece.ends_with_row = kind == LineKind::Row;
        piece.lines += 1;
        piece.bytes += (length + 1).min(rest.len());
        if kind == LineKind::Row {
            let read = read_line(line, piece.lines, plan, form, &mut numbers, &mut piece.rows);
            piece.fault = read.err();
            if piece.fault.is_some() {
                break;
            }
        }
    }
    piece
}

/// Says whether a line has something else in the column in which all rows are the same.
fn is_of_another(line: &[u8], form: &Form) -> bool {
    let Some((column, same)) = &form.same else {
        return false;
    };
    let mut fields = Fields::new(line, &form.division);
    for _ in 0..*column {
        fields.next();
    }
    fields.next().is_some_and(|field| line[field] != same[..])
}

/// Reads the row in the line with this number.
#[inline(always)]
fn read_line(
    line: &[u8],
    number: u64,
    plan: &Plan,
    form: &Form,
    numbers: &mut Numbers,
    rows: &mut Rows,
) -> Result<(), LocatedFault> {
    let refused = |span: Range<usize>, expected: &str| {
        Err(LocatedFault::expected(number, line, span, expected))
    };
    let (mut atom, mut symbol, mut category) = (0, 0..0, 0..0);
    let mut fields = Fields::new(line, &form.division);
    for (column, uses) in plan.uses.iter().enumerate() {
        let Some(field) = fields.next() else {
            let end = line.trim_ascii_end().len();
            return refused(end..end, &plan.expected(column, kind(uses)));
        };
        for slot in uses.slots() {
            let text = &line[field.clone()];
            match slot {
                Slot::Element => {
                    atom = (form.element)(line, field.clone())
                        .ok_or_else(|| no_element(line, number, field.clone(), plan))?;
                    symbol = field.clone();
                }
                Slot::Value if plan.coloring == Coloring::Category => category = field.clone(),
                Slot::Filter(filter) => {
                    let number = match plan.filters[usize::from(*filter)].text() {
                        Some(wanted) => Some(f64::from(u8::from(text == wanted.as_bytes()))),
                        None => parse(text, form.has_decimal_commas)
                            .or_else(|| is_missing(text).then_some(f64::NAN)),
                    };
                    let Some(number) = number else {
                        return refused(field, &plan.expected(column, "a number"));
                    };
                    numbers[slot.index()] = number;
                }
                slot => {
                    let mut value = parse(text, form.has_decimal_commas);
                    let is_value = matches!(slot, Slot::Value | Slot::Vector(_));
                    if value.is_none() && is_value && plan.allowed.may_miss && is_missing(text) {
                        value = Some(f64::NAN);
                    }
                    let refusal = match value {
                        Some(value) => slot.refusal(value, plan.allowed),
                        None => Some("a number"),
                    };
                    if let Some(expected) = refusal {
                        return refused(field, &plan.expected(column, expected));
                    }
                    numbers[slot.index()] = value.unwrap_or_default();
                }
            }
        }
    }
    if !form.may_be_longer
        && let Some(field) = fields.next()
    {
        let count = plan.uses.len();
        return refused(field, &format!("the end of the line after {count} columns"));
    }
    let row = Row {
        numbers,
        element: atom,
        category: &line[category],
    };
    let pushed = rows.push(plan, row);
    pushed.or_else(|expected| refused(symbol, expected))
}

/// The contents of a column, for messages.
fn kind(uses: &Uses) -> &'static str {
    match uses.slots() {
        [] => "a value",
        [Slot::Element, ..] => "an element",
        _ => "a number",
    }
}

/// The fault where a field is no element.
#[cold]
fn no_element(line: &[u8], number: u64, field: Range<usize>, plan: &Plan) -> LocatedFault {
    let text = String::from_utf8_lossy(&line[field.clone()]).into_owned();
    let mut fault = LocatedFault::expected(number, line, field, "the symbol of an element");
    fault.message += &match element::suggestion(&text) {
        Some(symbol) => format!(", did you mean {}?", show(symbol)),
        None => {
            let mut instead = Vec::new();
            if matches!(plan.radius, RadiusSource::Element(..)) {
                instead.push("`radius: …`");
            }
            if plan.coloring == Coloring::Element {
                instead.push("`color: Material`");
            }
            format!(" (with {} none is needed)", instead.join(" and "))
        }
    };
    fault
}
