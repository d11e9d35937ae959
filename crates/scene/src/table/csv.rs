//! CSV: a line with the names of the columns, then a line for each sphere.
//!
//! Fields are separated by commas, semicolons or tabs, whichever comes first in the first line, and
//! may stand between quotation marks, but not go over lines.

use super::columns::Plan;
use super::error::TableError;
use super::lines::Lines;
use super::request::Request;
use super::rows::Rows;
use super::source::Source;
use super::text::{self, Fields, Form};
use crate::text::LocatedFault;

/// Reads a table.
pub(crate) fn read(file: Source<'_>, request: &Request) -> Result<Rows, TableError> {
    let mut lines = Lines::new(file)?;
    let header = lines.next()?.map(<[u8]>::to_vec).unwrap_or_default();
    // As some programs write it.
    let names = header.strip_prefix(b"#").unwrap_or(&header);
    if names.trim_ascii().is_empty() {
        let expected = "a line with the names of the columns";
        return Err(match lines.number {
            0 => LocatedFault::at_end(1, expected).into(),
            _ => LocatedFault::expected(1, &header, 0..header.len(), expected).into(),
        });
    }
    let is_separator = |byte: &u8| b",;\t".contains(byte);
    let separator = names.iter().copied().find(is_separator).unwrap_or(b',');
    let mut fields = Fields::new(names, Some(separator));
    let mut columns = Vec::new();
    while let Some(field) = fields.next() {
        columns.push(String::from_utf8_lossy(&names[field]).into_owned());
    }
    let plan = Plan::new(columns, request, |_| false)
        .map_err(|message| LocatedFault::in_line(1, &header, 0..header.len(), message))?;
    let form = Form {
        separator: Some(separator),
        may_be_longer: false,
    };
    text::read(&mut lines, &plan, form, None)
}
