//! The tags of an XML file, one after another.
//!
//! The numbers between them are passed over. A parser of XML would stop at appended bytes, and at names of arrays in which
//! VTK writes `<` and `&` as they are.

use super::super::error::TableError;
use super::bytes::Bytes;
use crate::text::LocatedFault;

/// The longest tag that is read, in bytes.
const LONGEST_TAG: usize = 1 << 16;
/// The furthest column of a tag that a message shows in its place.
const FURTHEST_COLUMN: u64 = 200;

/// The tags of a file, one after another.
pub(super) struct Tags<'b, 'a, 'watch> {
    bytes: &'b mut Bytes<'a, 'watch>,
    /// The line of the next byte, from 1, and the bytes of that line before it.
    line: u64,
    column: u64,
}

/// A tag.
#[derive(Clone, Debug)]
pub(super) struct Tag {
    pub(super) name: String,
    attributes: Vec<(String, String)>,
    /// It is one such as `</Points>`.
    pub(super) is_end: bool,
    /// It is one such as `<DataArray/>`.
    pub(super) is_empty: bool,
    pub(super) place: TagPlace,
    /// The byte behind it.
    pub(super) end: u64,
}

/// The place of a tag, and its text.
#[derive(Clone, Debug)]
pub(super) struct TagPlace {
    pub(super) line: u64,
    column: u64,
    text: Vec<u8>,
}

impl<'b, 'a, 'watch> Tags<'b, 'a, 'watch> {
    /// The tags of a file that is at its start.
    pub(super) fn new(bytes: &'b mut Bytes<'a, 'watch>) -> Self {
        Self {
            bytes,
            line: 1,
            column: 0,
        }
    }

    /// The next tag; `None` at the end of the file.
    pub(super) fn next(&mut self) -> Result<Option<Tag>, TableError> {
        loop {
            if !self.pass_text()? {
                return Ok(None);
            }
            let (line, column) = (self.line, self.column);
            let text = self.take()?;
            if text.starts_with(b"<?") || text.starts_with(b"<!") {
                continue;
            }
            let end = self.bytes.position();
            return Ok(Some(Tag::new(TagPlace { line, column, text }, end)));
        }
    }

    /// The end of the file, where something else was expected.
    pub(super) fn fault_at_end(&self, expected: &str) -> LocatedFault {
        LocatedFault::at_end(self.line, expected)
    }

    /// Passes over text; returns whether a tag follows.
    fn pass_text(&mut self) -> Result<bool, TableError> {
        loop {
            let ahead = self.bytes.ahead()?;
            if ahead.is_empty() {
                return Ok(false);
            }
            let start = memchr::memchr(b'<', ahead);
            let count = start.unwrap_or(ahead.len());
            let text = &ahead[..count];
            let lines = memchr::memchr_iter(b'\n', text).count() as u64;
            self.column = match memchr::memrchr(b'\n', text) {
                Some(last) => (count - last - 1) as u64,
                None => self.column + count as u64,
            };
            self.line += lines;
            self.bytes.pass(count);
            if start.is_some() {
                return Ok(true);
            }
        }
    }

    /// Takes a tag or a comment, whose first byte comes next. Quoted values may hold the mark that ends a tag.
    fn take(&mut self) -> Result<Vec<u8>, TableError> {
        let line = self.line;
        let mut text = Vec::new();
        let mut open = None;
        loop {
            let ahead = self.bytes.ahead()?;
            if ahead.is_empty() {
                return Err(self.fault_at_end("the end of a tag, `>`").into());
            }
            let mark = match open {
                Some(quote) => memchr::memchr(quote, ahead),
                None => memchr::memchr3(b'>', b'"', b'\'', ahead),
            };
            let count = mark.map_or(ahead.len(), |mark| mark + 1);
            let part = &ahead[..count];
            text.extend_from_slice(part);
            self.line += memchr::memchr_iter(b'\n', part).count() as u64;
            self.column = match memchr::memrchr(b'\n', part) {
                Some(last) => (count - last - 1) as u64,
                None => self.column + count as u64,
            };
            self.bytes.pass(count);
            let is_comment = text.starts_with(b"<!--");
            let has_values = !text.starts_with(b"<!") && !text.starts_with(b"<?");
            match (mark, text.last()) {
                (Some(_), Some(b'>'))
                    if open.is_none() && (!is_comment || text.ends_with(b"-->")) =>
                {
                    return Ok(text);
                }
                (Some(_), Some(&quote)) if has_values && quote != b'>' => {
                    open = match open {
                        None => Some(quote),
                        Some(_) => None,
                    };
                }
                _ => {}
            }
            if text.len() > LONGEST_TAG && !is_comment {
                let message =
                    format!("expected a tag of at most {LONGEST_TAG} bytes, found a longer one");
                return Err(LocatedFault::in_line(line, b"", 0..0, message).into());
            }
        }
    }
}

