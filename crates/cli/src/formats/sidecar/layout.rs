//! JSON in a readable layout: one line for each member of an object, and lists on one line.

use std::io::{self, Write};

use serde::Serialize;
use serde_json::ser::{Formatter, Serializer};

/// The text of a value.
pub(super) fn text(value: &impl Serialize) -> Result<String, String> {
    let mut bytes = Vec::new();
    let mut serializer = Serializer::with_formatter(&mut bytes, Layout::default());
    let written = value.serialize(&mut serializer);
    written.map_err(|error| error.to_string())?;
    bytes.push(b'\n');
    String::from_utf8(bytes).map_err(|error| error.to_string())
}

#[derive(Debug, Default)]
struct Layout {
    /// The enclosing objects.
    depth: usize,
    /// Whether the object that has just ended had a member.
    has_member: bool,
}

impl Layout {
    fn break_line<W: ?Sized + Write>(&self, out: &mut W) -> io::Result<()> {
        out.write_all(b"\n")?;
        (0..self.depth).try_for_each(|_| out.write_all(b"  "))
    }
}

impl Formatter for Layout {
    fn begin_array_value<W: ?Sized + Write>(&mut self, out: &mut W, first: bool) -> io::Result<()> {
        if first { Ok(()) } else { out.write_all(b", ") }
    }

    fn begin_object<W: ?Sized + Write>(&mut self, out: &mut W) -> io::Result<()> {
        self.depth += 1;
        self.has_member = false;
        out.write_all(b"{")
    }

    fn end_object<W: ?Sized + Write>(&mut self, out: &mut W) -> io::Result<()> {
        self.depth -= 1;
        if self.has_member {
            self.break_line(out)?;
        }
        out.write_all(b"}")
    }

    fn begin_object_key<W: ?Sized + Write>(&mut self, out: &mut W, first: bool) -> io::Result<()> {
        if !first {
            out.write_all(b",")?;
        }
        self.break_line(out)
    }

    fn begin_object_value<W: ?Sized + Write>(&mut self, out: &mut W) -> io::Result<()> {
        out.write_all(b": ")
    }

    fn end_object_value<W: ?Sized + Write>(&mut self, _: &mut W) -> io::Result<()> {
        self.has_member = true;
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use serde_json::json;

    use super::*;

    #[test]
    fn lists_stay_on_a_line_and_members_have_one_each() {
        let value = json!({
            "a": [[1.0, 2.5], [0.1, 1e+300]],
            "b": {},
            "c": [{"d": null}, {"e": []}],
        });
        let expected = r#"{
  "a": [[1.0, 2.5], [0.1, 1e+300]],
  "b": {},
  "c": [{
    "d": null
  }, {
    "e": []
  }]
}
"#;
        assert_eq!(text(&value).as_deref(), Ok(expected));
        assert_eq!(text(&f64::INFINITY).as_deref(), Ok("null\n"));
    }
}
