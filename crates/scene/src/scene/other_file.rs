//! Files that are no scenes: tables of particles, and files of other kinds.

use std::path::Path;

use crate::table::{Format, is_compressed};
use crate::text::token;

/// The kind of a file that a command was given.
#[derive(Clone, Debug, Eq, PartialEq)]
pub(super) enum Kind {
    /// A scene, or a file of which nothing tells what else it is.
    Scene,
    /// A table of particles.
    Table,
    /// A file that is neither: the message about it.
    Other(String),
}

/// The kind of the file at `path` that begins with these bytes.
pub(super) fn kind(path: &Path, head: &[u8]) -> Kind {
    let text = match str::from_utf8(head) {
        Ok(text) => text,
        Err(error) => str::from_utf8(&head[..error.valid_up_to()]).unwrap_or_default(),
    };
    let text = text.strip_prefix('\u{feff}').unwrap_or(text);
    let start = &text[token::skip_trivia(text, 0)..];
    let is_named_so = path.extension().is_some_and(|ending| ending == "ron");
    // Zstandard's first byte is a parenthesis, and so may that of a table's title be.
    let is_table = is_compressed(head) || !is_named_so && Format::is_certain(path, head);
    let is_open = start.starts_with(['(', '{']) && !is_table;
    if is_open || is_named_so && start.starts_with('#') {
        return Kind::Scene;
    }
    match Format::evident(path, head) {
        Some(Ok(_)) => Kind::Table,
        // What has this ending says that it is a scene.
        _ if is_named_so => Kind::Scene,
        Some(Err(foreign)) => {
            let (kind, remedy) = (foreign.kind, foreign.remedy);
            Kind::Other(format!(
                "expected a scene or a table of particles, found {kind}: {remedy}, and render that table"
            ))
        }
        None if is_compressed(head) => Kind::Table,
        None => Kind::Scene,
    }
}

/// Says whether a pipe with a name is at `path`: opening it would wait for somebody who writes to it.
pub(super) fn is_named_pipe(path: &Path) -> bool {
    #[cfg(unix)]
    {
        use std::fs;
        use std::os::unix::fs::FileTypeExt;
        let is_pipe = fs::metadata(path).is_ok_and(|metadata| metadata.file_type().is_fifo());
        // Those of a shell, `<(…)`, have no place in any folder.
        is_pipe && fs::canonicalize(path).is_ok()
    }
    #[cfg(not(unix))]
    {
        let _ = path;
        false
    }
}
