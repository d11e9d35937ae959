//! Rows of text: numbers between spaces, or between commas and the like.

use std::ops::Range;

use rayon::prelude::*;

use super::columns::{Plan, RadiusSource, Slot};
use super::element;
use super::error::TableError;
use super::lines::{Lines, without_return};
use super::request::Coloring;
use super::rows::{Numbers, Rows};
use crate::text::{LocatedFault, show};

/// The division of lines into fields.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Form {
    /// The byte between fields; `None` for any spaces and tabs.
    pub(crate) separator: Option<u8>,
    /// Lines may have more fields than there are columns.
    pub(crate) may_be_longer: bool,
}

/// About how many bytes of text are one piece of work.
const PIECE: usize = 1 << 18;

/// Reads rows: `count` of them, or all, in which case empty lines are passed over. Returns how
/// many there were.
///
/// The pieces of a block are read on all threads of the current pool; what comes of it does not
/// depend on their number.
pub(crate) fn read(
    lines: &mut Lines<'_>,
    plan: &Plan,
    form: Form,
    count: Option<u64>,
) -> Result<Rows, TableError> {
    let mut rows = Rows::new(plan);
    let wanted = |rows: &Rows| match count {
        Some(count) => count - rows.len() as u64,
        None => u64::MAX,
    };
    let (size, mut number) = (lines.size()?, lines.number);
    while wanted(&rows) > 0 {
        let start = lines.position;
        let Some(block) = lines.next_block()? else {
            break;
        };
        let bytes = block.len() as u64;
        let pieces: Vec<&[u8]> = pieces(block).collect();
        let pieces: Vec<Piece> = pieces
            .into_par_iter()
            .map(|text| read_piece(text, plan, form, count.is_none()))
            .collect();
        if start == 0 || rows.len() == 0 {
            // As if all lines were as long as those of the first block.
            let found: usize = pieces.iter().map(|piece| piece.rows.len()).sum();
            let share = size.saturating_sub(start) as f64 / bytes as f64;
            let more = (1.01 * share * found as f64) as u64;
            rows.reserve(more.min(wanted(&rows)))?;
        }
        for piece in pieces {
            let wanted = wanted(&rows);
            let is_enough = piece.rows.len() as u64 >= wanted;
            rows.append(piece.rows, wanted.try_into().unwrap_or(usize::MAX));
            if is_enough {
                break;
            }
            if let Some(fault) = piece.fault {
                return Err(fault.lower(number).into());
            }
            number += piece.lines;
        }
    }
    lines.number = number;
    Ok(rows)
}

/// Reads `count` rows, which are called by `noun` where there are fewer.
pub(crate) fn read_count(
    lines: &mut Lines<'_>,
    plan: &Plan,
    form: Form,
    count: u64,
    noun: &str,
) -> Result<Rows, TableError> {
    let rows = read(lines, plan, form, Some(count))?;
    let found = rows.len();
    if (found as u64) < count {
        let expected = format!("{count} {noun}, and after {found} of them another");
        return Err(LocatedFault::at_end(lines.number + 1, &expected).into());
    }
    Ok(rows)
}

