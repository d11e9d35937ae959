//! File names with a place for the frame number: `####`, `%04d` or `{frame:04}`.

use std::ffi::{OsStr, OsString};
use std::path::{Path, PathBuf};

use thiserror::Error;

use crate::formats::encoding::Format;

/// More digits than this are a slip of the keyboard, and no file system takes them.
const MOST_DIGITS: usize = 100;
/// Digits of the frame number in names that the user left out.
const DEFAULT_DIGITS: usize = 4;

/// The names of the files of a picture or a sequence.
///
/// The place for the frame number is looked for in the file name only; folders are taken as they
/// are written.
#[derive(Clone, Debug, Eq, PartialEq)]
pub(crate) struct Pattern {
    folder: PathBuf,
    before: OsString,
    number: Option<Number>,
    after: OsString,
    format: Format,
}

/// A frame number, padded with zeros to `digits` characters.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
struct Number {
    digits: usize,
}

/// A reason why a text is no pattern.
#[derive(Clone, Debug, Eq, Error, PartialEq)]
pub(crate) enum PatternError {
    #[error("expected a file name that ends in .png, .apng or .exr, found `{0}`")]
    Ending(String),
    #[error("expected a file name in UTF-8, found `{0}`")]
    Encoding(String),
    #[error("expected a frame number such as ####, %04d or {{frame:04}}, found `{0}`")]
    Number(String),
    #[error("expected one place for the frame number, found `{0}` and `{1}`")]
    SecondNumber(String, String),
}

impl Pattern {
    /// Reads a pattern as users write it.
    pub(crate) fn parse(path: &Path) -> Result<Self, PatternError> {
        let shown = || path.display().to_string();
        // A trailing slash means a folder, which `file_name` would overlook.
        let name = path
            .file_name()
            .filter(|name| {
                path.as_os_str()
                    .as_encoded_bytes()
                    .ends_with(name.as_encoded_bytes())
            })
            .ok_or_else(|| PatternError::Ending(shown()))?
            .to_str()
            .ok_or_else(|| PatternError::Encoding(shown()))?;
        let format = Format::of(name).ok_or_else(|| PatternError::Ending(shown()))?;

        let mut found: Option<(usize, Token)> = None;
        let mut start = 0;
        while start < name.len() {
            match token(&name[start..])? {
                Some(token) => {
                    if let Some((first, length)) = found.map(|(at, token)| (at, token.length)) {
                        return Err(PatternError::SecondNumber(
                            name[first..first + length].to_owned(),
                            name[start..start + token.length].to_owned(),
                        ));
                    }
                    found = Some((start, token));
                    start += token.length;
                }
                None => start += name[start..].chars().next().map_or(1, char::len_utf8),
            }
        }
        let (before, after) = match found {
            Some((at, token)) => (&name[..at], &name[at + token.length..]),
            None => (name, ""),
        };
        Ok(Self {
            folder: path.parent().map(Path::to_owned).unwrap_or_default(),
            before: before.into(),
            number: found.map(|(_, token)| token.number),
            after: after.into(),
            format,
        })
    }

    /// The names of a user who gave none: those of the scene, in the current folder.
    pub(crate) fn named_after(scene: &Path, numbered: bool) -> Self {
        let mut before = scene
            .file_stem()
            .unwrap_or(OsStr::new("marbles"))
            .to_owned();
        if numbered {
            before.push(".");
        }
        Self {
            folder: PathBuf::new(),
            before,
            number: numbered.then_some(Number {
                digits: DEFAULT_DIGITS,
            }),
            after: ".png".into(),
            format: Format::Png,
        }
    }

    /// The name of a frame's file.
    pub(crate) fn path(&self, frame: i32) -> PathBuf {
        let mut name = self.before.clone();
        if let Some(Number { digits }) = self.number {
            name.push(format!("{frame:0digits$}"));
        }
        name.push(&self.after);
        self.folder.join(name)
    }

    /// The format that the ending asks for.
    pub(crate) fn format(&self) -> Format {
        self.format
    }

    /// Returns whether different frames have different names.
    pub(crate) fn is_numbered(&self) -> bool {
        self.number.is_some()
    }
}

/// A place for the frame number, as written.
#[derive(Clone, Copy)]
struct Token {
    length: usize,
    number: Number,
}

