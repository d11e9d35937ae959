//! Tables of text: a line for each sphere, its fields between commas, semicolons, tabs or spaces.
//!
//! A line with the names of the columns may stand before them, as a comment or not. Where none does, columns have
//! numbers. Lines that begin with `#` or `%` are comments. Fields may stand between quotation marks, but not go over
//! lines. Where semicolons separate them, numbers may have commas for points.

use super::error::TableError;
use super::fields::{self, Division};
use super::form::{Form, LineKind, of_table};
use super::header::Header;
use super::input::Input;
use super::number::{is_missing, parse};
use super::time;
use crate::text::LocatedFault;

/// The header of a table whose separators the ending of its name may tell.
pub(crate) fn header(input: &mut Input<'_>, is_csv: bool) -> Result<Header, TableError> {
    let mut comment: Option<(u64, Vec<u8>)> = None;
    loop {
        let number = input.number + 1;
        let Some(line) = input.peek()?.map(<[u8]>::to_vec) else {
            return match comment {
                // As some programs write the names.
                Some((number, line)) => Ok(named(&line, number, is_csv)),
                None => Err(LocatedFault::at_end(number, EXPECTED).into()),
            };
        };
        if is_csv && number == 1 && line.trim_ascii().is_empty() {
            return Err(LocatedFault::expected(1, &line, 0..line.len(), EXPECTED).into());
        }
        if of_table(&line) == LineKind::Other {
            input.next()?;
            if !line.trim_ascii().is_empty() {
                comment = Some((number, line));
            }
            continue;
        }
        let division = division(&line, is_csv);
        let first = fields::all(&line, &division);
        if !first.iter().all(|field| is_number(field, &division)) || first.is_empty() {
            // A comment of as many names stands before rows that begin with a text, too.
            let is_row = first.iter().any(|field| is_number(field, &division));
            if let Some((number, comment)) = comment.filter(|_| is_row)
                && names(&comment, &division).len() == first.len()
            {
                return with_commas(input, self::header_of(&comment, number, division));
            }
            input.next()?;
            if line.contains(&b'\r') {
                let at = memchr::memchr(b'\r', &line).unwrap_or(0);
                let message =
                    "expected lines that end with a line feed, found only carriage returns";
                return Err(
                    LocatedFault::in_line(number, &line, at..at, message.to_owned()).into(),
                );
            }
            return with_commas(input, named(&line, number, is_csv));
        }
        let count = first.len();
        if counts_columns(&first) && matches!(division, Division::Between(_)) {
            let told = "the first line numbers the columns, and is read as a sphere: names of columns cannot be numbers";
            input.leave_out(LocatedFault::in_line(
                number,
                &line,
                0..line.len(),
                told.to_owned(),
            ));
        }
        if let Some((number, comment)) = comment
            && names(&comment, &division).len() == count
        {
            return with_commas(input, self::header_of(&comment, number, division));
        }
        let names = match count {
            3 => ["x", "y", "z"].map(String::from).into(),
            _ => (1..=count).map(|column| column.to_string()).collect(),
        };
        let header = Header::new(names, Form::new(division), (number, &line));
        return with_commas(input, header);
    }
}

const EXPECTED: &str = "a line with the names of the columns";

/// The header that a line of names is.
fn named(line: &[u8], number: u64, is_csv: bool) -> Header {
    header_of(line, number, division(uncommented(line), is_csv))
}

fn header_of(line: &[u8], number: u64, division: Division) -> Header {
    let names = names(line, &division);
    Header::new(names, Form::new(division), (number, line))
}

/// The names in a line.
fn names(line: &[u8], division: &Division) -> Vec<String> {
    let fields = fields::all(uncommented(line), division);
    let name = |field: &&[u8]| String::from_utf8_lossy(field).into_owned();
    fields.iter().map(name).collect()
}

/// The line without the mark of a comment.
fn uncommented(line: &[u8]) -> &[u8] {
    let line = line.trim_ascii_start();
    let marks = line.iter().take_while(|byte| b"#%".contains(byte)).count();
    &line[marks..]
}

/// The division of lines like this one.
fn division(line: &[u8], is_csv: bool) -> Division {
    let separator = |bytes: &'static [u8]| line.iter().copied().find(|byte| bytes.contains(byte));
    match separator(b",;\t") {
        // Spaces and tabs alike separate words.
        Some(b'\t') if !is_csv => Division::Words,
        Some(separator) => Division::Between(separator),
        None if is_csv && !line.trim_ascii().contains(&b' ') => Division::Between(b','),
        None => Division::QuotedWords,
    }
}

/// Says whether a field is a number or a time, or tells that there is none.
fn is_number(field: &[u8], division: &Division) -> bool {
    parse(field, *division == Division::Between(b';')).is_some()
        || is_missing(field)
        || time::parse(field).is_some()
}

/// Says whether fields are the numbers of their columns from 0 on, which some programs write in place of names.
fn counts_columns(fields: &[&[u8]]) -> bool {
    let mut numbers = (0..fields.len()).map(|number| number.to_string());
    fields.iter().all(|field| {
        numbers
            .next()
            .is_some_and(|number| number.as_bytes() == *field)
    })
}

/// The same header, which knows whether numbers have commas: the first row that has commas or points tells it.
fn with_commas(input: &mut Input<'_>, mut header: Header) -> Result<Header, TableError> {
    if header.form.division == Division::Between(b';') && input.peek()?.is_some() {
        let rows = input.head().split(|byte| *byte == b'\n');
        let mut rows = rows.filter(|line| of_table(line) == LineKind::Row);
        let telling = rows.find(|row| row.contains(&b',') || row.contains(&b'.'));
        header.form.has_decimal_commas =
            telling.is_some_and(|row| row.contains(&b',') && !row.contains(&b'.'));
    }
    Ok(header)
}
