//! Scenes in JSON, as texts in RON in which every token stays at its place.
//!
//! An object is a structure, or a variant with its value if its only key begins with a capital letter: `{"Fov": 40}` is
//! `Fov(40)`. Arrays are lists or tuples, and texts are texts or variants, by the fields that they belong to. Fields that are
//! `null` are left out.

use std::ops::Range;

use serde::de::IgnoredAny;

use super::fault::Fault;
use super::show::{quoted, show};

/// Fields whose objects have names of the user's own as keys.
const MAPS: [&str; 3] = ["materials", "palette", "radii"];

/// Fields whose arrays are lists; those of others are tuples.
const LISTS: [&str; 6] = ["clouds", "keep", "keys", "lights", "rotation", "spheres"];

/// Fields whose texts are variants if they begin with a capital letter, such as `"up": "Z"`.
const CHOICES: [&str; 16] = [
    "attached",
    "axes",
    "color",
    "color_scale",
    "colormap",
    "ease",
    "end",
    "falloff",
    "frame_over",
    "frames",
    "grain",
    "missing",
    "radii",
    "radius_law",
    "up",
    "what",
];

/// Returns whether the text of a scene is in JSON.
pub(crate) fn is_json(text: &str) -> bool {
    text.trim_ascii_start().starts_with('{')
}

/// The text in RON that says the same as a text in JSON, as long as it.
///
/// # Errors
/// Refuses what is not JSON, and objects that are neither a structure nor a variant.
pub(crate) fn to_ron(json: &str) -> Result<String, Fault> {
    if let Err(error) = serde_json::from_str::<IgnoredAny>(json) {
        return Err(syntax_fault(json, &error));
    }
    let mut ron = Converter {
        json,
        ron: json.as_bytes().to_vec(),
    };
    let start = ron.skip_space(0);
    ron.value(start, "")?;
    String::from_utf8(ron.ron).map_err(|error| {
        let at = error.utf8_error().valid_up_to();
        Fault::new(at..at, "expected text in UTF-8, found something else")
    })
}

fn syntax_fault(json: &str, error: &serde_json::Error) -> Fault {
    let before = json
        .split_inclusive('\n')
        .take(error.line().saturating_sub(1));
    let line: usize = before.map(str::len).sum();
    // Columns are bytes, from 1.
    let mut at = (line + error.column().saturating_sub(1)).min(json.len());
    while !json.is_char_boundary(at) {
        at -= 1;
    }
    Fault::new(at..at, reason_of(error))
}

/// A text in JSON without faults, and what it becomes.
struct Converter<'t> {
    json: &'t str,
    ron: Vec<u8>,
}

