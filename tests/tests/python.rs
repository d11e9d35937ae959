//! Python scripts that compare files written by marbles with other programs.

use std::ffi::OsStr;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::sync::{Mutex, PoisonError};

/// Set once packages are not available. Only one test at a time makes the virtual environment.
static UNAVAILABLE: Mutex<bool> = Mutex::new(false);

/// Runs a script of this folder with packages from PyPI, fails if the script fails, and returns its output.
///
/// The packages are installed once, in a virtual environment in Cargo's folder for temporary files. If there is no
/// Python, or a package is not available, the script is skipped with a note on stderr, and there is no output.
pub(crate) fn run(script: &str, packages: &[&str], arguments: &[&Path]) -> Option<String> {
    let mut unavailable = UNAVAILABLE.lock().unwrap_or_else(PoisonError::into_inner);
    let python = match *unavailable {
        true => None,
        false => python_with(packages),
    };
    *unavailable = python.is_none();
    drop(unavailable);
    let Some(python) = python else {
        skipped(
            script,
            "there is no Python 3 with venv, or no package index",
        );
        return None;
    };
    let script = Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("tests")
        .join(script);
    let output = Command::new(python).arg(&script).args(arguments).output();
    let output = output.expect("Python starts");
    let text = |bytes: &[u8]| String::from_utf8_lossy(bytes).into_owned();
    let (out, err) = (text(&output.stdout), text(&output.stderr));
    assert!(output.status.success(), "{}\n{out}{err}", script.display());
    Some(out)
}

#[expect(
    clippy::print_stderr,
    reason = "a test that this machine cannot run says so"
)]
fn skipped(script: &str, reason: &str) {
    eprintln!("skipped: {script}: {reason}");
}

/// The interpreter of an environment with these packages.
fn python_with(packages: &[&str]) -> Option<PathBuf> {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("python");
    let bin = if cfg!(windows) { "Scripts" } else { "bin" };
    let python = folder.join(bin).join("python");
    let installed = folder.join(format!("has-{}", packages.join("-")));
    if installed.exists() {
        return Some(python);
    }
    let succeeds = |program: &OsStr, arguments: &[&str]| {
        let mut command = Command::new(program);
        command.args(arguments).stdin(Stdio::null());
        command.output().is_ok_and(|output| output.status.success())
    };
    let has_pip = |python: &Path| succeeds(python.as_os_str(), &["-m", "pip", "--version"]);
    let place = folder.to_str()?;
    if !has_pip(&python) && !succeeds(OsStr::new("python3"), &["-m", "venv", place]) {
        return None;
    }
    // Without a network this ends within seconds.
    let install = "-m pip install --quiet --retries 0 --timeout 10 --only-binary :all:";
    let mut arguments: Vec<&str> = install.split(' ').collect();
    arguments.extend(packages);
    if !succeeds(python.as_os_str(), &arguments) {
        return None;
    }
    fs::write(&installed, "").ok()?;
    Some(python)
}
