//! XYZ and extended XYZ: the number of atoms, a comment, a line for each atom; the first frame.
//!
//! An extended comment says in `Properties=name:type:columns:…` what the columns are; without one
//! they are the element and its place, and what follows is passed over.

use super::columns::{MOST_COLUMNS, Plan, components};
use super::error::TableError;
use super::lines::Lines;
use super::request::Request;
use super::rows::Rows;
use super::source::Source;
use super::text::{self, Form};
use crate::text::{LocatedFault, show};

/// Reads the first frame.
pub(crate) fn read(file: Source<'_>, request: &Request) -> Result<Rows, TableError> {
    let mut lines = Lines::new(file)?;
    let count = count(&mut lines)?;
    let comment = lines.next()?.map(<[u8]>::to_vec);
    let comment = comment.ok_or_else(|| LocatedFault::at_end(2, "a comment"))?;
    let columns = columns(&comment)?;
    let is_extended = columns.is_some();
    let columns = columns.unwrap_or_else(|| ["element", "x", "y", "z"].map(String::from).into());
    let plan = Plan::new(columns, request, |_| false)
        .map_err(|message| LocatedFault::in_line(2, &comment, 0..comment.len(), message))?;
    let form = Form {
        separator: None,
        may_be_longer: !is_extended,
    };
    text::read_count(
        &mut lines,
        &plan,
        form,
        count,
        "atoms, as the first line says",
    )
}

/// The number in the first line.
fn count(lines: &mut Lines<'_>) -> Result<u64, TableError> {
    let expected = "the number of atoms";
    let Some(line) = lines.next()? else {
        return Err(LocatedFault::at_end(1, expected).into());
    };
    let text = line.trim_ascii();
    let number = str::from_utf8(text).ok().and_then(|text| text.parse().ok());
    number.ok_or_else(|| {
        let start = line.len() - line.trim_ascii_start().len();
        LocatedFault::expected(1, line, start..start + text.len(), expected).into()
    })
}

/// The names of the columns that an extended comment lists.
fn columns(comment: &[u8]) -> Result<Option<Vec<String>>, LocatedFault> {
    const KEY: &[u8] = b"Properties=";
    let mut parts = comment.windows(KEY.len());
    let Some(key) = parts.position(|part| part.eq_ignore_ascii_case(KEY)) else {
        return Ok(None);
    };
    let start = key + KEY.len();
    let is_quoted = comment.get(start) == Some(&b'"');
    let start = start + usize::from(is_quoted);
    let is_end = |byte: &u8| byte.is_ascii_whitespace() || *byte == b'"';
    let length = comment[start..].iter().position(is_end);
    let span = start..length.map_or(comment.len(), |length| start + length);
    let text = String::from_utf8_lossy(&comment[span.clone()]).into_owned();
    let parts: Vec<&str> = text.split(':').collect();
    let mut names = Vec::new();
    for property in parts.chunks(3) {
        const MOST_OF_A_PROPERTY: u64 = 1000;
        let count = match property {
            [_, "S" | "R" | "I" | "L", count] => count.parse::<u64>().ok(),
            _ => None,
        };
        let count = count.filter(|count| (1..=MOST_OF_A_PROPERTY).contains(count));
        let Some(count) = count else {
            let expected = "expected properties `name:type:columns`, of type S, R, I or L";
            let message = format!("{expected}, found {}", show(&property.join(":")));
            return Err(LocatedFault::in_line(2, comment, span, message));
        };
        if count > (MOST_COLUMNS - names.len()) as u64 {
            let message = format!("expected at most {MOST_COLUMNS} columns, found more");
            return Err(LocatedFault::in_line(2, comment, span, message));
        }
        names.extend(match (property[0], count) {
            // The atomic number, beside a species.
            ("z" | "Z", 1) => vec![String::from("atomic number")],
            (name, _) => components(name, count),
        });
    }
    Ok(Some(names))
}
