//! Sequences of clouds that change over time.

use std::fs;
use std::process::Child;
use std::thread::sleep;
use std::time::Duration;

use crate::folder::{BALL, Folder, code, is_picture, text};
use crate::sequences::{contents, differences, random, start};

const STEPS: usize = 12;

/// A step of forty spheres as extended XYZ.
fn step(step: usize) -> String {
    let mut state = 3;
    let rows: String = (0..40)
        .map(|_| {
            let [x, y, z, speed] = [0; 4].map(|_| random(&mut state) - 0.5);
            let x = 9.0 * x + speed * step as f64;
            format!("{x:.4} {:.4} {:.4} 0.5 {speed:.3}\n", 9.0 * y, 9.0 * z)
        })
        .collect();
    format!("40\nProperties=pos:R:3:radius:R:1:speed:R:1\n{rows}")
}

fn scene(cloud: &str, animation: &str) -> String {
    format!(
        "(image: (width: 60, height: 40), lens: Fov(40), camera: Orbit(target: (0, 0, 0), radius: 25),
          lights: [Directional(toward: (1, 1, -1))],
          clouds: [(file: {cloud}, value: \"speed\", range: (-0.5, 0.5))]{animation})"
    )
}

/// A folder with `run.ron`, which reads all steps from one file, and `files.ron`, which reads one file per step.
fn folder() -> Folder {
    let folder = Folder::new();
    let animation = format!(", animation: Turntable(frames: {STEPS})");
    let steps: Vec<String> = (0..STEPS).map(step).collect();
    fs::write(folder.path("run.xyz"), steps.concat()).unwrap();
    for (index, step) in steps.iter().enumerate() {
        fs::write(folder.path(&format!("step.{index:03}.xyz")), step).unwrap();
    }
    let all = scene("\"run.xyz\", frames: All", &animation);
    fs::write(folder.path("run.ron"), all).unwrap();
    fs::write(
        folder.path("files.ron"),
        scene("\"step.###.xyz\"", &animation),
    )
    .unwrap();
    for index in 0..STEPS {
        let still = scene(&format!("\"step.{index:03}.xyz\""), &animation);
        fs::write(folder.path(&format!("still{index}.ron")), still).unwrap();
    }
    folder
}

#[test]
fn each_frame_is_that_of_a_scene_with_its_step_alone() {
    let folder = folder();
    let render = |scene: &str, more: &str| {
        let output = folder.run(&format!("render {scene}.ron {more}"));
        assert_eq!(code(&output), 0, "{}", text(&output.stderr));
    };
    render("run", "-o run/##.exr");
    render("files", "-o files/##.exr --threads 1");
    render("run", "-o backward/##.exr --frames 12-1:-1");
    for index in 0..STEPS {
        let more = format!("-o stills/##.exr --frames {}", index + 1);
        render(&format!("still{index}"), &more);
    }
    let expected = contents(&folder, "stills");
    assert_eq!(expected.len(), STEPS);
    let none: [&str; 0] = [];
    for name in ["run", "files", "backward"] {
        assert_eq!(
            differences(&expected, &contents(&folder, name)),
            none,
            "{name}"
        );
    }
}

#[test]
fn series_are_resumed_and_shared_step_by_step() {
    let folder = folder();
    let render = |out: &str| format!("render run.ron -o {out}/##.png --samples 12");
    assert_eq!(code(&folder.run(&render("whole"))), 0);
    let resume = render("killed") + " --skip-existing --quiet";
    let mut state = 5;
    for _ in 0..12 {
        let mut child = start(&folder, &resume);
        sleep(Duration::from_millis(150).mul_f64(random(&mut state)));
        child.kill().unwrap();
        child.wait().unwrap();
    }
    assert_eq!(code(&folder.run(&resume)), 0);
    let shared = render("shared") + " --skip-existing --threads 1";
    let children: Vec<Child> = (0..4).map(|_| start(&folder, &shared)).collect();
    for child in children {
        let output = child.wait_with_output().unwrap();
        assert_eq!(code(&output), 0, "{}", text(&output.stderr));
    }
    let whole = contents(&folder, "whole");
    assert_eq!(whole.len(), STEPS);
    let none: [&str; 0] = [];
    for name in ["killed", "shared"] {
        assert_eq!(
            differences(&whole, &contents(&folder, name)),
            none,
            "{name}"
        );
    }
    // A step that has changed is rendered again, and no other one.
    let steps: Vec<String> = (0..STEPS).map(step).collect();
    let changed = steps
        .concat()
        .replacen(&steps[4], &steps[4].replace(" 0.5 ", " 0.6 "), 1);
    fs::write(folder.path("run.xyz"), changed).unwrap();
    let output = folder.run(&(render("whole") + " --skip-existing"));
    let lines = text(&output.stdout);
    let written: Vec<&str> = lines
        .lines()
        .filter(|line| line.starts_with("whole/") && !line.contains(": skipped"))
        .collect();
    assert_eq!(written.len(), 1, "{lines}");
    assert!(written[0].starts_with("whole/05.png"), "{lines}");
}

#[test]
fn a_step_that_is_broken_does_not_stop_the_others() {
    let folder = folder();
    fs::write(folder.path("step.007.xyz"), "40\nProperties=pos:R:3\nx\n").unwrap();
    let output = folder.run("render files.ron -o out/##.png");
    assert_eq!(code(&output), 1);
    let errors = text(&output.stderr);
    assert!(
        errors.contains("step.007.xyz:2:1: expected a column `radius`"),
        "{errors}"
    );
    assert!(
        errors.ends_with("11 of 12 frames written, failed: 8\n"),
        "{errors}"
    );
    assert_eq!(folder.names("out").len(), STEPS - 1);
}

/// If another program overwrites a table, the sequence ends with an error: its frames would show two different tables.
#[test]
fn a_table_that_changes_ends_the_sequence() {
    const FRAMES: usize = 400;
    let folder = Folder::new();
    let steps: String = (0..FRAMES).map(step).collect();
    let other = steps.replace(" 0.5 ", " 0.6 ");
    for name in ["run", "same"] {
        fs::write(folder.path(&format!("{name}.xyz")), &steps).unwrap();
        let all = scene(&format!("\"{name}.xyz\", frames: All"), "");
        fs::write(folder.path(&format!("{name}.ron")), all).unwrap();
    }
    let child = start(
        &folder,
        "render run.ron -o run/###.png --size 300x200 --threads 1",
    );
    while folder
        .names("run")
        .iter()
        .filter(|name| is_picture(name))
        .count()
        < 4
    {
        sleep(Duration::from_millis(1));
    }
    fs::write(folder.path("run.xyz"), other).unwrap();
    let output = child.wait_with_output().unwrap();
    let errors = text(&output.stderr);
    assert_eq!(code(&output), 1, "{errors}");
    assert_eq!(errors.matches("found a change").count(), 1, "{errors}");
    let written = folder.names("run");
    assert!(written.len() < FRAMES, "{}", written.len());
    let frames = written.len();
    let render = format!("render same.ron -o same/###.png --size 300x200 --frames 1-{frames}");
    assert_eq!(code(&folder.run(&render)), 0);
    let none: [&str; 0] = [];
    assert_eq!(
        differences(&contents(&folder, "same"), &contents(&folder, "run")),
        none
    );
}

/// A named pipe without a writer would block forever.
#[cfg(unix)]
#[test]
fn pipes_with_names_are_refused() {
    let folder = Folder::new();
    let made = std::process::Command::new("mkfifo")
        .arg(folder.path("pipe.csv"))
        .status();
    if !made.is_ok_and(|status| status.success()) {
        return;
    }
    fs::write(folder.path("pipe.ron"), scene("\"pipe.csv\"", "")).unwrap();
    for (arguments, expected) in [
        (
            "check pipe.ron",
            "it is a pipe or a device, but marbles reads tables more than once",
        ),
        ("render pipe.ron -o a.png", "it is a pipe or a device"),
        (
            "check pipe.csv",
            "expected a scene file, found a named pipe",
        ),
    ] {
        let output = folder.run(arguments);
        let errors = text(&output.stderr);
        assert_eq!(
            (code(&output), errors.contains(expected)),
            (2, true),
            "{errors}"
        );
    }
}

/// Every command prints warnings, and they are errors with `--strict`.
#[test]
fn what_is_left_out_of_a_series_is_said() {
    let folder = Folder::new();
    for index in [1, 2, 4] {
        fs::write(folder.path(&format!("step.{index:03}.xyz")), step(index)).unwrap();
    }
    fs::write(folder.path("step.5.xyz"), step(5)).unwrap();
    fs::write(folder.path("steps.ron"), scene("\"step.###.xyz\"", "")).unwrap();
    for arguments in [
        "check steps.ron",
        "check --json steps.ron",
        "render steps.ron -o a/#.png",
    ] {
        let output = folder.run(arguments);
        let errors = text(&output.stderr);
        assert_eq!(code(&output), 0, "{errors}");
        for expected in [
            "step.###.xyz: 1 file with a similar name, not shown: \"step.5.xyz\"",
            "step.###.xyz: files are missing between the numbers 2 and 4",
        ] {
            assert!(errors.contains(expected), "{arguments}: {errors}");
        }
        assert_eq!(
            code(&folder.run(&format!("{arguments} --strict"))),
            2,
            "{arguments}"
        );
    }
}

#[test]
fn settings_and_several_scenes_are_those_of_edited_files() {
    let folder = folder();
    let edited = scene("\"run.xyz\"", "").replace("radius: 25", "radius: 30");
    fs::write(folder.path("edited.ron"), edited).unwrap();
    fs::write(folder.path("plain.ron"), scene("\"run.xyz\"", "")).unwrap();
    let run = |arguments: &str| {
        let output = folder.run(arguments);
        (code(&output), text(&output.stderr))
    };
    assert_eq!(run("render edited.ron -q -o a/edited.png").0, 0);
    assert_eq!(
        run("render plain.ron -q -o b/edited.png --set camera.radius=30").0,
        0
    );
    assert_eq!(run("render edited.ron plain.ron -q -o c/{scene}.png").0, 0);
    assert_eq!(folder.read("a/edited.png"), folder.read("b/edited.png"));
    assert_eq!(folder.read("a/edited.png"), folder.read("c/edited.png"));
    assert_eq!(folder.names("c"), ["edited.png", "plain.png"]);
    let (status, errors) = run("check plain.ron --set camera.radius=-30");
    assert_eq!(status, 2);
    let expected = "plain.ron:1:90: expected a radius greater than 0, found -30";
    assert!(errors.contains(expected), "{errors}");
    let (status, errors) = run("check plain.ron --set lights[1].toward=1");
    let expected = "plain.ron: --set lights[1].toward: expected [1], found those from [0] to [0]";
    assert_eq!((status, errors.contains(expected)), (2, true), "{errors}");
    assert_eq!(run("render edited.ron plain.ron -o a.png").0, 2);
    let (status, errors) = run("render a/x.ron b/x.ron");
    let expected = "two scenes are called `x`, and would share their files";
    assert_eq!((status, errors.contains(expected)), (2, true), "{errors}");
    let (status, errors) = run("render edited.ron plain.ron -o {scene}.png --legend legend.svg");
    let expected = "legend.svg: several scenes need {scene} in the file name";
    assert_eq!((status, errors.contains(expected)), (2, true), "{errors}");
    // One that is missing does not stop the others, unless that is wanted.
    let missing = "render missing.ron edited.ron -q -o d/{scene}.png";
    assert_eq!(run(&format!("{missing} --fail-fast")).0, 2);
    assert!(folder.names("d").is_empty());
    assert_eq!(run(missing).0, 2);
    assert_eq!(folder.names("d"), ["edited.png"]);
    // The first of twelve frames is shown.
    let (status, errors) = run("check plain.ron");
    assert_eq!(
        (status, errors.contains("the first frame of several")),
        (0, true),
        "{errors}"
    );
    assert_eq!(run("check plain.ron --strict").0, 2);
}

/// Names of scenes are not patterns, and no two scenes share a file.
#[test]
fn names_of_scenes_stay_apart() {
    let folder = Folder::new();
    for name in ["a####", "a0001", "a%04d", "b{frame}", "c", "c1"] {
        let scene = BALL.replacen(
            "lights:",
            "animation: Keyframes(frames: (1, 11)), lights:",
            1,
        );
        fs::write(folder.path(&format!("{name}.ron")), scene).unwrap();
    }
    let scenes = "a####.ron a0001.ron a%04d.ron b{frame}.ron";
    let output = folder.run(&format!(
        "render {scenes} --frames 1 --size 9x9 -q -o o/{{scene}}.png"
    ));
    assert_eq!(code(&output), 0, "{}", text(&output.stderr));
    assert_eq!(
        folder.names("o"),
        ["a####.png", "a%04d.png", "a0001.png", "b{frame}.png"]
    );
    // Frame 11 of `c` and frame 1 of `c1` would be one file.
    let output = folder.run("render c.ron c1.ron --frames 1,11 --size 9x9 -q -o p/{scene}#.png");
    assert_eq!(code(&output), 2);
    let expected = "c11.png: the pictures of c.ron and of c1.ron would have this name";
    assert!(
        text(&output.stderr).contains(expected),
        "{}",
        text(&output.stderr)
    );
    assert_eq!(folder.names("p"), ["c1.png", "c11.png"]);
}

/// Names that are not UTF-8 remain distinct although they look alike in messages.
#[test]
#[cfg(unix)]
fn names_that_are_no_text_stay_apart() {
    use std::ffi::{OsStr, OsString};
    use std::os::unix::ffi::OsStrExt;

    let folder = Folder::new();
    let names = [&b"a\xfe.ron"[..], b"a\xff.ron"].map(OsStr::from_bytes);
    for name in names {
        if fs::write(folder.0.join(name), BALL).is_err() {
            eprintln!("skipped: names of files have to be UTF-8 here");
            return;
        }
    }
    let mut command = folder.marbles("render --size 9x9 -q -o o/{scene}.png");
    let output = command.args(names).output().unwrap();
    assert_eq!(code(&output), 0, "{}", text(&output.stderr));
    let entries = fs::read_dir(folder.path("o")).unwrap();
    let mut found: Vec<OsString> = entries.map(|entry| entry.unwrap().file_name()).collect();
    found.sort();
    assert_eq!(
        found,
        [&b"a\xfe.png"[..], b"a\xff.png"].map(OsStr::from_bytes)
    );
}
