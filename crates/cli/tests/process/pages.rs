//! Runs the commands of the pages as they are printed.
//!
//! Each page runs by itself, with its blocks in order, in a folder with the scenes and pages of the repository. A block
//! of `sh` must end with exit code 0, or with N after a line `<!-- exit: N -->`. A block of `text` right after it is
//! its output: `…` stands for anything within a line, a line `…` for any number of lines. A block after `<!-- file:
//! NAME -->` is written to that file. `<!-- not run: REASON -->` marks placeholders and other programs, `<!-- not
//! output -->` other text. Blocks written by a measuring command, between `<!-- measured: NAME -->` and `<!-- end -->`,
//! are not run.

use std::env;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::thread;

use crate::folder::{Folder, text};

/// A fenced block of a page.
#[derive(Debug, PartialEq)]
struct Block {
    /// The number of the line of its fence, from 1.
    line: usize,
    language: String,
    /// The comment on the line before the fence, without its `<!--` and `-->`.
    note: Option<String>,
    text: String,
    /// Whether at most one line of prose separates it from the previous block.
    follows: bool,
}

impl Block {
    /// The rest of a note that begins with `word`.
    fn noted(&self, word: &str) -> Option<&str> {
        self.note.as_deref()?.strip_prefix(word).map(str::trim)
    }
}

/// The fenced blocks of a page.
fn blocks(page: &str) -> Vec<Block> {
    let mut blocks = Vec::new();
    let mut open: Option<Block> = None;
    let mut last_line = "";
    let mut prose = 0;
    let mut is_measured = false;
    for (index, line) in page.lines().enumerate() {
        let fence = line.trim_start().strip_prefix("```");
        match (open.as_mut(), fence) {
            (None, Some(language)) => {
                let note = last_line.trim().strip_prefix("<!--");
                let note = note.and_then(|note| note.strip_suffix("-->"));
                open = Some(Block {
                    line: index + 1,
                    language: language.trim().to_owned(),
                    note: note.map(|note| note.trim().to_owned()),
                    text: String::new(),
                    follows: !blocks.is_empty() && prose - usize::from(note.is_some()) <= 1,
                });
            }
            (Some(_), Some(_)) => {
                blocks.extend(open.take().filter(|_| !is_measured));
                prose = 0;
            }
            (Some(block), None) => {
                block.text += line;
                block.text.push('\n');
            }
            (None, None) => {
                prose += usize::from(!line.trim().is_empty());
                is_measured =
                    line.starts_with("<!-- measured:") || is_measured && line != "<!-- end -->";
            }
        }
        last_line = line;
    }
    blocks
}

/// Whether a line matches the line on a page, in which `…` stands for anything.
fn line_matches(shown: &str, printed: &str) -> bool {
    let mut parts = shown.trim_end().split('…');
    let first = parts.next().unwrap_or_default();
    let Some(mut rest) = printed.trim_end().strip_prefix(first) else {
        return false;
    };
    let parts: Vec<&str> = parts.collect();
    let Some((last, between)) = parts.split_last() else {
        return rest.is_empty();
    };
    for part in between {
        let Some(at) = rest.find(part) else {
            return false;
        };
        rest = &rest[at + part.len()..];
    }
    rest.ends_with(last)
}

/// Whether lines match those on a page, where a line `…` stands for any number of lines.
fn lines_match(shown: &[&str], printed: &[&str]) -> bool {
    match shown.split_first() {
        None => printed.is_empty(),
        Some((&"…", shown)) => {
            (0..=printed.len()).any(|skipped| lines_match(shown, &printed[skipped..]))
        }
        Some((line, shown)) => printed.split_first().is_some_and(|(first, printed)| {
            line_matches(line, first) && lines_match(shown, printed)
        }),
    }
}

fn repository() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

fn copy(from: &Path, to: &Path) {
    if from.is_dir() {
        fs::create_dir_all(to).unwrap();
        for entry in fs::read_dir(from).unwrap() {
            let name = entry.unwrap().file_name();
            copy(&from.join(&name), &to.join(&name));
        }
    } else {
        fs::copy(from, to).unwrap();
    }
}

/// Whether a line is the progress of a command, which slow machines print.
fn is_progress(line: &str) -> bool {
    let percent = line.split_once("% done").map(|parts| parts.0);
    percent.is_some_and(|percent| percent.parse::<u32>().is_ok())
}

