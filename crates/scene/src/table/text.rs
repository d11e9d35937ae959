//! Rows of text: numbers between spaces, or between commas and the like.

use std::ops::Range;

use marbles_core::parallel;

use super::columns::{Plan, Slot, Test, Uses};
use super::contents::Contents;
use super::elements::Atom;
use super::error::TableError;
use super::fields::Fields;
use super::form::{Form, LineKind, Rest};
use super::input::{Input, without_return};
use super::number::{is_missing, parse};
use super::paint::Paint;
use super::remarks::place_in_line;
use super::request::Coloring;
use super::rows::{Numbers, Pushed, Row, Rows, is_point};
use super::time;
use crate::text::{LocatedFault, Place};

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
        let pieces: Vec<Piece> = parallel::map(pieces.len(), |index| {
            read_piece(pieces[index], plan, form, count.is_some())
        });
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
        for mut piece in pieces {
            piece.rows.remarks = piece.rows.remarks.lower(number);
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
    let rows = read(input, plan, form, Some(count));
    let rows = rows.map_err(|error| ended_early(error, form, count, noun))?;
    match rows.read < count {
        true => Err(too_few(input.number, rows.read, count, noun).into()),
        false => Ok(rows),
    }
}

/// The error of a line among `count` rows, which says what ends them if the line does.
#[cold]
fn ended_early(error: TableError, form: &Form, count: u64, noun: &str) -> TableError {
    match error {
        TableError::Fault(LocatedFault {
            place: Place::Text { line, text, .. },
            ..
        }) if (form.kind)(text.as_bytes()) == LineKind::End => {
            let expected = format!("{count} {noun}");
            let text = text.as_bytes();
            LocatedFault::expected(line, text, 0..text.len(), &expected).into()
        }
        error => error,
    }
}

/// Passes over rows as [`read`] does; says whether the last line is one.
pub(crate) fn skip(input: &mut Input<'_>, form: &Form) -> Result<bool, TableError> {
    let mut ends_with_row = false;
    let is_of_this = |line: &[u8]| match (form.kind)(line) {
        LineKind::Row => !is_of_another(line, form),
        LineKind::Other => true,
        LineKind::End => false,
    };
    while input.peek()?.is_some_and(is_of_this) {
        let line = input.next()?.unwrap_or_default();
        ends_with_row = (form.kind)(line) == LineKind::Row;
    }
    Ok(ends_with_row)
}

