//! Rows of text: numbers between spaces, or between commas and the like.

use std::ops::Range;

use rayon::prelude::*;

use super::columns::{Plan, RadiusSource, Slot};
use super::element;
use super::error::{LineFault, TableError, TableFault};
use super::lines::{Lines, without_return};
use super::request::Coloring;
use super::rows::{Numbers, Rows};
use crate::text::show;

/// The division of lines into fields.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Form {
    /// The byte between fields; `None` for any spaces and tabs.
    pub(crate) separator: Option<u8>,
    /// Whether lines may have more fields than there are columns.
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
            if let Some((line, fault)) = piece.fault {
                return Err(fault.at(number + piece.lines, &line).into());
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
        return Err(TableFault::at_end(lines.number + 1, &expected).into());
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
    /// The first fault, and its line.
    fault: Option<(Vec<u8>, LineFault)>,
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
        if let Err(fault) = read_line(line, plan, form, &mut piece.rows) {
            piece.fault = Some((line.to_vec(), fault));
            break;
        }
    }
    piece
}

#[inline(always)]
fn read_line(line: &[u8], plan: &Plan, form: Form, rows: &mut Rows) -> Result<(), LineFault> {
    let mut numbers: Numbers = [0.0; Slot::COUNT];
    let (mut atom, mut symbol) = (0, 0..0);
    let mut fields = Fields::new(line, form.separator);
    for (column, slot) in plan.slots.iter().enumerate() {
        let Some(field) = fields.next() else {
            let end = line.trim_ascii_end().len();
            let expected = plan.expected(column, kind(*slot));
            return Err(LineFault::new(line, end..end, &expected));
        };
        match slot {
            None => {}
            Some(Slot::Element) => {
                atom = element::number(&line[field.clone()])
                    .ok_or_else(|| no_element(line, field.clone(), plan))?;
                symbol = field;
            }
            Some(slot) => {
                let number = parse(&line[field.clone()]);
                let refusal = match number {
                    Some(number) => slot.refusal(number, plan.is_encoded),
                    None => Some("a number"),
                };
                if let Some(expected) = refusal {
                    let expected = plan.expected(column, expected);
                    return Err(LineFault::new(line, field, &expected));
                }
                numbers[*slot as usize] = number.unwrap_or_default();
            }
        }
    }
    if !form.may_be_longer
        && let Some(field) = fields.next()
    {
        let expected = format!("the end of the line after {} columns", plan.slots.len());
        return Err(LineFault::new(line, field, &expected));
    }
    rows.push(plan, &numbers, atom)
        .map_err(|expected| LineFault::new(line, symbol, expected))
}

/// The contents of a column, for messages.
fn kind(slot: Option<Slot>) -> &'static str {
    match slot {
        None => "a value",
        Some(Slot::Element) => "an element",
        Some(_) => "a number",
    }
}

#[cold]
fn no_element(line: &[u8], field: Range<usize>, plan: &Plan) -> LineFault {
    let text = String::from_utf8_lossy(&line[field.clone()]).into_owned();
    let mut fault = LineFault::new(line, field, "the symbol of an element");
    match element::suggestion(&text) {
        Some(symbol) => fault.message += &format!(", did you mean {}?", show(symbol)),
        None => {
            let mut instead = Vec::new();
            if matches!(plan.radius, RadiusSource::Element(_)) {
                instead.push("`radius: …`");
            }
            if plan.coloring == Coloring::Element {
                instead.push("`color: Material`");
            }
            fault.message += &format!(" (with {} none is needed)", instead.join(" and "));
        }
    }
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
        let is_space = |byte: u8| byte == b' ' || byte == b'\t';
        let mut start = self.at;
        while is_space(*self.line.get(start)?) {
            start += 1;
        }
        let mut end = start;
        while end < self.line.len() && !is_space(self.line[end]) {
            end += 1;
        }
        self.at = end;
        Some(start..end)
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
        let (mut start, mut end) = trimmed(self.line, start, end);
        if end >= start + 2 && self.line[start] == b'"' && self.line[end - 1] == b'"' {
            (start, end) = trimmed(self.line, start + 1, end - 1);
        }
        Some(start..end)
    }
}

#[inline(always)]
fn trimmed(line: &[u8], mut start: usize, mut end: usize) -> (usize, usize) {
    while start < end && line[start].is_ascii_whitespace() {
        start += 1;
    }
    while start < end && line[end - 1].is_ascii_whitespace() {
        end -= 1;
    }
    (start, end)
}