/// Runs a script with `marbles` in its path, and returns its output and its exit code.
fn run(folder: &Path, script: &str) -> (String, i32) {
    let script = script.replace("cargo run --release -- ", "marbles ");
    let program = Path::new(env!("CARGO_BIN_EXE_marbles")).parent().unwrap();
    let path = env::var_os("PATH").unwrap_or_default();
    let all = [program.to_owned()]
        .into_iter()
        .chain(env::split_paths(&path));
    let output = Command::new("bash")
        .args([
            "-e",
            "-o",
            "pipefail",
            "-c",
            &format!("exec 2>&1\n{script}"),
        ])
        .current_dir(folder)
        .env("PATH", env::join_paths(all).unwrap())
        .stdin(Stdio::null())
        .output()
        .unwrap();
    (text(&output.stdout), output.status.code().unwrap_or(-1))
}

/// Runs a page, and returns the differences from the page.
fn faults(name: &str, page: &str) -> Vec<String> {
    let folder = Folder::new();
    for name in ["ball.ron", "roll.ron"] {
        fs::remove_file(folder.path(name)).unwrap();
    }
    for name in ["scenes", "docs"] {
        copy(&repository().join(name), &folder.path(name));
    }
    let mut faults = Vec::new();
    let mut printed: Option<String> = None;
    for block in blocks(page) {
        let place = format!("{name}:{}", block.line);
        if let Some(file) = block.noted("file:") {
            fs::write(folder.path(file), &block.text).unwrap();
            printed = None;
        } else if block
            .noted("not run:")
            .is_some_and(|reason| !reason.is_empty())
        {
            printed = None;
        } else if block.language == "sh" {
            let expected = block.noted("exit:").map_or(0, |code| code.parse().unwrap());
            let (output, code) = run(&folder.0, &block.text);
            if code != expected {
                faults.push(format!(
                    "{place}: expected the exit code {expected}, found {code}:\n{output}"
                ));
            }
            printed = Some(output);
        } else {
            // Only a text right after a script is its output.
            let output = printed.take();
            let is_output = block.language == "text" && block.follows && block.note.is_none();
            let Some(output) = output.filter(|_| is_output) else {
                continue;
            };
            let shown: Vec<&str> = block.text.lines().collect();
            let lines: Vec<&str> = output.lines().filter(|line| !is_progress(line)).collect();
            if !lines_match(&shown, &lines) {
                faults.push(format!(
                    "{place}: the page shows\n{}\nand the command prints\n{output}",
                    block.text
                ));
            }
        }
    }
    faults
}

#[test]
fn pages_print_commands_that_work() {
    let docs = repository().join("docs");
    let mut pages: Vec<PathBuf> = fs::read_dir(docs)
        .unwrap()
        .map(|entry| entry.unwrap().path())
        .filter(|path| path.extension().is_some_and(|ending| ending == "md"))
        .collect();
    pages.push(repository().join("README.md"));
    pages.sort();
    let faults: Vec<String> = thread::scope(|scope| {
        let runs: Vec<_> = pages
            .iter()
            .map(|path| {
                scope.spawn(move || {
                    let name = path.file_name().unwrap().to_string_lossy();
                    faults(&name, &fs::read_to_string(path).unwrap())
                })
            })
            .collect();
        runs.into_iter()
            .flat_map(|run| run.join().unwrap())
            .collect()
    });
    assert!(faults.is_empty(), "{}", faults.join("\n"));
}

#[test]
fn a_page_that_is_wrong_is_found_out() {
    let ball = "A scene:\n\n<!-- file: a.ron -->\n```ron\n(image: (width: 8, height: 8), lens: Fov(40), camera: Free(), ambient: 1)\n```\n\n";
    let render = "```sh\ncargo run --release -- render a.ron\n```\n\n";
    let output = "It prints:\n\n```text\n…\na.png: error <= 0.0e+00 (bound), 0 over, … s\n```\n";
    let right = format!("{ball}{render}{output}");
    assert_eq!(faults("page", &right), Vec::<String>::new());
    let wrong = [
        (right.replace("0 over", "1 over"), "the page shows"),
        (right.replace("… s", "…\n…\nend"), "the page shows"),
        (
            right.replace("file: a.ron", "file: b.ron"),
            "expected the exit code 0",
        ),
        (
            right.replace("render a.ron", "render a.ron --tolerance"),
            "expected the exit code 0",
        ),
        (
            right.replace("```sh", "<!-- exit: 2 -->\n```sh"),
            "expected the exit code 2",
        ),
    ];
    for (page, message) in wrong {
        let found = faults("page", &page);
        assert!(
            found.iter().any(|fault| fault.contains(message)),
            "{page}: {found:?}"
        );
    }
    for note in ["<!-- not run: SCENE is yours -->", "<!-- exit: 2 -->"] {
        let page = format!("{note}\n```sh\nmarbles render SCENE\n```\n");
        assert_eq!(faults("page", &page), Vec::<String>::new());
    }
}
