//! What ARCHITECTURE.md says of the code that a test can tell: that its files exist, and the table of methods.

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..")
}

/// All files below a folder, and all folders, as paths that begin with a slash; but for what is built or hidden.
fn paths(folder: &Path, name: &str, found: &mut BTreeSet<String>) {
    for entry in fs::read_dir(folder).unwrap() {
        let entry = entry.unwrap();
        let file_name = entry.file_name().into_string().unwrap();
        if file_name.starts_with('.') || file_name == "target" {
            continue;
        }
        let name = format!("{name}/{file_name}");
        if entry.file_type().unwrap().is_dir() {
            paths(&entry.path(), &name, found);
        }
        found.insert(name);
    }
}

/// Returns whether a word between backticks names a file or a folder.
fn is_path(word: &str) -> bool {
    let may_be_in_path =
        |letter: char| letter.is_ascii_alphanumeric() || matches!(letter, '_' | '/' | '.' | '-');
    let extension = Path::new(word).extension();
    let is_file = extension.is_some_and(|extension| {
        ["rs", "md", "sh", "py"]
            .iter()
            .any(|known| extension == *known)
    });
    let is_folder = word.contains('/') && extension.is_none();
    word.chars().all(may_be_in_path) && !word.starts_with(['/', '.', '-']) && (is_file || is_folder)
}

#[test]
fn paths_that_the_document_names_exist() {
    let document = fs::read_to_string(root().join("ARCHITECTURE.md")).unwrap();
    let mut found = BTreeSet::new();
    paths(&root(), "", &mut found);
    let named: BTreeSet<&str> = document
        .split('`')
        .skip(1)
        .step_by(2)
        .filter(|word| is_path(word))
        .collect();
    assert!(named.len() > 100, "{named:?}");
    let exists = |word: &str| {
        let end = format!("/{}", word.trim_end_matches('/'));
        found.iter().any(|path| path.ends_with(&end))
    };
    let missing: Vec<&&str> = named.iter().filter(|word| !exists(word)).collect();
    assert!(missing.is_empty(), "{missing:?}");
}

/// The rows of the table of methods in a document whose lines may begin with these characters.
fn rows<'a>(document: &'a str, prefix: &str) -> Vec<&'a str> {
    let lines = document
        .lines()
        .map(|line| line.strip_prefix(prefix).unwrap_or(line));
    let table = lines.skip_while(|line| !line.starts_with("| pixels, or method |"));
    table.take_while(|line| line.starts_with('|')).collect()
}

#[test]
fn the_table_of_methods_is_that_of_the_code() {
    let document = fs::read_to_string(root().join("ARCHITECTURE.md")).unwrap();
    let code = fs::read_to_string(root().join("crates/core/src/exact/ladder.rs")).unwrap();
    let rows = (rows(&document, ""), rows(&code, "//! "));
    assert!(rows.0.len() > 10, "{rows:?}");
    assert_eq!(rows.0, rows.1);
}
