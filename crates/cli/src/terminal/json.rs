//! JSON, as far as it is written here.

use std::fmt::Write;

/// A text as a string of JSON.
pub(crate) fn string(text: &str) -> String {
    let mut json = String::from('"');
    for letter in text.chars() {
        match letter {
            '"' => json.push_str("\\\""),
            '\\' => json.push_str("\\\\"),
            '\n' => json.push_str("\\n"),
            '\r' => json.push_str("\\r"),
            '\t' => json.push_str("\\t"),
            '\u{8}' => json.push_str("\\b"),
            '\u{c}' => json.push_str("\\f"),
            '\0'..' ' => {
                // Writing into a string cannot fail.
                let _ = write!(json, "\\u{:04x}", u32::from(letter));
            }
            _ => json.push(letter),
        }
    }
    json.push('"');
    json
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn strings_are_written_as_by_serde() {
        let controls: String = ('\0'..=' ').collect();
        for text in ["", "a \"b\" \\ c/d", "é 🎾 \u{7f}\u{2028}", &*controls] {
            assert_eq!(string(text), serde_json::to_string(text).unwrap());
        }
    }
}
