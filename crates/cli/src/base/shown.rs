//! Names of files in messages.

use std::path::Path;

use marbles_scene::harmless;

/// Names that can be shown in messages.
pub(crate) trait Shown {
    /// The name without control characters: it cannot control a terminal or end the line.
    fn shown(&self) -> String;
}

impl Shown for Path {
    fn shown(&self) -> String {
        harmless(&self.to_string_lossy())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn control_characters_are_escaped() {
        for (name, expected) in [
            ("a b/ö.ron", "a b/ö.ron"),
            ("a\nb\r\tc", "a\\u{a}b\\u{d}\\u{9}c"),
            ("\u{0}\u{7}\u{1b}[1m", "\\u{0}\\u{7}\\u{1b}[1m"),
            ("\u{7f}\u{9b}31m", "\\u{7f}\\u{9b}31m"),
            ("txt.\u{202e}gnp", "txt.\\u{202e}gnp"),
        ] {
            assert_eq!(Path::new(name).shown(), expected, "{name:?}");
        }
    }

    /// Names that are not Unicode show a replacement character for each invalid sequence.
    #[test]
    #[cfg(unix)]
    fn other_bytes_are_replaced() {
        use std::ffi::OsStr;
        use std::os::unix::ffi::OsStrExt;

        let name = OsStr::from_bytes(b"a\x9b31m\xff.png");
        assert_eq!(Path::new(name).shown(), "a\u{fffd}31m\u{fffd}.png");
    }
}
