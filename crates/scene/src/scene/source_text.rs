//! The text of a scene: that of its file, or of the figure of a table; and values in it.

use std::borrow::Cow;
use std::fs::File as OpenFile;
use std::io::{ErrorKind, Read as _};
use std::path::{Path, PathBuf};

use super::Scene;
use super::other_file::{self, Kind};
use super::read::{BLOCK, LARGEST_FILE, STANDARD_INPUT, read_at_most, read_standard_input};
use crate::figure::Figure;
use crate::report::SceneError;
use crate::text::{self, Fault, is_json, reason, to_ron};

/// The text of a scene.
pub(super) struct TextOf {
    pub(super) text: String,
    /// The path to name in messages.
    pub(super) path: PathBuf,
    /// Whether the file is a table of particles, and the text that of its figure.
    pub(super) is_of_table: bool,
}

impl Scene {
    /// The text of the scene file at `path`, in RON or JSON; or of the figure of a table of particles, in RON. The scene is
    /// not checked.
    ///
    /// # Errors
    /// Refuses what is not a readable file of at most 1 GiB, or not text in UTF-8.
    pub fn text_of(path: &Path) -> Result<String, SceneError> {
        Ok(text_of(path, &Figure::default())?.text)
    }

    /// Returns whether the file at `path` is a table of particles.
    ///
    /// # Errors
    /// Refuses files that cannot be opened, and files of other kinds than scenes and tables.
    pub fn is_table(path: &Path) -> Result<bool, SceneError> {
        let refused = |reason: &str| Err(SceneError::unreadable(path, reason));
        if path.is_dir() {
            return refused("expected a table of particles, found a folder");
        }
        if !path.is_file() {
            return refused("no such file");
        }
        let mut head = Vec::new();
        let is_read = OpenFile::open(path).and_then(|file| file.take(BLOCK).read_to_end(&mut head));
        match (is_read, other_file::kind(path, &head)) {
            (Err(error), _) => refused(&reason(&error)),
            (Ok(_), Kind::Other(message)) => refused(&message),
            (Ok(_), kind) => Ok(matches!(kind, Kind::Table)),
        }
    }

    /// A scene's text in RON, in which every token of one in JSON stays at its place.
    ///
    /// # Errors
    /// Refuses text that begins with `{` and is not JSON; text in RON is not checked.
    pub fn text_in_ron(text: &str) -> Result<String, SceneError> {
        let shown = without_byte_order_mark(text);
        Ok(as_ron(shown, Path::new("scene.json"))?.into_owned())
    }

    /// A text in RON with `value` at a path such as `lights[0].toward`. A missing field is added to its structure.
    ///
    /// # Errors
    /// Returns what was expected in place of the path, a part of it, or the value: exactly one.
    ///
    /// # Example
    /// ```
    /// # use marbles_scene::Scene;
    /// let text = Scene::with_value("(lens: Fov(40), zoom: 1)", "zoom", "2");
    /// assert_eq!(text.as_deref(), Ok("(lens: Fov(40), zoom: 2)"));
    /// assert_eq!(Scene::value_in("(lens: Fov(40), zoom: 1)", "lens"), Some("Fov(40)"));
    /// ```
    pub fn with_value(text: &str, path: &str, value: &str) -> Result<String, String> {
        text::set(text, path, value)
    }

    /// The text of the value at a path of a text in RON; `None` where there is none.
    pub fn value_in<'t>(text: &'t str, path: &str) -> Option<&'t str> {
        text::value_at(text, path)
    }
}

