//! Files that other programs' authors wrote, as they are.
//!
//! `tests/real_files.py` fetches small packages of its list from the registry of Python, once, into the folder of the
//! build; the test is skipped where there is no Python, or no registry. `docs/real_files.md` is written by the same
//! script, from all packages.

use std::fs;
use std::path::Path;
use std::process::Command;

use crate::folder::{code, text};

#[test]
fn files_of_others_are_rendered_as_they_are() {
    /// The largest package that is fetched, in megabytes.
    const MOST: &str = "0.5";
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("real-files");
    fs::create_dir_all(&folder).unwrap();
    let script = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../tests/real_files.py");
    let mut python = Command::new("python3");
    python.arg(script).arg(env!("CARGO_BIN_EXE_marbles"));
    python.arg(&folder).args(["--most", MOST]);
    let output = match python.output() {
        Ok(output) => output,
        Err(error) => {
            eprintln!("skipped: no python3: {error}");
            return;
        }
    };
    let result = text(&output.stdout);
    assert_eq!(code(&output), 0, "{result}{}", text(&output.stderr));
    if result.starts_with("skipped") {
        eprintln!("{result}");
    } else {
        assert!(!result.starts_with("0 of"), "{result}");
    }
}
