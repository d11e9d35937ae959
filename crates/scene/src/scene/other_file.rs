//! Files that are no scenes, and what to do with them.

use std::path::Path;

use crate::table::Format;
use crate::text::{quoted, token};

/// Tells the kind of a file at `path` with these bytes that is no scene, and what to do; `None` where it may be one.
pub(super) fn explain(path: &Path, bytes: &[u8]) -> Option<String> {
    let text = match str::from_utf8(bytes) {
        Ok(text) => text,
        Err(error) => str::from_utf8(&bytes[..error.valid_up_to()]).unwrap_or_default(),
    };
    let text = text.strip_prefix('\u{feff}').unwrap_or(text);
    let start = &text[token::skip_trivia(text, 0)..];
    let is_named_so = path.extension().is_some_and(|ending| ending == "ron");
    if start.starts_with('(') || is_named_so && start.starts_with('#') {
        return None;
    }
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    match Format::evident(path, bytes)? {
        Ok(format) => {
            let (kind, file) = (format.name(), quoted(&name));
            Some(format!(
                "expected a scene, found a table ({kind}). A scene names the table, for example \
                 `(image: (width: 800, height: 600), lens: Fov(30), camera: Frame(), ambient: 0.3, \
                 lights: [Directional(toward: (-1, 1, -1))], clouds: [(file: {file})])`; save this next to it as `scene.ron`, and render that"
            ))
        }
        // What has this ending says that it is a scene.
        Err(_) if is_named_so => None,
        Err(foreign) => {
            let (kind, remedy) = (foreign.kind, foreign.remedy);
            Some(format!(
                "expected a scene, found {kind}: {remedy}, and name the table in a scene: `clouds: [(file: …)]`"
            ))
        }
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