/// Parts of a block, each of whole lines.
fn pieces(block: &[u8]) -> impl Iterator<Item = &[u8]> {
    let mut rest = block;
    std::iter::from_fn(move || {
        if rest.is_empty() {
            return None;
        }
        let ahead = rest.iter().skip(PIECE).position(|&byte| byte == b'\n');
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
    /// The first fault, by the line in the piece.
    fault: Option<LocatedFault>,
}

fn read_piece(text: &[u8], plan: &Plan, form: Form, skips_empty: bool) -> Piece {
    let mut piece = Piece {
        rows: Rows::new(plan),
        lines: 0,
        fault: None,
    };
    let text = text.strip_suffix(b"\n").unwrap_or(text);
    for line in text.split(|&byte| byte == b'\n') {
        let line = without_return(line);
        piece.lines += 1;
        if skips_empty && line.trim_ascii().is_empty() {
            continue;
        }
        piece.fault = read_line(line, piece.lines, plan, form, &mut piece.rows).err();
        if piece.fault.is_some() {
            break;
        }
    }
    piece
}

/// Reads the row in the line with this number.
#[inline(always)]
fn read_line(
    line: &[u8],
    number: u64,
    plan: &Plan,
    form: Form,
    rows: &mut Rows,
) -> Result<(), LocatedFault> {
    let refused = |span: Range<usize>, expected: &str| {
        Err(LocatedFault::expected(number, line, span, expected))
    };
    let mut numbers: Numbers = [0.0; Slot::COUNT];
    let (mut atom, mut symbol) = (0, 0..0);
    let mut fields = Fields::new(line, form.separator);
    for (column, slot) in plan.slots.iter().enumerate() {
        let Some(field) = fields.next() else {
            let end = line.trim_ascii_end().len();
            return refused(end..end, &plan.expected(column, kind(*slot)));
        };
        match slot {
            None => {}
            Some(Slot::Element) => {
                atom = element::number(&line[field.clone()])
                    .ok_or_else(|| no_element(line, number, field.clone(), plan))?;
                symbol = field;
            }
            Some(slot) => {
                let value = parse(&line[field.clone()]);
                let refusal = match value {
                    Some(value) => slot.refusal(value, plan.is_encoded),
                    None => Some("a number"),
                };
                if let Some(expected) = refusal {
                    return refused(field, &plan.expected(column, expected));
                }
                numbers[*slot as usize] = value.unwrap_or_default();
            }
        }
    }
    if !form.may_be_longer
        && let Some(field) = fields.next()
    {
        let count = plan.slots.len();
        return refused(field, &format!("the end of the line after {count} columns"));
    }
    let pushed = rows.push(plan, &numbers, atom);
    pushed.or_else(|expected| refused(symbol, expected))
}

/// The contents of a column, for messages.
fn kind(slot: Option<Slot>) -> &'static str {
    match slot {
        None => "a value",
        Some(Slot::Element) => "an element",
        Some(_) => "a number",
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
            if matches!(plan.radius, RadiusSource::Element(_)) {
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

/// The number that is all of this text.
#[inline(always)]
fn parse(text: &[u8]) -> Option<f64> {
    str::from_utf8(text).ok()?.parse().ok()
}

/// The fields of a line.
#[derive(Clone, Debug)]
pub(crate) struct Fields<'line> {
    line: &'line [u8],
    at: usize,
    separator: Option<u8>,
    is_at_end: bool,
}

impl<'line> Fields<'line> {
    pub(crate) fn new(line: &'line [u8], separator: Option<u8>) -> Self {
        Self {
            line,
            at: 0,
            separator,
            is_at_end: false,
        }
    }

    /// The next field, without the spaces and the quotation marks around it.
    #[inline(always)]
    pub(crate) fn next(&mut self) -> Option<Range<usize>> {
        match self.separator {
            None => self.next_word(),
            Some(separator) => self.next_between(separator),
        }
    }

    #[inline(always)]
    fn next_word(&mut self) -> Option<Range<usize>> {
        let is_space = |byte: &u8| *byte == b' ' || *byte == b'\t';
        let rest = &self.line[self.at..];
        let start = rest.iter().position(|byte| !is_space(byte))?;
        let length = rest[start..].iter().position(is_space);
        let word =
            self.at + start..length.map_or(self.line.len(), |length| self.at + start + length);
        self.at = word.end;
        Some(word)
    }

    #[inline(always)]
    fn next_between(&mut self, separator: u8) -> Option<Range<usize>> {
        if self.is_at_end {
            return None;
        }
        let start = self.at;
        let mut end = start;
        let mut is_quoted = false;
        while end < self.line.len() && (is_quoted || self.line[end] != separator) {
            is_quoted ^= self.line[end] == b'"';
            end += 1;
        }
        self.is_at_end = end == self.line.len();
        self.at = end + 1;
        let field = trimmed(self.line, start..end);
        match self.line[field.clone()] {
            [b'"', .., b'"'] => Some(trimmed(self.line, field.start + 1..field.end - 1)),
            _ => Some(field),
        }
    }
}

/// The part of the line without the spaces around it.
#[inline(always)]
fn trimmed(line: &[u8], part: Range<usize>) -> Range<usize> {
    let end = part.start + line[part.clone()].trim_ascii_end().len();
    let rest = line[part.start..end].trim_ascii_start();
    end - rest.len()..end
}
