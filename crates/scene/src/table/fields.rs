//! The fields of a line.

use std::ops::Range;
use std::sync::Arc;

/// The division of lines into fields.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Division {
    /// Between spaces and tabs.
    Words,
    /// Between spaces and tabs, unless quotation marks or apostrophes stand around them.
    QuotedWords,
    /// Between such bytes; quotation marks may stand around fields.
    Between(u8),
    /// As words, but the one at this place comes twice, since it tells the element, too.
    Repeated(usize),
    /// As quoted words, behind so many bytes.
    Behind(usize),
    /// In these columns of characters.
    Fixed(Arc<[Range<usize>]>),
    /// Between spaces, where a chain may be left out before the number of the residue; the name comes once more at the
    /// end, as that of PQR tells the element.
    Pqr,
    /// Between spaces and tabs, behind an empty field at the start.
    BehindNothing,
}

impl Division {
    /// The columns from 0 that this field of a line is in, if fields have fixed columns.
    pub(crate) fn place(&self, field: &Range<usize>) -> Option<Range<usize>> {
        let Self::Fixed(places) = self else {
            return None;
        };
        let mut places = places.iter();
        places.find(|place| place.contains(&field.start)).cloned()
    }
}

/// The fields of a line, one after another.
#[derive(Clone, Debug)]
pub(crate) struct Fields<'line> {
    line: &'line [u8],
    division: &'line Division,
    at: usize,
    /// Fields that were handed out.
    count: usize,
    is_at_end: bool,
}

impl<'line> Fields<'line> {
    pub(crate) fn new(line: &'line [u8], division: &'line Division) -> Self {
        Self {
            line,
            division,
            at: 0,
            count: 0,
            is_at_end: false,
        }
    }

    /// The next field, without the spaces and the quotation marks around it.
    #[inline(always)]
    pub(crate) fn next(&mut self) -> Option<Range<usize>> {
        match self.division {
            Division::Words => self.next_word(),
            Division::Between(separator) => self.next_between(*separator),
            Division::QuotedWords => self.next_quoted_word(),
            Division::Fixed(places) => self.next_place(places),
            Division::Repeated(place) => self.next_repeated(*place),
            Division::Behind(bytes) => {
                self.at = self.at.max(*bytes).min(self.line.len());
                self.next_quoted_word()
            }
            Division::Pqr => self.next_of_pqr(),
            Division::BehindNothing => match std::mem::replace(&mut self.count, 1) {
                0 => Some(0..0),
                _ => self.next_word(),
            },
        }
    }

    #[inline(always)]
    fn next_word(&mut self) -> Option<Range<usize>> {
        let line = self.line;
        let mut start = self.at;
        while is_space(line.get(start)?) {
            start += 1;
        }
        let mut end = start + 1;
        while end < line.len() && !is_space(&line[end]) {
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
        let (line, start) = (self.line, self.at);
        let mut end = start;
        while end < line.len() && line[end] != separator && line[end] != b'"' {
            end += 1;
        }
        if line.get(end) == Some(&b'"') {
            end = end_of_quoted(line, end, separator);
        }
        self.is_at_end = end == line.len();
        self.at = end + 1;
        let field = trimmed(line, start..end);
        match line[field.clone()] {
            [b'"', .., b'"'] => Some(trimmed(line, field.start + 1..field.end - 1)),
            _ => Some(field),
        }
    }

    fn next_quoted_word(&mut self) -> Option<Range<usize>> {
        let rest = &self.line[self.at..];
        let start = self.at + rest.iter().position(|byte| !is_space(byte))?;
        let quote = self.line[start];
        if quote != b'"' && quote != b'\'' {
            return self.next_word();
        }
        // A quotation mark inside of a word ends nothing.
        let is_end = |at: &usize| {
            let next = self.line.get(at + 1);
            self.line[*at] == quote && next.is_none_or(is_space)
        };
        let end = (start + 1..self.line.len()).find(is_end);
        let end = end.unwrap_or(self.line.len());
        self.at = (end + 1).min(self.line.len());
        Some(start + 1..end)
    }

    fn next_repeated(&mut self, place: usize) -> Option<Range<usize>> {
        let word = self.next_word()?;
        if self.count == place {
            self.at = word.start;
        }
        self.count += 1;
        Some(word)
    }

    fn next_of_pqr(&mut self) -> Option<Range<usize>> {
        let mut words = Fields::new(self.line, &Division::Words);
        let mut words: Vec<Range<usize>> = std::iter::from_fn(|| words.next()).collect();
        // Long numbers leave no space behind the record.
        if let Some(first) = words.first_mut()
            && first.len() > HETATM.len()
            && self.line[first.clone()].starts_with(HETATM)
        {
            let id = first.start + HETATM.len()..first.end;
            first.end = id.start;
            words.insert(1, id);
        }
        let place = self.count;
        self.count += 1;
        let behind = words.len().checked_sub(PQR_NUMBERS);
        let Some(behind) = behind.filter(|behind| *behind > PQR_BEFORE) else {
            return words.get(place).cloned();
        };
        let between = &words[PQR_BEFORE..behind];
        match place {
            0..PQR_BEFORE => Some(words[place].clone()),
            4 => match between {
                [_] => Some(between[0].start..between[0].start),
                [chain, ..] => Some(chain.clone()),
                [] => None,
            },
            5 => match between {
                [.., last] if between.len() < 3 => Some(last.clone()),
                // A letter of insertion stands behind the number.
                [_, number, ..] => Some(number.clone()),
                _ => None,
            },
            6..11 => words.get(behind + place - 6).cloned(),
            11 => Some(words[2].clone()),
            _ => None,
        }
    }

    fn next_place(&mut self, places: &[Range<usize>]) -> Option<Range<usize>> {
        let place = places.get(self.count)?;
        self.count += 1;
        // Lines may end before their last fields, which are empty then.
        let end = place.end.min(self.line.len());
        Some(trimmed(self.line, place.start.min(end)..end))
    }
}

/// The words of a line of PQR before the chain, or the number of the residue, and the numbers at its end.
const PQR_BEFORE: usize = 4;
const PQR_NUMBERS: usize = 5;
const HETATM: &[u8] = b"HETATM";

/// All fields of a line.
pub(crate) fn all<'line>(line: &'line [u8], division: &Division) -> Vec<&'line [u8]> {
    let mut fields = Fields::new(line, division);
    std::iter::from_fn(|| fields.next())
        .map(|field| &line[field])
        .collect()
}

/// The end of a field with a quotation mark at this place: separators between two marks do not end it.
#[cold]
fn end_of_quoted(line: &[u8], mark: usize, separator: u8) -> usize {
    let mut end = mark;
    let mut is_quoted = false;
    while end < line.len() && (is_quoted || line[end] != separator) {
        is_quoted ^= line[end] == b'"';
        end += 1;
    }
    end
}

#[inline(always)]
fn is_space(byte: &u8) -> bool {
    *byte == b' ' || *byte == b'\t'
}

/// The part of the line without the spaces around it.
#[inline(always)]
fn trimmed(line: &[u8], part: Range<usize>) -> Range<usize> {
    let end = part.start + line[part.clone()].trim_ascii_end().len();
    let rest = line[part.start..end].trim_ascii_start();
    end - rest.len()..end
}
