//! The name of a scene or a table, from which default names of files are made.

use std::ffi::OsStr;
use std::path::Path;

use marbles_scene::{COMPRESSED_ENDINGS, STANDARD_INPUT};

/// The name of the file at `path` without its extension, and without that of a compression; `scene` for the standard input.
pub(crate) fn scene_name(path: &Path) -> &OsStr {
    if path == Path::new(STANDARD_INPUT) {
        return OsStr::new("scene");
    }
    let stem = path.file_stem().unwrap_or_default();
    let ending = path.extension().unwrap_or_default();
    let is_compressed = COMPRESSED_ENDINGS
        .iter()
        .any(|known| ending.eq_ignore_ascii_case(known));
    match is_compressed {
        true => Path::new(stem).file_stem().unwrap_or(stem),
        false => stem,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_have_no_endings() {
        for (path, name) in [
            ("out/ball.ron", "ball"),
            ("water.xyz", "water"),
            ("-", "scene"),
            ("water.xyz.gz", "water"),
            ("run.0005.csv.ZST", "run.0005"),
            ("water.pdb.bz2", "water"),
            ("water", "water"),
            ("water.gz", "water"),
            ("..", ""),
        ] {
            assert_eq!(scene_name(Path::new(path)), name, "{path}");
        }
    }
}