/// The text of the scene file at `path`, or of the figure of a table.
pub(super) fn text_of(path: &Path, figure: &Figure) -> Result<TextOf, SceneError> {
    if path.is_dir() {
        let reason = "expected a scene file, found a folder";
        return Err(SceneError::unreadable(path, reason));
    }
    if other_file::is_named_pipe(path) {
        let reason = "expected a scene file, found a named pipe";
        return Err(SceneError::unreadable(path, reason));
    }
    let is_input = path == Path::new(STANDARD_INPUT);
    if !is_input && let Some(name) = table_name(path)? {
        return Ok(TextOf {
            text: figure.scene_text(path, &name),
            path: path.with_file_name(format!("{name} (its scene)")),
            is_of_table: true,
        });
    }
    let bytes = if is_input {
        read_standard_input()
    } else {
        read_at_most(path, LARGEST_FILE)
    };
    let bytes = bytes.map_err(|error| {
        let why = match error.kind() {
            ErrorKind::NotFound => "no such file",
            ErrorKind::PermissionDenied => "no permission to read this file",
            ErrorKind::FileTooLarge => "expected a scene file of at most 1 GiB, found a larger one",
            ErrorKind::OutOfMemory => "there is not enough memory to read this file",
            _ => &reason(&error),
        };
        SceneError::unreadable(path, why)
    })?;
    match other_file::kind(path, &bytes) {
        Kind::Scene => {}
        Kind::Table => {
            let message =
                "expected a scene, found a table that is not a regular file: save it as one";
            return Err(SceneError::unreadable(path, message));
        }
        Kind::Other(message) => return Err(SceneError::unreadable(path, &message)),
    }
    let text = str::from_utf8(&bytes).map_err(|error| error.valid_up_to());
    let text = text.and_then(|text| {
        text.strip_suffix('\0')
            .map_or(Ok(text), |text| Err(text.len()))
    });
    match text {
        Ok(text) => Ok(TextOf {
            text: text.to_owned(),
            path: path.to_owned(),
            is_of_table: false,
        }),
        Err(valid_up_to) => {
            let (valid, rest) = bytes.split_at(valid_up_to);
            let valid = without_byte_order_mark(str::from_utf8(valid).unwrap_or_default());
            let byte = rest.first().copied().unwrap_or_default();
            let expected = if byte == 0 { "text" } else { "text in UTF-8" };
            let message = format!("expected {expected}, found the byte 0x{byte:02x}");
            let fault = Fault::new(valid.len()..valid.len(), message);
            Err(SceneError::refused(path, valid, vec![fault]))
        }
    }
}

/// The name of the file at `path` if it is a table of particles; `None` if it is something else, or cannot be opened.
///
/// # Errors
/// Refuses a table whose name is not in UTF-8.
fn table_name(path: &Path) -> Result<Option<String>, SceneError> {
    if !path.is_file() {
        return Ok(None);
    }
    let mut head = Vec::new();
    let is_read = OpenFile::open(path).and_then(|file| file.take(BLOCK).read_to_end(&mut head));
    if is_read.is_err() {
        return Ok(None);
    }
    match other_file::kind(path, &head) {
        Kind::Table => {}
        Kind::Scene => return Ok(None),
        // Of all its bytes, those that tell this may not be read: no more than up to the first of 0.
        Kind::Other(message) => return Err(SceneError::unreadable(path, &message)),
    }
    let name = path.file_name().and_then(|name| name.to_str());
    let name = name.ok_or_else(|| {
        let message = "expected a file name in UTF-8, as a scene names a table";
        SceneError::unreadable(path, message)
    })?;
    Ok(Some(name.to_owned()))
}

/// The text of a scene in RON, where every token is at its place.
pub(super) fn as_ron<'t>(text: &'t str, path: &Path) -> Result<Cow<'t, str>, SceneError> {
    if !is_json(text) {
        return Ok(Cow::Borrowed(text));
    }
    let ron = to_ron(text);
    let ron = ron.map_err(|fault| SceneError::refused(path, text, vec![fault]))?;
    Ok(Cow::Owned(ron))
}

/// The text behind a byte order mark.
pub(super) fn without_byte_order_mark(text: &str) -> &str {
    text.strip_prefix('\u{feff}').unwrap_or(text)
}

#[cfg(test)]
mod tests;
