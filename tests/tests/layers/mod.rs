//! Imports go in one direction.
//!
//! `ARCHITECTURE.md` lists the layers of each crate, from the bottom, in blocks of this form:
//!
//! ````text
//! ```layers
//! core: numeric ← model ← picture, hit ← search
//!     ← render
//! scene: text ← animation
//! ```
//! ````
//!
//! A layer is a folder or a file at the top of the crate's `src`, without its extension. In `a ← b` the layer `b` may
//! use `a`; layers separated by a comma do not use each other. A line without a name and a colon continues the previous
//! line. Every folder and file except for `lib.rs` and `main.rs` must be in the list, so that it stays up to date.
//!
//! The test reads the code without its tests and refuses
//!
//! - an import of a layer that is not to the left of its own, and any import of `lib.rs`;
//! - a cycle of files that import each other.
//!
//! An import is a `use` or a path in the code. It leads to the file that defines the name, through all re-exports. A
//! file with modules of its own may re-export their names; this is an import only if its code uses the name. Macros
//! that need no import are not detected.
//!
//! This folder needs only `std`, so you can run it on any checkout within seconds:
//!
//! ```text
//! rustc --edition 2024 --test tests/tests/layers/mod.rs -o layers
//! MARBLES_LAYERS_ROOT=ANOTHER_CHECKOUT ./layers
//! ```
//!
//! With `MARBLES_LAYERS_ROOT`, every crate with a line is checked, otherwise those of [`CRATES`].

mod items;
mod order;
mod rules;
mod tokens;
mod tree;

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::{env, fs};

use order::Layers;
use tree::Tree;

/// The crates whose imports go in one direction.
const CRATES: &[&str] = &["core", "scene", "cli"];

/// The Rust files below `folder`, by their paths, which start with `prefix`.
fn sources(folder: &Path, prefix: &str, files: &mut BTreeMap<String, String>) {
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        let name = path.file_name().unwrap().to_str().unwrap();
        let name_below = format!("{prefix}{name}");
        if path.is_dir() {
            sources(&path, &format!("{name_below}/"), files);
        } else if name.ends_with(".rs") {
            files.insert(name_below, fs::read_to_string(&path).unwrap());
        }
    }
}

#[test]
fn imports_run_one_way() {
    let given = env::var_os("MARBLES_LAYERS_ROOT").map(PathBuf::from);
    let own = || Path::new(option_env!("CARGO_MANIFEST_DIR").unwrap_or("tests")).join("..");
    let root = given.clone().unwrap_or_else(own);
    let document = fs::read_to_string(root.join("ARCHITECTURE.md")).unwrap();
    let all = order::layers(&document).unwrap();
    let tried: Vec<&str> = match given {
        Some(_) => all.keys().map(String::as_str).collect(),
        None => CRATES.to_vec(),
    };
    let mut faults = Vec::new();
    for name in tried {
        let folder = format!("crates/{name}/src");
        let layers: &Layers = all.get(name).expect("a line in ARCHITECTURE.md");
        let mut files = BTreeMap::new();
        sources(&root.join(&folder), "", &mut files);
        let tree = Tree::new(&files).unwrap();
        let found = rules::faults(&tree, layers);
        faults.extend(found.into_iter().map(|fault| format!("{folder}: {fault}")));
    }
    let count = faults.len();
    assert!(
        faults.is_empty(),
        "{count} faults\n\n{}",
        faults.join("\n\n")
    );
}
