//! XYZ and extended XYZ: the number of atoms, a comment, a line for each atom; the first frame.
//!
//! An extended comment says in `Properties=name:type:columns:…` what the columns are; without one
//! they are the element and its place, and what follows is passed over.

use super::columns::Plan;
use super::fault::LineFault;
use super::lines::Lines;
use super::rows::Rows;
use super::source::Source;
use super::text::{self, Form};
use super::{Request, TableError, TableFault};
use crate::fault::show;

/// Reads the first frame.
pub(crate) fn read(file: Source<'_>, request: &Request) -> Result<Rows, TableError> {
    let mut lines = Lines::new(file)?;
    let count = count(&mut lines)?;
    let comment = lines.next()?.map(<[u8]>::to_vec);
    let comment = comment.ok_or_else(|| TableFault::at_end(2, "a comment"))?;
    let columns = columns(&comment).map_err(|fault| fault.at(2, &comment))?;
    let is_extended = columns.is_some();
    let columns = columns.unwrap_or_else(|| ["element", "x", "y", "z"].map(String::from).into());
    let plan = Plan::new(columns, request, |_| false).map_err(|message| {
        let span = 0..comment.len();
        LineFault { span, message }.at(2, &comment)
    })?;
    let form = Form {
        separator: None,
        may_be_longer: !is_extended,
    };
    let rows = text::read(&mut lines, &plan, form, Some(count))?;
    if (rows.len() as u64) < count {
        let found = rows.len();
        let expected =
            format!("{count} atoms, as the first line says, and after {found} of them another");
        return Err(TableFault::at_end(lines.number + 1, &expected).into());
    }
    Ok(rows)
}

/// The number in the first line.
fn count(lines: &mut Lines<'_>) -> Result<u64, TableError> {
    let expected = "the number of atoms";
    let Some(line) = lines.next()? else {
        return Err(TableFault::at_end(1, expected).into());
    };
    let text = line.trim_ascii();
    let number = str::from_utf8(text).ok().and_then(|text| text.parse().ok());
    number.ok_or_else(|| {
        let start = line.len() - line.trim_ascii_start().len();
        LineFault::new(line, start..start + text.len(), expected)
            .at(1, line)
            .into()
    })
}

/// The names of the columns that an extended comment lists.
fn columns(comment: &[u8]) -> Result<Option<Vec<String>>, LineFault> {
    const KEY: &[u8] = b"Properties=";
    let Some(key) = comment
        .windows(KEY.len())
        .position(|part| part.eq_ignore_ascii_case(KEY))
    else {
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
        const MOST_COLUMNS: usize = 1000;
        let count = match property {
            [_, "S" | "R" | "I" | "L", count] => count.parse::<usize>().ok(),
            _ => None,
        };
        let count = count.filter(|count| (1..=MOST_COLUMNS).contains(count));
        let Some(count) = count else {
            let expected = "expected properties `name:type:columns`, of type S, R, I or L";
            let message = format!("{expected}, found {}", show(&property.join(":")));
            return Err(LineFault { span, message });
        };
        names.extend(names_of(property[0], count));
    }
    Ok(Some(names))
}

/// The names of the columns of one property.
fn names_of(property: &str, count: usize) -> Vec<String> {
    let names: &[&str] = match (property.to_ascii_lowercase().as_str(), count) {
        ("pos" | "position" | "positions", 3) => &["x", "y", "z"],
        ("color" | "colour", 3) => &["red", "green", "blue"],
        // The atomic number, beside a species.
        ("z", 1) => &["atomic number"],
        (_, 1) => return vec![property.to_owned()],
        _ => {
            return (1..=count)
                .map(|number| format!("{property}_{number}"))
                .collect();
        }
    };
    names.iter().copied().map(String::from).collect()
}
