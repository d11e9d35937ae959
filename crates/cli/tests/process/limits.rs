//! Limits of the system: file descriptors, disk space, signals.

use std::process::{Child, Command, Output, Stdio};
use std::thread;

use crate::folder::{Folder, assert_complete, code, is_picture, text};
use crate::signals::{is_ignored, signal, wait_until};

/// Runs `marbles` in a shell after another command.
fn after(folder: &Folder, before: &str, arguments: &str) -> Command {
    let marbles = folder.marbles(arguments);
    let mut command = Command::new("sh");
    command
        .args(["-c", &format!("{before}; exec \"$@\""), "sh"])
        .arg(marbles.get_program())
        .args(marbles.get_args())
        .current_dir(&folder.0);
    command
}

fn run(folder: &Folder, before: &str, arguments: &str) -> Output {
    after(folder, before, arguments).output().unwrap()
}

/// Begins such a run, and waits for its first picture in `out`.
fn begin(folder: &Folder, before: &str, arguments: &str) -> Child {
    let child = after(folder, before, arguments)
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .spawn()
        .unwrap();
    wait_until("a picture", || {
        folder.path("out").exists() && !folder.names("out").is_empty()
    });
    child
}

/// Asserts that all pictures are complete; returns their number.
fn whole_pictures(folder: &Folder, name: &str) -> usize {
    let names = folder.names(name);
    for picture in &names {
        assert!(is_picture(picture), "{picture}");
        assert_complete(&folder.path(name).join(picture));
    }
    names.len()
}

#[test]
fn without_descriptors_nothing_is_left_behind() {
    let mut failed = 0;
    for limit in 4..=20 {
        let folder = Folder::new();
        let arguments = "render roll.ron -o out/#.png --frames 1-5 --size 9x9 --samples 1 -q";
        let output = run(&folder, &format!("ulimit -n {limit}"), arguments);
        let errors = text(&output.stderr);
        let expected = i32::from(!errors.is_empty());
        assert_eq!(code(&output), expected, "{limit}: {errors}");
        if expected == 1 {
            failed += 1;
            assert!(errors.contains("too many open files"), "{limit}: {errors}");
        }
        let written = whole_pictures(&folder, "out");
        assert!(expected == 1 || written == 5, "{limit}: {written}");
    }
    assert!(failed > 0, "no limit was low enough");
}

#[test]
fn a_file_that_may_not_grow_is_an_error() {
    let folder = Folder::new();
    for arguments in [
        "render ball.ron -o out/a.npy --size 200x200 --samples 1",
        "render ball.ron -o out/a.exr --size 400x400 --samples 1 --float",
        "new out/scene.ron",
    ] {
        // In blocks of 512 or of 1024 bytes.
        let limit = if arguments.starts_with("new") { 0 } else { 8 };
        let output = run(&folder, &format!("ulimit -f {limit}"), arguments);
        let errors = text(&output.stderr);
        assert_eq!(code(&output), 1, "{arguments}: {errors}");
        assert!(errors.contains("file too large"), "{arguments}: {errors}");
        assert!(!folder.path("out").exists() || folder.names("out").is_empty());
    }
}

#[test]
fn signals_that_are_ignored_at_the_start_stay_ignored() {
    let folder = Folder::new();
    let arguments = "render roll.ron -o out/#.png --frames 1-40 --size 60x60 --samples 12";
    for (before, ignored) in [("trap '' HUP", "HUP"), ("trap '' INT", "INT")] {
        let mut child = begin(&folder, before, arguments);
        signal(ignored, &child);
        assert_eq!(child.wait().unwrap().code(), Some(0), "{ignored}");
        assert_eq!(whole_pictures(&folder, "out"), 40);
        std::fs::remove_dir_all(folder.path("out")).unwrap();
    }
    // Without that, they end it.
    for sent in ["HUP", "TERM"] {
        if is_ignored(sent) {
            eprintln!("skipped: SIG{sent} is ignored from the start");
            continue;
        }
        let mut child = begin(&folder, "true", &arguments.replace("1-40", "1-4000"));
        signal(sent, &child);
        assert_eq!(child.wait().unwrap().code(), Some(130), "{sent}");
        whole_pictures(&folder, "out");
        std::fs::remove_dir_all(folder.path("out")).unwrap();
    }
}

#[test]
fn what_is_ended_while_it_writes_leaves_nothing() {
    let folder = Folder::new();
    for (name, region) in [("a", "0,0,3000,1500"), ("b", "0,1500,3000,1500")] {
        let arguments = format!(
            "render ball.ron -o {name}.exr --float --samples 1 --size 3000x3000 --region {region}"
        );
        let output = folder.run(&arguments);
        assert_eq!(code(&output), 0, "{}", text(&output.stderr));
    }
    for (arguments, name, ended) in [
        ("merge o.exr a.exr b.exr", "TERM", 130),
        ("compare a.exr a.exr --diff o.exr", "TERM", 130),
        // What a process sends itself where memory ends.
        ("merge o.exr a.exr b.exr", "ABRT", 1),
        ("compare a.exr a.exr --diff o.exr", "ABRT", 1),
    ] {
        let mut child = folder
            .marbles(arguments)
            .stdout(Stdio::null())
            .stderr(Stdio::null())
            .spawn()
            .unwrap();
        // While it is empty it may not be known yet: a process that aborts in that moment leaves it.
        let is_begun = || {
            let file = folder.path("o.exr.tmp").metadata();
            file.is_ok_and(|file| file.len() > 0)
        };
        wait_until("a temporary file", || {
            is_begun() || folder.path("o.exr").exists()
        });
        signal(name, &child);
        let code = child.wait().unwrap().code();
        let is_expected = code == Some(0) || code == Some(ended);
        assert!(is_expected, "{arguments}: {code:?}");
        assert!(!folder.path("o.exr.tmp").exists(), "{arguments}");
        let _ = std::fs::remove_file(folder.path("o.exr"));
    }
}

/// However many threads are requested, only useful ones are started, or there is an error.
#[test]
fn threads_without_memory_are_an_error() {
    let folder = Folder::new();
    let processors = thread::available_parallelism().map_or(1, usize::from);
    let most = 64.max(4 * processors);
    let cannot_start = format!("marbles: cannot start {most} rendering threads: ");
    let mut codes = Vec::new();
    for kilobytes in (100_000..8_000_000).step_by(390_000) {
        let arguments = "render ball.ron -o a.png --size 64x64 --samples 1 --threads 1024";
        let output = run(&folder, &format!("ulimit -v {kilobytes}"), arguments);
        let errors = text(&output.stderr);
        let code = output.status.code();
        assert!(matches!(code, Some(0 | 1)), "{kilobytes}: {errors}");
        let is_short = errors.contains(" memory") && !errors.contains(" rendering threads");
        // A thread that begins without memory may say so before.
        let cannot_start = errors.lines().any(|line| line.starts_with(&cannot_start));
        let refused = cannot_start || is_short;
        assert_eq!(code == Some(1), refused, "{kilobytes}: {errors}");
        codes.push(code);
    }
    assert!(codes.contains(&Some(0)) && codes.contains(&Some(1)));
}