/// The token at the start of `text`, if there is one.
fn token(text: &str) -> Result<Option<Token>, PatternError> {
    let spelled = |length: usize, digits: &str| {
        let refused = || PatternError::Number(text[..length].to_owned());
        // Without the leading 0 printf would pad with spaces.
        let digits = match digits.strip_prefix('0') {
            None if digits.is_empty() => 0,
            None => return Err(refused()),
            Some("") => 0,
            Some(digits) => digits.parse().map_err(|_| refused())?,
        };
        if digits > MOST_DIGITS {
            return Err(refused());
        }
        Ok(Some(Token {
            length,
            number: Number { digits },
        }))
    };
    if text.starts_with('#') {
        let length = text.len() - text.trim_start_matches('#').len();
        return spelled(length, &format!("0{length}"));
    }
    if let Some(rest) = text.strip_prefix('%') {
        let digits = rest.len() - rest.trim_start_matches(|c: char| c.is_ascii_digit()).len();
        if rest[digits..].starts_with('d') {
            return spelled(digits + 2, &rest[..digits]);
        }
    }
    if let Some(rest) = text.strip_prefix("{frame") {
        let length = text.find('}').map_or(text.len(), |at| at + 1);
        if rest.starts_with('}') {
            return spelled(length, "");
        }
        let digits = rest
            .strip_prefix(':')
            .and_then(|rest| rest.split_once('}'))
            .map(|(digits, _)| digits)
            .ok_or_else(|| PatternError::Number(text[..length].to_owned()))?;
        return spelled(length, digits);
    }
    Ok(None)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn name(pattern: &str, frame: i32) -> String {
        let pattern = Pattern::parse(Path::new(pattern)).unwrap();
        pattern.path(frame).into_os_string().into_string().unwrap()
    }

    fn refusal(pattern: &str) -> String {
        Pattern::parse(Path::new(pattern)).unwrap_err().to_string()
    }

    #[test]
    fn every_spelling_takes_the_frame() {
        assert_eq!(name("a.####.png", 7), "a.0007.png");
        assert_eq!(name("a#.png", 12), "a12.png");
        assert_eq!(name("out/%04d.exr", 7), "out/0007.exr");
        assert_eq!(name("%d.png", 7), "7.png");
        assert_eq!(name("{frame:04}_a.png", 7), "0007_a.png");
        assert_eq!(name("a{frame}.png", 7), "a7.png");
        assert_eq!(name("%012d.png", 7), "000000000007.png");
        assert_eq!(name("####.png", 123_456), "123456.png");
    }

    #[test]
    fn negative_frames_are_padded_as_printf_does() {
        for pattern in ["####.png", "%04d.png", "{frame:04}.png"] {
            assert_eq!(name(pattern, -5), "-005.png");
        }
    }

    #[test]
    fn names_without_a_number_stay() {
        let pattern = Pattern::parse(Path::new("50% {off}.png")).unwrap();
        assert!(!pattern.is_numbered());
        assert_eq!(pattern.path(3), Path::new("50% {off}.png"));
    }

    #[test]
    fn folders_are_taken_as_written() {
        assert_eq!(name("shot#1/%d/{frame}.png", 2), "shot#1/%d/2.png");
        assert_eq!(name("/a.png/../ä#é.png", 2), "/a.png/../ä2é.png");
    }

    #[test]
    fn endings_choose_the_format() {
        let format = |name: &str| Pattern::parse(Path::new(name)).unwrap().format();
        assert_eq!(format("a.PNG"), Format::Png);
        assert_eq!(format("a.b.Exr"), Format::Exr);
        assert_eq!(format("a.png.apng"), Format::Apng);
        for wrong in ["a.jpg", "a", "png", "out/", "out.png/", "a.png.", ".."] {
            assert!(
                refusal(wrong).contains("ends in .png, .apng or .exr"),
                "{wrong}"
            );
        }
    }

    #[test]
    fn refuses_numbers_that_cannot_be() {
        for wrong in [
            "%4d.png",
            "{frame:4}.png",
            "{frame:x}.png",
            "{frame.png",
            "%0999d.png",
        ] {
            assert!(
                refusal(wrong).contains("####, %04d or {frame:04}"),
                "{wrong}"
            );
        }
        assert_eq!(
            refusal("#a_%04d.png"),
            "expected one place for the frame number, found `#` and `%04d`"
        );
    }

    #[test]
    fn names_come_from_the_scene() {
        let scene = Path::new("scenes/two#balls.ron");
        let still = Pattern::named_after(scene, false);
        assert_eq!(still.path(1), Path::new("two#balls.png"));
        let sequence = Pattern::named_after(scene, true);
        assert_eq!(sequence.path(-3), Path::new("two#balls.-003.png"));
    }
}
