//! Valid files, before they are altered.

use std::fs;
use std::path::{Path, PathBuf};

/// A file.
pub(super) struct Seed {
    pub(super) name: String,
    pub(super) bytes: Vec<u8>,
}

/// How often a scene in JSON is among the scenes.
const IN_JSON: usize = 20;

/// The repository.
pub(super) fn repository() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..")
}

/// Scenes of users, slow scenes, and refused scenes; all are read as if they were in `scenes`.
pub(super) fn scenes() -> Vec<Seed> {
    // Of the latter there are ten times as many.
    let whole = ["scenes", "scenes/original"].into_iter().cycle().take(20);
    let folders = whole.chain(["tests/seeds/scenes", "tests/broken"]);
    let all = folders.flat_map(|folder| files(folder, "ron"));
    let in_json = std::iter::repeat_n("tests/seeds/scenes", IN_JSON);
    let all = all.chain(in_json.flat_map(|folder| files(folder, "json")));
    // Longer ones would take most of the time.
    all.filter(|seed| seed.bytes.len() < 8_000).collect()
}

/// Small tables of all formats.
pub(super) fn tables() -> Vec<Seed> {
    files("tests/seeds/tables", "").collect()
}

/// Small pictures in all formats, written by other programs.
pub(super) fn pictures() -> Vec<Seed> {
    files("tests/seeds/pictures", "").collect()
}

/// The files of this folder.
pub(super) fn in_folder(folder: &Path) -> Vec<Seed> {
    read(folder, "").collect()
}

/// The files of a folder of the repository, in order, with an extension, or with any extension.
fn files(folder: &str, ending: &str) -> impl Iterator<Item = Seed> {
    read(&repository().join(folder), ending)
}

/// The files of a folder, in order, with an extension, or with any extension.
fn read<'e>(folder: &Path, ending: &'e str) -> impl Iterator<Item = Seed> + use<'e> {
    let entries = fs::read_dir(folder).expect("the folder is there");
    let paths = entries.map(|entry| entry.expect("entries can be read").path());
    let is_wanted =
        |path: &PathBuf| ending.is_empty() || path.extension().is_some_and(|it| it == ending);
    let mut paths: Vec<PathBuf> = paths
        .filter(|path| path.is_file() && is_wanted(path))
        .collect();
    paths.sort();
    paths.into_iter().map(|path| Seed {
        name: path
            .file_name()
            .unwrap_or_default()
            .to_string_lossy()
            .into_owned(),
        bytes: fs::read(&path).expect("the file can be read"),
    })
}
