//! Sequences that are killed, resumed, or rendered by several processes, and sequences that fail in the middle.

use std::fs;
use std::process::{Child, Command, Output, Stdio};
use std::thread::sleep;
use std::time::Duration;

use exr::meta::MetaData;

use crate::folder::{Folder, assert_complete, code, is_picture, text};
use crate::signals::{signal, wait_until};

/// A turntable of three balls in color.
pub(crate) const TURNTABLE: &str = "(
    image: (width: 96, height: 64),
    lens: Fov(40),
    camera: Orbit(target: (0, 0, 0), radius: 9, elevation: 20),
    background: \"#202838\",
    lights: [Directional(toward: (-1, 1, -1))],
    materials: { \"candy\": (albedo: \"#d02840\", highlight: (strength: 0.5, shininess: 40)) },
    spheres: [(center: (0, 0, 0), radius: 1, material: \"candy\"),
              (center: (2, 0.5, 0), radius: 0.7), (center: (0, -1, 2), radius: 0.8)],
    animation: Turntable(frames: 60),
)
";

pub(crate) fn turntable() -> Folder {
    let folder = Folder::new();
    fs::write(folder.path("turn.ron"), TURNTABLE).unwrap();
    folder
}

/// The names in a folder, with the contents of the files.
pub(crate) fn contents(folder: &Folder, name: &str) -> Vec<(String, Vec<u8>)> {
    let names = folder.names(name).into_iter();
    let read = |file: String| {
        let bytes = folder.read(&format!("{name}/{file}"));
        (file, bytes)
    };
    names.map(read).collect()
}

/// Files that differ, or are in only one of two lists.
pub(crate) fn differences(one: &[(String, Vec<u8>)], other: &[(String, Vec<u8>)]) -> Vec<String> {
    let missing = |a: &[(String, Vec<u8>)], b: &[(String, Vec<u8>)]| -> Vec<String> {
        let new = a.iter().filter(|file| !b.contains(file));
        new.map(|(name, _)| name.clone()).collect()
    };
    [missing(one, other), missing(other, one)].concat()
}

/// Numbers from 0 to 1, the same in every run.
pub(crate) fn random(state: &mut u64) -> f64 {
    // Knuth's generator, whose high bits are good.
    *state = state
        .wrapping_mul(6_364_136_223_846_793_005)
        .wrapping_add(1_442_695_040_888_963_407);
    (*state >> 40) as f64 / (1_u64 << 24) as f64
}

pub(crate) fn start(folder: &Folder, arguments: &str) -> Child {
    let mut marbles = folder.marbles(arguments);
    let marbles = marbles.stdout(Stdio::piped()).stderr(Stdio::piped());
    marbles.spawn().unwrap()
}

#[test]
fn sequences_that_are_killed_and_resumed_are_those_that_are_not() {
    const KILLS: u32 = 20;
    const LONGEST: Duration = Duration::from_millis(250);
    let folder = turntable();
    let mut state = 7;
    for (ending, more, files) in [
        ("png", "", 60),
        ("exr", "", 60),
        ("npy", "--error-channel", 120),
    ] {
        let render =
            |out: &str| format!("render turn.ron -o {out}/##.{ending} --samples 16 {more}");
        let whole = format!("whole-{ending}");
        let output = folder.run(&render(&whole));
        assert_eq!(code(&output), 0, "{}", text(&output.stderr));

        let killed = format!("killed-{ending}");
        let resume = render(&killed) + " --skip-existing --quiet";
        for _ in 0..KILLS {
            let mut child = start(&folder, &resume);
            sleep(LONGEST.mul_f64(random(&mut state)));
            child.kill().unwrap();
            child.wait().unwrap();
        }
        let output = folder.run(&resume);
        assert_eq!(code(&output), 0, "{}", text(&output.stderr));
        let expected = contents(&folder, &whole);
        assert_eq!(expected.len(), files);
        let none: [&str; 0] = [];
        assert_eq!(differences(&expected, &contents(&folder, &killed)), none);
    }
}

#[test]
fn only_complete_frames_of_the_same_picture_are_skipped() {
    let folder = turntable();
    for ending in ["png", "exr", "npy"] {
        let render = format!("render turn.ron -o {ending}/#.{ending} --frames 1-6 --size 31x17");
        let skipped = |arguments: &str| {
            let output = folder.run(&format!("{render} --skip-existing {arguments}"));
            assert_eq!(code(&output), 0, "{}", text(&output.stderr));
            let lines = text(&output.stdout);
            let none = !lines.contains(": error <= ");
            let sum = "0 of 6 frames written, 6 skipped\n";
            assert_eq!(lines.ends_with(sum), none, "{lines}");
            let skipped = lines.lines().filter(|line| line.contains(": skipped"));
            let names = skipped.map(|line| line[ending.len() + 1..].split_once('.').unwrap().0);
            names.collect::<Vec<_>>().concat()
        };
        assert_eq!(skipped(""), "");
        let whole = contents(&folder, ending);
        assert_eq!(skipped("--threads 1"), "123456");

        let path = |frame: u32| folder.path(&format!("{ending}/{frame}.{ending}"));
        fs::remove_file(path(2)).unwrap();
        let third = fs::read(path(3)).unwrap();
        fs::write(path(3), &third[..third.len() - 1]).unwrap();
        fs::copy(path(5), path(4)).unwrap();
        fs::write(path(6), "").unwrap();
        assert_eq!(skipped(""), "15");
        assert!(contents(&folder, ending) == whole);

        if ending == "exr" {
            // One block fewer than there are: the file seems to end with an earlier one.
            let mut altered = fs::read(path(1)).unwrap();
            let name = b"chunkCount\0int\0";
            let place = altered.windows(name.len()).position(|at| at == name);
            let place = place.unwrap() + name.len() + 4;
            altered[place] -= 1;
            fs::write(path(1), altered).unwrap();
            assert_eq!(skipped(""), "23456");
            assert!(contents(&folder, ending) == whole);
        }

        for other in ["--tolerance 1e-2", "--alpha", "--samples 2"] {
            assert_eq!(skipped(other), "", "{other}");
            assert_eq!(skipped(other), "123456", "{other}");
        }
        // Written in another way, then another scene.
        assert_eq!(skipped(""), "");
        let comment = format!("// Three balls.\n{TURNTABLE}");
        fs::write(folder.path("turn.ron"), comment).unwrap();
        assert_eq!(skipped(""), "123456");
        let larger = TURNTABLE.replace("radius: 0.8", "radius: 0.81");
        fs::write(folder.path("turn.ron"), larger).unwrap();
        assert_eq!(skipped(""), "");
        fs::write(folder.path("turn.ron"), TURNTABLE).unwrap();
    }
}

#[test]
fn another_rate_matters_where_files_tell_it() {
    let folder = turntable();
    for (ending, expected) in [("png", 1), ("npy", 1), ("exr", 0)] {
        let render = format!("render turn.ron -o a.{ending} --frames 1 --size 9x9 --skip-existing");
        folder.run(&render);
        let output = folder.run(&format!("{render} --fps 30"));
        let lines = text(&output.stdout);
        assert_eq!(lines.matches("skipped").count(), expected, "{lines}");
    }
    let told = |more: &str| {
        let render = format!("render turn.ron -o told.exr --frames 1 --size 9x9 {more}");
        assert_eq!(code(&folder.run(&render)), 0);
        let meta = MetaData::read_from_file(folder.path("told.exr"), true).unwrap();
        meta.headers[0].own_attributes.frames_per_second
    };
    assert_eq!(told(""), Some((24, 1)));
    assert_eq!(told("--fps 29.97"), Some((30_000, 1001)));
    for refused in ["0", "-1", "NaN", "fast"] {
        let output = folder.run(&format!("render turn.ron --fps={refused}"));
        assert_eq!(code(&output), 2, "{refused}");
    }
}

#[test]
fn processes_share_a_sequence() {
    const PROCESSES: usize = 4;
    let folder = turntable();
    let render = |out: &str| format!("render turn.ron -o {out}/##.png --samples 12");
    assert_eq!(code(&folder.run(&render("alone"))), 0);
    let shared = render("shared") + " --skip-existing --threads 1";
    let children: Vec<Child> = (0..PROCESSES).map(|_| start(&folder, &shared)).collect();
    let mut rendered = 0;
    for child in children {
        let output = child.wait_with_output().unwrap();
        assert_eq!(code(&output), 0, "{}", text(&output.stderr));
        let lines = text(&output.stdout);
        let frames = lines.lines().filter(|line| line.starts_with("shared/"));
        let (skipped, written): (Vec<&str>, Vec<&str>) =
            frames.partition(|line| line.contains(": skipped"));
        assert_eq!(skipped.len() + written.len(), 60, "{lines}");
        rendered += written.len();
    }
    // What others are at is left for the end, and done a second time if it is not there then.
    assert!((60..120).contains(&rendered), "{rendered}");
    let alone = contents(&folder, "alone");
    let none: [&str; 0] = [];
    assert_eq!(differences(&alone, &contents(&folder, "shared")), none);
}

#[test]
fn what_a_living_process_writes_is_left_alone() {
    let folder = turntable();
    let render = "render turn.ron -o out/#.png --frames 1-2 --samples 60 --skip-existing";
    let mut living = start(&folder, render);
    wait_until("a start", || folder.path("out/1.png.tmp").exists());
    signal("STOP", &living);
    // As another that was killed leaves it.
    fs::write(folder.path("out/2.png.3.tmp"), "").unwrap();
    let output = folder.run(render);
    assert_eq!(code(&output), 0, "{}", text(&output.stderr));
    assert!(folder.path("out/1.png.tmp").exists());
    assert!(!folder.path("out/2.png.3.tmp").exists());
    let bytes = [1, 2].map(|frame| folder.read(&format!("out/{frame}.png")));
    signal("CONT", &living);
    assert_eq!(living.wait().unwrap().code(), Some(0));
    assert_eq!(folder.names("out"), ["1.png", "2.png"]);
    for (frame, bytes) in (1..).zip(bytes) {
        assert!(folder.read(&format!("out/{frame}.png")) == bytes);
    }
}

#[test]
fn a_folder_that_is_deleted_is_an_error() {
    let folder = turntable();
    let child = start(&folder, "render turn.ron -o out/##.png --samples 24");
    wait_until("pictures", || folder.names("out").len() >= 3);
    // Files may appear while it is being removed.
    wait_until("an end", || fs::remove_dir_all(folder.path("out")).is_ok());
    let output = child.wait_with_output().unwrap();
    assert_eq!(code(&output), 1);
    assert!(!folder.path("out").exists());
    let errors = text(&output.stderr);
    let reasons = errors.lines().filter(|line| line.starts_with("marbles: "));
    let reasons: Vec<&str> = reasons.collect();
    assert!((2..=3).contains(&reasons.len()), "{errors}");
    let (last, reasons) = reasons.split_last().unwrap();
    for reason in reasons {
        assert!(
            reason.ends_with(" the file: no such file or directory"),
            "{errors}"
        );
    }
    assert!(last.contains(" of 60 frames written, failed: "), "{errors}");
    assert!(last.ends_with("-60"), "{errors}");
}

#[test]
fn a_frame_without_its_file_of_errors_is_rendered_again() {
    let folder = turntable();
    let render = "render turn.ron -o out/#.npy --frames 7-8 --size 31x17 --error-channel";
    assert_eq!(code(&folder.run(render)), 0);
    let whole = contents(&folder, "out");
    let names = whole.iter().map(|(name, _)| name.as_str());
    let expected = ["7.npy", "7_error.npy", "8.npy", "8_error.npy"];
    assert!(names.eq(expected));
    let skipped = |more: &str| {
        let output = folder.run(&format!("{render} --skip-existing {more}"));
        assert_eq!(code(&output), 0, "{}", text(&output.stderr));
        text(&output.stdout).matches(": skipped").count()
    };
    assert_eq!(skipped(""), 2);
    fs::remove_file(folder.path("out/8_error.npy")).unwrap();
    // As a process that was killed leaves it.
    fs::write(folder.path("out/8_error.npy.tmp"), "").unwrap();
    assert_eq!(skipped(""), 1);
    assert!(contents(&folder, "out") == whole);
    fs::copy(
        folder.path("out/8_error.npy"),
        folder.path("out/7_error.npy"),
    )
    .unwrap();
    assert_eq!(skipped(""), 1);
    assert!(contents(&folder, "out") == whole);
    // The light's file cannot stand for that of the errors.
    fs::copy(folder.path("out/7.npy"), folder.path("out/7_error.npy")).unwrap();
    assert_eq!(skipped(""), 1);
    assert!(contents(&folder, "out") == whole);

    // A file of errors that cannot be written is named.
    fs::remove_file(folder.path("out/7_error.npy")).unwrap();
    fs::create_dir(folder.path("out/7_error.npy")).unwrap();
    let output = folder.run(&format!("{render} --frames 7"));
    assert_eq!(code(&output), 2, "an option that is given twice");
    let output = folder.run(&render.replace("7-8", "7"));
    assert_eq!(code(&output), 1);
    let expected = "marbles: out/7_error.npy: cannot write the file: a folder has this name\n";
    assert_eq!(text(&output.stderr), expected);
}

/// A noisy ball enters the picture in the middle, and the files become large.
const NOISE: &str = "(
    image: (width: 64, height: 64),
    lens: Fov(20),
    camera: Free(),
    lights: [Directional(toward: (-1, 1, -1))],
    materials: { \"sand\": (rough: (amplitude: 0.5, grain: Pixel)) },
    spheres: [(center: (0, 0, 10), radius: 3, material: \"sand\")],
    animation: Keyframes(frames: (1, 9), keys: [
        (frame: 1, pan: 90, ease: Hold), (frame: 4, pan: 0, ease: Hold), (frame: 7, pan: 90)]),
)
";

/// Runs `marbles` with a limit on the size of files, in blocks of half a kilobyte or of a kilobyte. Exceeding it is an
/// error, and does not end the process.
#[cfg(unix)]
fn run_with_small_files(folder: &Folder, blocks: u32, arguments: &str) -> Output {
    let marbles = folder.marbles(arguments);
    let limits = format!("trap '' XFSZ; ulimit -f {blocks}; exec \"$@\"");
    let mut shell = Command::new("sh");
    let shell = shell.args(["-c", &limits, "sh"]).current_dir(&folder.0);
    let shell = shell.arg(marbles.get_program()).args(marbles.get_args());
    shell.output().unwrap()
}

/// The writer fails long before everything is rendered, and the rest is given up.
#[cfg(unix)]
#[test]
fn a_frame_that_is_given_up_does_not_stop_the_others() {
    let folder = Folder::new();
    let tall = NOISE
        .replace("width: 64, height: 64", "width: 256, height: 4096")
        .replace("radius: 3", "radius: 9");
    fs::write(folder.path("tall.ron"), tall).unwrap();
    let render = "render tall.ron -o out/#.png --frames 3-7x2 --samples 4";
    let output = run_with_small_files(&folder, 100, render);
    assert_eq!(code(&output), 1);
    assert_eq!(folder.names("out"), ["3.png", "7.png"]);
    let errors = text(&output.stderr);
    let reason = "marbles: out/5.png: cannot write the file: file too large\n";
    assert!(errors.contains(reason), "{errors}");
    let last = "marbles: 2 of 3 frames written, failed: 5\n";
    assert!(errors.ends_with(last), "{errors}");
}

#[cfg(unix)]
#[test]
fn frames_that_cannot_be_written_do_not_stop_the_others() {
    let folder = Folder::new();
    fs::write(folder.path("noise.ron"), NOISE).unwrap();
    let run = |out: &str, more: &str| {
        let arguments = format!("render noise.ron -o {out}/#.png --samples 1 {more}");
        let output = run_with_small_files(&folder, 1, &arguments);
        assert_eq!(code(&output), 1);
        for name in folder.names(out) {
            assert!(is_picture(&name), "{name}");
            assert_complete(&folder.path(out).join(name));
        }
        text(&output.stderr)
    };
    let errors = run("on", "");
    let expected = ["1.png", "2.png", "3.png", "7.png", "8.png", "9.png"];
    assert_eq!(folder.names("on"), expected);
    let reason = "marbles: on/4.png: cannot write the file: file too large\n";
    assert_eq!(errors.matches("marbles: ").count(), 2, "{errors}");
    assert!(errors.contains(reason), "{errors}");
    let last = "marbles: 6 of 9 frames written, failed: 4-6\n";
    assert!(errors.ends_with(last), "{errors}");

    let errors = run("off", "--fail-fast");
    assert_eq!(folder.names("off"), expected[..3]);
    let last = "marbles: 3 of 9 frames written, failed: 4\n";
    assert!(errors.ends_with(last), "{errors}");
}