/// The file has ended before so many rows.
pub(crate) fn too_few(lines: u64, found: u64, count: u64, noun: &str) -> LocatedFault {
    let expected = format!("{count} {noun} ({found} read)");
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
    let mut numbers: Numbers = plan.constants;
    while piece.bytes < text.len() {
        let rest = &text[piece.bytes..];
        let length = memchr::memchr(b'\n', rest).unwrap_or(rest.len());
        let line = without_return(&rest[..length]);
        let kind = if all_are_rows {
            LineKind::Row
        } else {
            (form.kind)(line)
        };
        piece.is_at_end = match kind {
            LineKind::Row => form.same.is_some() && is_of_another(line, form),
            LineKind::Other => false,
            LineKind::End => true,
        };
        if piece.is_at_end {
            break;
        }
        piece.ends_with_row = kind == LineKind::Row;
        piece.lines += 1;
        piece.bytes += (length + 1).min(rest.len());
        if kind == LineKind::Row {
            let read = match is_kept(line, piece.lines, plan, form) {
                Ok(true) => read_line(line, piece.lines, plan, form, &mut numbers, &mut piece.rows),
                Ok(false) => {
                    piece.rows.read += 1;
                    Ok(())
                }
                Err(fault) => Err(fault),
            };
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

/// Says whether the row in the line with this number meets all conditions, by the columns that these are on alone.
#[inline(always)]
pub(crate) fn is_kept(
    line: &[u8],
    number: u64,
    plan: &Plan,
    form: &Form,
) -> Result<bool, LocatedFault> {
    let mut fields = Fields::new(line, &form.division);
    for (column, uses) in plan.uses[..plan.filter_columns].iter().enumerate() {
        let Some(field) = fields.next() else {
            return Err(ends_early(line, number, plan, column));
        };
        for slot in uses.slots() {
            let Slot::Filter(filter) = slot else {
                continue;
            };
            let text = &line[field.clone()];
            let is_met = match &plan.filters[usize::from(*filter)] {
                Test::IsText(wanted) if plan.element_column == Some(column) => plan
                    .elements
                    .is_called(form.atom(line, field.clone()), wanted),
                Test::IsText(wanted) => text == wanted.as_bytes(),
                test => match parse(text, form.has_decimal_commas).or_else(|| time::parse(text)) {
                    Some(number) => test.holds(number),
                    None if is_missing(text) => false,
                    None => {
                        let expected = plan.expected(column, "a number");
                        return Err(LocatedFault::expected(number, line, field, &expected));
                    }
                },
            };
            if !is_met {
                return Ok(false);
            }
        }
    }
    Ok(true)
}

/// The line ends before this column.
#[cold]
fn ends_early(line: &[u8], number: u64, plan: &Plan, column: usize) -> LocatedFault {
    let end = line.trim_ascii_end().len();
    let expected = plan.expected(column, kind(&plan.uses[column]));
    LocatedFault::expected(number, line, end..end, &expected)
}

/// Adds the columns of a field to what is expected in it, if the field has spaces inside: another program may have
/// divided the line by spaces.
#[cold]
fn placed(expected: String, line: &[u8], field: Range<usize>, form: &Form) -> String {
    let has_spaces = line[field.clone()].contains(&b' ');
    match form.division.place(&field) {
        Some(place) if has_spaces => format!(
            "{expected} in columns {} to {} (the fields of this format have fixed columns)",
            place.start + 1,
            place.end
        ),
        _ => expected,
    }
}

/// Reads the row in the line with this number, which is kept.
#[inline(always)]
pub(super) fn read_line(
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
    let (mut atom, mut symbol, mut category) = (Atom::NONE, 0..0, &[][..]);
    let mut fields = Fields::new(line, &form.division);
    for (column, uses) in plan.uses.iter().enumerate() {
        let Some(field) = fields.next() else {
            return Err(ends_early(line, number, plan, column));
        };
        for slot in uses.slots() {
            let text = &line[field.clone()];
            match slot {
                Slot::Element => {
                    atom = form.atom(line, field.clone());
                    symbol = field.clone();
                    if plan.has_element_categories {
                        category = plan.elements.name(atom);
                    }
                }
                Slot::Value if plan.coloring == Coloring::Category => category = text,
                Slot::Filter(_) => {}
                Slot::Contents(index) => {
                    if let Paint::Contents(all) = &mut rows.paint {
                        let contents = &mut all[usize::from(*index)];
                        look_at(contents, line, field.clone(), column, plan, form);
                    }
                }
                slot => {
                    let mut value = parse(text, form.has_decimal_commas);
                    let is_value = matches!(slot, Slot::Value | Slot::Vector(_));
                    let may_be_time = is_value || matches!(slot, Slot::X | Slot::Y | Slot::Z);
                    if value.is_none() && may_be_time {
                        value = time::parse(text);
                        rows.has_times |= value.is_some() && *slot == Slot::Value;
                    }
                    if value.is_none() && is_value && plan.allowed.may_miss && is_missing(text) {
                        value = Some(f64::NAN);
                    }
                    let refusal = match value {
                        Some(0.0) if *slot == Slot::Radius && form.has_points => None,
                        Some(value) => plan.refusal(*slot, value),
                        None => Some("a number"),
                    };
                    if let Some(expected) = refusal {
                        let expected = plan.expected(column, expected);
                        return refused(field.clone(), &placed(expected, line, field, form));
                    }
                    numbers[slot.index()] = value.unwrap_or_default();
                }
            }
        }
    }
    if form.rest != Rest::Anything
        && let Some(field) = fields.next()
        && !(form.rest == Rest::Comment && line[field.start] == b'#')
    {
        let count = plan.uses.len();
        return refused(field, &format!("the end of the line after {count} columns"));
    }
    if let Some((part, expected)) = (form.check)(form, line) {
        return refused(part, expected);
    }
    if form.has_points && is_point(plan, numbers) {
        rows.read += 1;
        rows.remarks
            .add_point(|| place_in_line(number, line, 0..line.len()));
        return Ok(());
    }
    let row = Row {
        numbers,
        atom,
        category,
    };
    match rows.push(plan, row) {
        Ok(Pushed::AsItIs) => Ok(()),
        Ok(Pushed::OfUnknown) => {
            let place = || place_in_line(number, line, symbol);
            rows.remarks.add_unknown(atom.label, place);
            Ok(())
        }
        Err(expected) => refused(symbol, expected),
    }
}

/// Adds a field to the contents of its column.
#[inline(never)]
fn look_at(
    contents: &mut Contents,
    line: &[u8],
    field: Range<usize>,
    column: usize,
    plan: &Plan,
    form: &Form,
) {
    let text = &line[field.clone()];
    match contents {
        Contents::Numbers(all) => {
            let mut number = parse(text, form.has_decimal_commas);
            if number.is_none() {
                number = time::parse(text);
                all.are_times |= number.is_some();
            }
            if number.is_none() && is_missing(text) {
                number = Some(f64::NAN);
            }
            contents.add_number(number);
        }
        Contents::Texts(_) if plan.element_column == Some(column) => {
            contents.add_text(plan.elements.name(form.atom(line, field)));
        }
        Contents::Texts(_) => contents.add_text(text),
        Contents::NoNumbers | Contents::Other => {}
    }
}

/// The kind of what is in a column, for messages.
fn kind(uses: &Uses) -> &'static str {
    match uses.slots() {
        [] => "a value",
        [Slot::Element, ..] => "an element",
        _ => "a number",
    }
}
