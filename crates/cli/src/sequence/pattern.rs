//! File names with a place for the frame number: `####`, `%04d` or `{frame:04}`.

use std::ffi::{OsStr, OsString};
use std::ops::Range;
use std::path::{Path, PathBuf};

use crate::base::scene_name::scene_name;
use crate::base::shown::Shown;
use crate::files::standard_output;
use crate::formats::encoding::Format;

/// The largest number of digits. More are a typing error, and no file system allows them.
const MOST_DIGITS: usize = 100;
/// Digits of the frame number in default names.
const DEFAULT_DIGITS: usize = 4;

/// The names of the files of a picture or a sequence.
///
/// The place for the frame number is searched for only in the file name; folders are used as they are written.
#[derive(Clone, Debug, Eq, PartialEq)]
pub(crate) struct Pattern {
    folder: PathBuf,
    before: OsString,
    /// The width to which a frame number is padded with zeros; `None` if there is no place for it.
    digits: Option<usize>,
    after: OsString,
    format: Format,
}

impl Pattern {
    /// Parses the user's pattern, or returns an error.
    pub(crate) fn parse(path: &Path) -> Result<Self, String> {
        let wrong_ending = || {
            if let Some(reason) = why_no_video(path) {
                return reason;
            }
            let path = path.shown();
            format!(
                "expected a file name that ends in .png, .exr, .npy, .npz, .tif, .tiff, .apng, .gif or \
                 .webp, or `-` for the standard output (`exr:-` for another format than PNG), found `{path}`"
            )
        };
        if let Some(ending) = standard_output::format_of(path) {
            let format = Format::of(&format!(".{ending}")).ok_or_else(wrong_ending)?;
            return Ok(Self {
                folder: PathBuf::new(),
                before: standard_output::path().into_os_string(),
                digits: None,
                after: OsString::new(),
                format,
            });
        }
        // A trailing slash means a folder, which `file_name` would overlook.
        let bytes = path.as_os_str().as_encoded_bytes();
        let name = path.file_name();
        let name = name.filter(|name| bytes.ends_with(name.as_encoded_bytes()));
        let name = name.ok_or_else(wrong_ending)?.to_str().ok_or_else(|| {
            let path = path.shown();
            format!("expected a file name in UTF-8, found `{path}`")
        })?;
        let format = Format::of(name).ok_or_else(wrong_ending)?;

        let mut found: Option<(Range<usize>, usize)> = None;
        let mut start = 0;
        while start < name.len() {
            let Some((length, digits)) = place(&name[start..])? else {
                start += name[start..].chars().next().map_or(1, char::len_utf8);
                continue;
            };
            let here = start..start + length;
            if let Some((first, _)) = found {
                let (first, second) = (&name[first], &name[here]);
                return Err(format!(
                    "expected one place for the frame number, found `{first}` and `{second}`"
                ));
            }
            start = here.end;
            found = Some((here, digits));
        }
        let (place, digits) = found.unzip();
        let place = place.unwrap_or(name.len()..name.len());
        Ok(Self {
            folder: path.parent().map(Path::to_owned).unwrap_or_default(),
            before: name[..place.start].into(),
            digits,
            after: name[place.end..].into(),
            format,
        })
    }

    /// Parses a pattern in which [`SCENE`] may stand for the name of the scene. This name becomes a part of the file
    /// names unchanged: nothing in it is a place for a number.
    pub(crate) fn of_scene(path: &Path, scene: &OsStr) -> Result<Self, String> {
        let pattern = Self::parse(path)?;
        Ok(Self {
            folder: with_scene(&pattern.folder, scene),
            before: with_scene(Path::new(&pattern.before), scene).into_os_string(),
            after: with_scene(Path::new(&pattern.after), scene).into_os_string(),
            ..pattern
        })
    }

    /// The default names: those of the scene, in the current folder.
    pub(crate) fn named_after(scene: &Path, numbered: bool) -> Self {
        let mut before = match scene_name(scene) {
            none if none.is_empty() => OsString::from("marbles"),
            name => name.to_owned(),
        };
        if numbered {
            before.push(".");
        }
        Self {
            folder: PathBuf::new(),
            before,
            digits: numbered.then_some(DEFAULT_DIGITS),
            after: ".png".into(),
            format: Format::Png,
        }
    }

    /// The name of a frame's file.
    pub(crate) fn path(&self, frame: i32) -> PathBuf {
        let mut name = self.before.clone();
        if let Some(digits) = self.digits {
            name.push(format!("{frame:0digits$}"));
        }
        name.push(&self.after);
        self.folder.join(name)
    }

    /// The format for the extension.
    pub(crate) fn format(&self) -> Format {
        self.format
    }

    /// Returns whether pictures go to the standard output.
    pub(crate) fn is_standard_output(&self) -> bool {
        standard_output::is(&self.path(0))
    }

    /// Returns whether different frames have different names.
    pub(crate) fn is_numbered(&self) -> bool {
        self.digits.is_some()
    }
}

/// The placeholder for the name of the scene.
pub(crate) const SCENE: &str = "{scene}";

/// Returns whether a folder or the file name contains the placeholder for the name of the scene.
pub(crate) fn has_place_for_scene(path: &Path) -> bool {
    let mut parts = path.iter().filter_map(OsStr::to_str);
    parts.any(|part| part.contains(SCENE))
}

/// The path with the name of the scene. Folders whose names are not UTF-8 contain no placeholder.
pub(crate) fn with_scene(path: &Path, scene: &OsStr) -> PathBuf {
    if !has_place_for_scene(path) {
        return path.to_owned();
    }
    let replaced = |part: &OsStr| match part.to_str() {
        None => part.to_owned(),
        Some(text) => {
            let mut pieces = text.split(SCENE);
            let mut name = OsString::from(pieces.next().unwrap_or_default());
            for piece in pieces {
                name.push(scene);
                name.push(piece);
            }
            name
        }
    };
    path.iter().map(replaced).collect()
}

/// What to do about the name of a video; `None` for other names.
fn why_no_video(path: &Path) -> Option<String> {
    const VIDEOS: [&str; 6] = ["mp4", "mov", "mkv", "avi", "webm", "m4v"];
    let ending = path.extension()?.to_str()?;
    let is_video = VIDEOS
        .iter()
        .any(|video| ending.eq_ignore_ascii_case(video));
    is_video.then(|| {
        let path = path.shown();
        format!(
            "`{path}` would be a video, which FFmpeg makes of frames: render with `-o 'frames/####.png'`, and then run \
             `ffmpeg -framerate 24 -i frames/%04d.png -c:v libx264 -crf 16 -pix_fmt yuv420p {path}`; or render a loop \
             for web pages with `-o NAME.webp`"
        )
    })
}

/// The place for the frame number at the start of `text`, if there is one: its length, and the width of the number.
fn place(text: &str) -> Result<Option<(usize, usize)>, String> {
    let refused = |length: usize| {
        let found = &text[..length];
        format!("expected a frame number such as ####, %04d or {{frame:04}}, found `{found}`")
    };
    let spelled = |length: usize, digits: &str| {
        // Without the leading 0 printf would pad with spaces.
        let width = match digits.strip_prefix('0') {
            None => digits.is_empty().then_some(0),
            Some("") => Some(0),
            Some(digits) => digits.parse().ok(),
        };
        match width {
            Some(width) if width <= MOST_DIGITS => Ok(Some((length, width))),
            _ => Err(refused(length)),
        }
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
            .ok_or_else(|| refused(length))?;
        return spelled(length, digits);
    }
    Ok(None)
}

#[cfg(test)]
mod tests;