impl Converter<'_> {
    /// Converts the value that starts at a place, of a field or of an element of its list; returns its end.
    fn value(&mut self, start: usize, field: &str) -> Result<usize, Fault> {
        match self.byte(start) {
            b'{' if MAPS.contains(&field) => self.map(start),
            b'{' => self.object(start),
            b'[' => self.array(start, field),
            b'"' => {
                let end = self.string_end(start);
                let text = &self.json[start + 1..end - 1];
                let is_variant = CHOICES.contains(&field)
                    && text.starts_with(|c: char| c.is_ascii_uppercase())
                    && is_name(text);
                if is_variant {
                    self.unquote(start..end);
                } else {
                    self.unescape(start..end)?;
                }
                Ok(end)
            }
            b'n' => {
                self.ron[start..start + 4].copy_from_slice(b"None");
                Ok(start + 4)
            }
            _ => {
                let is_part = |byte: &u8| byte.is_ascii_alphanumeric() || b"+-.".contains(byte);
                let rest = self.json[start..].bytes();
                Ok(start + rest.take_while(is_part).count().max(1))
            }
        }
    }

    /// Converts an object: a structure, or a variant.
    fn object(&mut self, start: usize) -> Result<usize, Fault> {
        if self.is_variant(start) {
            return self.variant(start);
        }
        self.ron[start] = b'(';
        let mut at = self.skip_space(start + 1);
        while self.byte(at) == b'"' {
            let key = at..self.string_end(at);
            let value = self.value_of(&key);
            let json = self.json;
            let name = &json[key.start + 1..key.end - 1];
            if !is_name(name) {
                let message = format!("expected the name of a field, found {}", quoted(name));
                return Err(Fault::new(key, message));
            }
            self.unquote(key.clone());
            let end = self.value(value, name)?;
            at = self.behind_comma(end);
            if self.byte(value) == b'n' {
                self.ron[key.start..at].iter_mut().for_each(blank_out);
            }
        }
        self.ron[at] = b')';
        Ok(at + 1)
    }

    /// Converts an object whose keys are the user's own.
    fn map(&mut self, start: usize) -> Result<usize, Fault> {
        let mut at = self.skip_space(start + 1);
        while self.byte(at) == b'"' {
            let key = at..self.string_end(at);
            let value = self.value_of(&key);
            self.unescape(key)?;
            let end = self.value(value, "")?;
            at = self.behind_comma(end);
        }
        Ok(at + 1)
    }

    /// Returns whether the first key of an object begins with a capital letter.
    fn is_variant(&self, start: usize) -> bool {
        let key = self.skip_space(start + 1);
        self.byte(key) == b'"' && self.byte(key + 1).is_ascii_uppercase()
    }

    /// Converts an object whose only key is the name of a variant.
    fn variant(&mut self, start: usize) -> Result<usize, Fault> {
        let key = self.skip_space(start + 1);
        let key = key..self.string_end(key);
        let colon = self.skip_space(key.end);
        let value = self.value_of(&key);
        self.unquote(key.clone());
        let end = self.value(value, "")?;
        let close = self.skip_space(end);
        if self.byte(close) == b',' {
            let name = quoted(&self.json[key.start + 1..key.end - 1]);
            let other = self.skip_space(close + 1);
            let other = other..self.string_end(other);
            let found = show(&self.json[other.clone()]);
            let message = format!("expected nothing beside {name} in its object, found {found}");
            return Err(Fault::new(other, message));
        }
        // Brackets of a structure or a tuple are those of the variant.
        let has_brackets = match self.byte(value) {
            b'{' => !self.is_variant(value),
            first => first == b'[',
        };
        self.ron[start] = b' ';
        self.ron[colon] = if has_brackets { b' ' } else { b'(' };
        self.ron[close] = if has_brackets { b' ' } else { b')' };
        Ok(close + 1)
    }

    /// Converts an array: a list, or a tuple.
    fn array(&mut self, start: usize, field: &str) -> Result<usize, Fault> {
        let mut at = self.skip_space(start + 1);
        while self.byte(at) != b']' {
            let end = self.value(at, "")?;
            at = self.behind_comma(end);
        }
        if !LISTS.contains(&field) {
            self.ron[start] = b'(';
            self.ron[at] = b')';
        }
        Ok(at + 1)
    }

    /// The start of the value that belongs to a key.
    fn value_of(&self, key: &Range<usize>) -> usize {
        let colon = self.skip_space(key.end);
        self.skip_space(colon + 1)
    }

    /// The start of what follows a value, and the comma behind it.
    fn behind_comma(&self, end: usize) -> usize {
        let next = self.skip_space(end);
        match self.byte(next) {
            b',' => self.skip_space(next + 1),
            _ => next,
        }
    }

    fn skip_space(&self, from: usize) -> usize {
        let rest = self.json[from..].bytes();
        from + rest.take_while(u8::is_ascii_whitespace).count()
    }

    fn byte(&self, at: usize) -> u8 {
        self.json.as_bytes().get(at).copied().unwrap_or_default()
    }

    /// The end of the string that starts at a place.
    fn string_end(&self, start: usize) -> usize {
        let mut is_escaped = false;
        let rest = self.json[start + 1..].bytes();
        let inside = rest.take_while(|&byte| {
            let is_end = byte == b'"' && !is_escaped;
            is_escaped = byte == b'\\' && !is_escaped;
            !is_end
        });
        start + inside.count() + 2
    }

    fn unquote(&mut self, string: Range<usize>) {
        self.ron[string.start] = b' ';
        self.ron[string.end - 1] = b' ';
    }

    /// Writes a string without the escapes that RON does not have. What it gets shorter by, it gets as spaces behind it.
    fn unescape(&mut self, string: Range<usize>) -> Result<(), Fault> {
        let json = &self.json[string.clone()];
        if json.contains('\\') {
            let text: String = serde_json::from_str(json)
                .map_err(|error| Fault::new(string.clone(), reason_of(&error)))?;
            // Never longer: what is escaped here was so before, with as many bytes.
            let text = text.replace('\\', "\\\\").replace('"', "\\\"");
            let place = &mut self.ron[string];
            place.fill(b' ');
            let bytes = text.as_bytes();
            place[0] = b'"';
            place[1..=bytes.len()].copy_from_slice(bytes);
            place[bytes.len() + 1] = b'"';
        }
        Ok(())
    }
}

fn reason_of(error: &serde_json::Error) -> String {
    let message = error.to_string();
    let reason = message.split(" at line ").next().unwrap_or_default();
    format!("expected JSON, found a fault: {reason}")
}

fn is_name(text: &str) -> bool {
    let is_part = |byte: u8| byte.is_ascii_alphanumeric() || byte == b'_';
    !text.is_empty() && text.bytes().all(is_part)
}

/// Makes a byte a space, unless it ends a line.
fn blank_out(byte: &mut u8) {
    if *byte != b'\n' {
        *byte = b' ';
    }
}

#[cfg(test)]
mod tests;