impl Tag {
    fn new(place: TagPlace, end: u64) -> Self {
        let text = String::from_utf8_lossy(&place.text).into_owned();
        let inside = text.trim_start_matches('<').trim_end_matches('>');
        let is_end = inside.starts_with('/');
        let is_empty = inside.ends_with('/');
        let inside = inside.trim_matches('/');
        let start = inside.find(|letter: char| letter.is_ascii_whitespace());
        let (name, mut rest) = inside.split_at(start.unwrap_or(inside.len()));
        let mut attributes = Vec::new();
        while let Some((key, after)) = rest.split_once('=') {
            let after = after.trim_start();
            let Some(quote) = after
                .chars()
                .next()
                .filter(|quote| matches!(quote, '"' | '\''))
            else {
                break;
            };
            let Some((value, after)) = after[1..].split_once(quote) else {
                break;
            };
            attributes.push((key.trim().to_owned(), unescaped(value)));
            rest = after;
        }
        Self {
            name: name.to_owned(),
            attributes,
            is_end,
            is_empty,
            place,
            end,
        }
    }

    /// The value of this attribute.
    pub(super) fn value(&self, key: &str) -> Option<&str> {
        let mut attributes = self.attributes.iter();
        let found = attributes.find(|attribute| attribute.0 == key);
        found.map(|attribute| attribute.1.as_str())
    }

    /// The whole number that this attribute has, or `default` where there is none.
    pub(super) fn whole(&self, key: &str, default: Option<u64>) -> Result<u64, LocatedFault> {
        let value = self.value(key);
        let number = value.map_or(default, |value| value.trim().parse().ok());
        number.ok_or_else(|| self.place.expected(&format!("a whole number as `{key}`")))
    }
}

impl TagPlace {
    /// Something else was expected than this tag.
    pub(super) fn expected(&self, expected: &str) -> LocatedFault {
        let (line, span) = self.shown();
        LocatedFault::expected(self.line, &line, span, expected)
    }

    /// Says this of the tag.
    pub(super) fn told(&self, message: String) -> LocatedFault {
        let (line, span) = self.shown();
        LocatedFault::in_line(self.line, &line, span, message)
    }

    /// The first line of the tag behind as many spaces as there are bytes before it, and its place there.
    fn shown(&self) -> (Vec<u8>, std::ops::Range<usize>) {
        let before = self.column.min(FURTHEST_COLUMN) as usize;
        let first = self.text.split(|&byte| byte == b'\n').next();
        let mut line = vec![b' '; before];
        line.extend(first.unwrap_or_default().trim_ascii_end());
        let end = line.len();
        (line, before..end)
    }
}

/// A value without the names of marks.
fn unescaped(value: &str) -> String {
    const NAMES: [(&str, &str); 5] = [
        ("&lt;", "<"),
        ("&gt;", ">"),
        ("&quot;", "\""),
        ("&apos;", "'"),
        // The last one: others begin with it.
        ("&amp;", "&"),
    ];
    let mut text = value.to_owned();
    for (name, mark) in NAMES {
        text = text.replace(name, mark);
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tags_are_told_from_what_stands_between_them() {
        let text = "<?xml version=\"1.0\"?>\n<!-- <a> -->\n  <b one='1' two = \"&lt;&amp;lt;\"> 1 2\n<c n=\"<&>\"/></b>\n<d\n e=\"5\">";
        let mut bytes = Bytes::Decompressed(text.as_bytes().to_vec(), 0);
        let mut tags = Tags::new(&mut bytes);
        let mut next = || tags.next().unwrap();
        let first = next().unwrap();
        assert_eq!(
            (&*first.name, first.value("one"), first.value("two")),
            ("b", Some("1"), Some("<&lt;"))
        );
        assert_eq!((first.place.line, first.place.column), (3, 2));
        assert_eq!(text.as_bytes()[first.end as usize - 1], b'>');
        let second = next().unwrap();
        assert!(second.is_empty && !second.is_end);
        assert_eq!(
            (&*second.name, second.value("n"), second.place.line),
            ("c", Some("<&>"), 4)
        );
        let third = next().unwrap();
        assert!(third.is_end && third.name == "b" && third.place.column == 12);
        let fourth = next().unwrap();
        assert_eq!((fourth.whole("e", None), fourth.place.line), (Ok(5), 5));
        assert!(fourth.whole("f", None).is_err());
        assert!(next().is_none());
    }
}
