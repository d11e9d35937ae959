//! Files written by the authors of other programs, unchanged.
//!
//! `tests/real_files.py` downloads the small packages of its list once, from the Python registry, into the build
//! folder. The test is skipped if there is no Python, or no registry. The same script writes `docs/real_files.md`, from
//! all packages.

use std::fs;
use std::path::Path;
use std::process::Command;

use crate::folder::{code, text};

#[test]
fn files_of_others_are_rendered_as_they_are() {
    /// The largest package that is downloaded, in megabytes.
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
