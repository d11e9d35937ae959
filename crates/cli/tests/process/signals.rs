//! Processes that get signals, and pipes that nobody reads.

use std::io::Read;
use std::process::{Child, Command, Stdio};
use std::thread::sleep;
use std::time::{Duration, Instant};

use crate::folder::{Folder, assert_complete, is_picture};

pub(crate) fn wait_until(what: &str, condition: impl Fn() -> bool) {
    let started = Instant::now();
    while !condition() {
        assert!(
            started.elapsed() < Duration::from_secs(60),
            "waited for {what}"
        );
        sleep(Duration::from_millis(5));
    }
}

/// Sends the process the signal with this name.
pub(crate) fn signal(name: &str, child: &Child) {
    let arguments = [format!("-{name}"), child.id().to_string()];
    let kill = Command::new("kill").args(arguments).status();
    assert!(kill.unwrap().success());
}

/// Whether processes started by this one ignore the signal with this name, as under `nohup` (HUP) and in the background
/// of a script (INT).
pub(crate) fn is_ignored(name: &str) -> bool {
    let command = format!("kill -{name} $$");
    let shell = Command::new("sh").args(["-c", &command]).status();
    shell.unwrap().success()
}

/// The name of a signal that ends processes.
pub(crate) fn ending() -> &'static str {
    if is_ignored("INT") { "TERM" } else { "INT" }
}

/// Asks the process to end, and waits; returns its exit code and the time.
pub(crate) fn interrupt(child: &mut Child) -> (Option<i32>, Duration) {
    let started = Instant::now();
    signal(ending(), child);
    let status = child.wait().unwrap();
    (status.code(), started.elapsed())
}

#[test]
fn a_killed_process_leaves_complete_pictures() {
    let folder = Folder::new();
    let mut child = folder
        .marbles("render roll.ron -o out/####.png --frames 1-60 --size 120x120 --samples 12")
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .spawn()
        .unwrap();
    let pictures = || {
        let names = folder.names("out").into_iter();
        names
            .filter(|name| is_picture(name))
            .collect::<Vec<String>>()
    };
    wait_until("pictures", || pictures().len() >= 5);
    child.kill().unwrap();
    child.wait().unwrap();
    let pictures = pictures();
    assert!(pictures.len() < 60, "killed too late to show anything");
    for picture in pictures {
        assert_complete(&folder.path("out").join(picture));
    }
}

#[test]
fn an_interrupted_process_ends_soon_and_cleans_up() {
    let folder = Folder::new();
    // In the middle of a sequence, and of a picture that takes longer than a second.
    for (samples, least) in [(30, 2), (200, 0)] {
        let out = format!("out{samples}");
        let mut child = folder
            .marbles(&format!(
                "render roll.ron -o {out}/####.png --frames 1-60 --size 150x150 --samples {samples}"
            ))
            .stdout(Stdio::null())
            .stderr(Stdio::piped())
            .spawn()
            .unwrap();
        wait_until("a start", || folder.path(&out).exists());
        wait_until("pictures", || folder.names(&out).len() >= least);
        sleep(Duration::from_millis(50));
        let (code, time) = interrupt(&mut child);
        assert_eq!(code, Some(130));
        assert!(time < Duration::from_secs(1), "{time:?}");

        let pictures = folder.names(&out);
        assert!(pictures.len() < 60, "interrupted too late to show anything");
        for picture in &pictures {
            assert!(is_picture(picture), "{picture}");
            assert_complete(&folder.path(&out).join(picture));
        }
        let mut messages = String::new();
        child.stderr.unwrap().read_to_string(&mut messages).unwrap();
        let last = format!("interrupted: {} of 60 frames written", pictures.len());
        assert!(messages.trim_end().ends_with(&last), "{messages}");
    }
}

/// A process whose results nobody reads: the pipe is full long before the last frame.
fn stuck(folder: &Folder) -> Child {
    // Long lines, so that it is full soon.
    let name = "n".repeat(200);
    let arguments =
        format!("render roll.ron -o out/{name}#.png --frames 1-9999 --size 1x1 --samples 1");
    let child = folder
        .marbles(&arguments)
        .stdout(Stdio::piped())
        .stderr(Stdio::null())
        .spawn()
        .unwrap();
    wait_until("a full pipe", || {
        let before = folder.names("out");
        sleep(Duration::from_secs(1));
        !before.is_empty() && folder.names("out") == before
    });
    child
}

#[test]
fn a_stuck_process_ends_soon_when_interrupted() {
    let folder = Folder::new();
    let (code, time) = interrupt(&mut stuck(&folder));
    assert_eq!(code, Some(130));
    assert!(time < Duration::from_secs(1), "{time:?}");
    let names = folder.names("out");
    assert!(names.len() < 9999, "the pipe did not fill");
    assert!(names.iter().all(|name| is_picture(name)));
}

/// However slow the machine, a process that does not finish earlier is not ended before the promised time.
#[test]
fn a_second_interrupt_hurries_a_stuck_process() {
    /// The least time that an interrupted process has for writing finished pictures.
    const GRACE: Duration = Duration::from_millis(700);
    const ATTEMPTS: u32 = 5;
    let folder = Folder::new();
    let name = ending();
    let is_hurried = || {
        let mut child = stuck(&folder);
        let started = Instant::now();
        // Two that come at once are one.
        while child.try_wait().unwrap().is_none() {
            signal(name, &child);
            sleep(Duration::from_millis(30));
        }
        let is_early = started.elapsed() < GRACE;
        assert_eq!(child.wait().unwrap().code(), Some(130));
        is_early
    };
    assert!((0..ATTEMPTS).any(|_| is_hurried()));
}

#[test]
fn a_closed_pipe_does_not_stop_the_work() {
    let folder = Folder::new();
    let mut child = folder
        .marbles("render roll.ron -o out/#.png --frames 1-9 --size 9x9")
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    drop(child.stdout.take());
    drop(child.stderr.take());
    assert_eq!(child.wait().unwrap().code(), Some(0));
    assert_eq!(folder.names("out").len(), 9);

    for arguments in ["check ball.ron", "--help"] {
        let mut child = folder
            .marbles(arguments)
            .stdout(Stdio::piped())
            .spawn()
            .unwrap();
        drop(child.stdout.take());
        assert_eq!(child.wait().unwrap().code(), Some(0));
    }
}
