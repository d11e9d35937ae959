//! Tests that need a real process: exit codes, signals, disks, pipes.

#![allow(
    clippy::print_stderr,
    reason = "tests that this machine cannot run say so"
)]

mod animation;
mod archives;
mod atoms;
mod camera_by_hand;
mod channels;
mod compare;
mod damage;
#[cfg(target_os = "linux")]
mod datasets;
#[cfg(unix)]
mod farm;
mod figures;
mod files;
mod folder;
mod frames;
mod left_out;
#[cfg(target_os = "linux")]
mod lights;
mod limits;
mod loops;
mod memory;
mod merge;
#[cfg(unix)]
mod pages;
mod png_codes;
#[cfg(target_os = "linux")]
mod preview;
mod progress;
mod readers;
mod real_files;
mod report;
mod sequences;
mod series;
mod sidecar;
mod signals;
mod sky_keys;
mod standard_input;
mod standard_output;
#[cfg(target_os = "linux")]
mod terminal;
mod tiff;

use std::fs;

use folder::{BALL, Folder, code, text};

#[test]
fn exit_codes_tell_what_happened() {
    let folder = Folder::new();
    for (arguments, expected) in [
        // The moon has half a degree, and --set takes one value.
        ("check ball.ron --strict --set lens=Fov(0.5)", 0),
        (
            "check ball.ron --set spheres[0].radius=1),(center:(0,0,9),radius:2",
            2,
        ),
        ("--help", 0),
        ("--version", 0),
        ("render --help", 0),
        ("check ball.ron", 0),
        ("render ball.ron --size 9x9", 0),
        ("render ball.ron --size 9x9 -o new/folder/a.png", 0),
        ("render roll.ron --size 9x9 --frames -2--1 -o a.#.exr", 0),
        ("render ball.ron --size 9x9 -o ball.ron/a.png", 1),
        ("", 2),
        ("paint ball.ron", 2),
        ("render", 2),
        ("render ball.ron -o a.jpg", 2),
        ("render roll.ron -o a.png --frames 1-2", 2),
        ("render ball.ron --frames 2-1", 2),
        ("render ball.ron --size 0x9", 2),
        ("render missing.ron", 2),
        ("render .", 2),
        ("check missing.ron", 2),
        ("render ball.ron --threads 0", 2),
        ("render ball.ron --size 9x9 --samples 2", 0),
        ("render ball.ron --samples 2 --tolerance 1e-3", 2),
        ("render ball.ron --float", 2),
        ("render ball.ron -o a.exr --rgb", 2),
        ("render ball.ron -o a.apng --float", 2),
        ("render ball.ron -o a.png --channels depth", 2),
        ("render ball.ron -o a.apng --channels depth", 2),
        ("render ball.ron -o a.exr --channels deep", 2),
        ("render ball.ron -o a.exr --channels average_normal", 2),
        ("render ball.ron -o a.exr --channels depth,", 2),
        ("render ball.ron -o a.exr --depth ray", 2),
        ("render ball.ron -o a.exr --axes world", 2),
        ("render ball.ron -o a.exr --channels depth --depth far", 2),
        ("render ball.ron -o a.exr --channels depth --axes maya", 2),
        ("render ball.ron -o a.png --error-channel", 2),
        ("render ball.ron --size 9x9 -o a.png --linear", 0),
        ("render ball.ron --size 9x9 -o a.png --exposure -1.5", 0),
        ("render ball.ron -o a.png --linear --bits 8", 2),
        ("render ball.ron -o a.png --exposure much", 2),
        ("render ball.ron -o a.png --exposure NaN", 2),
        ("render ball.ron -o a.png --exposure 101", 2),
        ("render ball.ron -o a.exr --linear", 2),
        ("render ball.ron -o a.npy --linear", 2),
        ("render ball.ron -o a.exr --exposure 1", 2),
        ("render ball.ron -o a.npy --float", 2),
        ("render ball.ron -o a.npy --rgb", 2),
        ("render ball.ron -o a.npy --bits 16", 2),
        ("new ball.ron", 1),
        ("new ball", 2),
        ("completions fish", 0),
        ("completions sh", 2),
        ("man render", 0),
        ("man paint", 2),
        ("preview ball.ron", 0),
        ("preview ball.ron --watch", 2),
        ("preview ball.ron --frame 2", 2),
        ("preview missing.ron", 2),
    ] {
        let output = folder.run(arguments);
        assert_eq!(code(&output), expected, "marbles {arguments}");
        let silent = output.stderr.is_empty();
        assert!(expected == 0 || !silent, "marbles {arguments}");
        assert!(
            expected == 0 || output.stdout.is_empty(),
            "marbles {arguments}"
        );
    }
    let expected = [
        "a.-1.exr", "a.-2.exr", "a.png", "ball.png", "ball.ron", "new",
    ];
    assert_eq!(folder.names("."), expected);
}

#[test]
fn pans_that_go_around_are_told_as_they_go() {
    let folder = Folder::new();
    let scene = "(image: (width: 9, height: 9), lens: Fov(50), camera: Free(), ambient: 1,
        spheres: [(center: (0, 0, 9), radius: 1)],
        animation: Keyframes(frames: (1, 61), keys: [
            (frame: 1, pan: -30, ease: Linear), (frame: 61, pan: 690)]))";
    fs::write(folder.path("around.ron"), scene).unwrap();
    let output = folder.run("check around.ron");
    let lines = text(&output.stdout);
    assert!(lines.contains("  pan       -30 to 690°\n"), "{lines}");
    // A camera on its head is none that is turned around.
    let head = scene.replace("camera: Free()", "camera: Free(tilt: 180, roll: 10)");
    fs::write(
        folder.path("head.ron"),
        head.replace("pan: -30", "pan: 0")
            .replace("pan: 690", "pan: 0"),
    )
    .unwrap();
    let output = folder.run("check head.ron");
    let lines = text(&output.stdout);
    let expected = "  pan       180°\n  tilt      0°\n  roll      -170°\n";
    assert!(lines.contains(expected), "{lines}");
    let output = folder.run("check head.ron --json");
    let lines = text(&output.stdout);
    assert!(lines.contains("\"roll\": -170"), "{lines}");
}

#[test]
fn tables_are_found_beside_the_scene_and_told() {
    const CLOUD: &str = "(
    image: (width: 60, height: 60),
    lens: Fov(40),
    camera: Frame(elevation: 20),
    lights: [Directional(toward: (-1, 1, -1))],
    clouds: [(file: \"tables/salt.csv\", radius: 0.5, value: \"x\", position: (1, 0, 0))],
)
";
    let folder = Folder::new();
    fs::create_dir_all(folder.path("in/tables")).unwrap();
    fs::write(folder.path("in/cloud.ron"), CLOUD).unwrap();
    let table = folder.path("in/tables/salt.csv");
    fs::write(&table, "x,y,z\n-1,-2,-3\n1,2,3\n").unwrap();
    let output = folder.run("check in/cloud.ron");
    assert_eq!(code(&output), 0);
    let lines = text(&output.stdout);
    let told = "cloud       tables/salt.csv: 2, radius 0.5
  from      (-0.5, -2.5, -3.5)
  to        (2.5, 2.5, 3.5)
  axes      left-handed, like the scene
  columns   x: -1 to 1; colors from -1 to 1
            y: -2 to 2
            z: -3 to 3
  seen by   Orbit(target: (1, 0, 0), radius: 12.53";
    assert!(lines.contains(told), "{lines}");
    assert!(lines.contains("camera      Frame: x 1, y 4."), "{lines}");

    for threads in [1, 2] {
        let output = folder.run(&format!(
            "render in/cloud.ron -o {threads}.png --threads {threads}"
        ));
        assert_eq!(code(&output), 0);
    }
    let [one, two] = ["1.png", "2.png"].map(|name| fs::read(folder.path(name)).unwrap());
    assert_eq!(one, two);

    fs::write(&table, "x,y,z\n-1,-2,-3\n1,2\n").unwrap();
    let output = folder.run("render in/cloud.ron");
    assert_eq!(code(&output), 2);
    let errors = text(&output.stderr);
    let start = "in/tables/salt.csv:3:4: expected a number for `z`, found the end of the line\n";
    assert!(errors.contains(start), "{errors}");
    let end = "the table is named at in/cloud.ron:6:21\n";
    assert!(errors.ends_with(end), "{errors}");
}

#[test]
fn a_line_is_printed_for_each_file() {
    let folder = Folder::new();
    let output = folder.run("render roll.ron -o out/%02d.png --frames 8-9 --size 30x20");
    assert_eq!(code(&output), 0);
    let lines = text(&output.stdout);
    let lines: Vec<&str> = lines.lines().collect();
    assert_eq!(lines.len(), 3);
    let starts = ["out/08.png: ", "out/09.png: ", "2 frames: "];
    for (line, start) in lines.iter().zip(starts) {
        let start = format!("{start}error <= ");
        let rest = line.strip_prefix(&start).unwrap();
        let (error, rest) = rest.split_once(' ').unwrap();
        // The default tolerance.
        assert!(error.parse::<f64>().unwrap() <= 1e-3);
        let (evidence, rest) = rest.split_once(", 0 over, ").unwrap();
        let share = evidence.strip_prefix("(").unwrap();
        let share = share.strip_suffix(" % bounds)").unwrap();
        assert!((50..100).contains(&share.parse::<u32>().unwrap()), "{line}");
        let seconds = rest.strip_suffix(" s").unwrap();
        assert!(seconds.parse::<f64>().unwrap() < 60.0);
    }
    assert_eq!(text(&output.stderr), "");

    let output = folder.run("render ball.ron -o a.png --size 30x20");
    assert_eq!(text(&output.stdout).lines().count(), 1);
    assert_eq!(text(&output.stderr), "");
}

#[test]
fn quiet_prints_nothing() {
    let folder = Folder::new();
    let output = folder.run("render roll.ron -o a.#.png --frames 1-3 --size 9x9 --quiet");
    assert_eq!(code(&output), 0);
    assert_eq!(text(&output.stdout), "");
    assert_eq!(text(&output.stderr), "");
    assert_eq!(folder.names(".").len(), 4);
}

#[test]
fn pictures_repeat_with_any_number_of_threads() {
    let folder = Folder::new();
    for ending in ["png", "exr"] {
        let names = ["a", "b", "1", "2", "7"];
        for name in names {
            let threads = match name.parse::<u32>() {
                Ok(threads) => format!("--threads {threads}"),
                Err(_) => String::new(),
            };
            let output = folder.run(&format!(
                "render ball.ron -o {name}.{ending} --size 101x67 {threads}"
            ));
            assert_eq!(code(&output), 0);
        }
        let first = folder.read(&format!("a.{ending}"));
        for name in names {
            let same = folder.read(&format!("{name}.{ending}")) == first;
            assert!(same, "{name}.{ending}");
        }
    }
}

#[test]
fn a_tolerance_that_is_not_met_ends_with_3() {
    let folder = Folder::new();
    let met = folder.run("render ball.ron --tolerance 1e-3 --size 30x30 -o met.png");
    assert_eq!(code(&met), 0);
    assert!(text(&met.stdout).contains(", 0 over, "));
    // Lines cannot be trusted with numbers of this size.
    let huge = BALL.replace("(0, 0, 400), radius: 300", "(0, 0, 4e200), radius: 3e200");
    fs::write(folder.path("huge.ron"), huge).unwrap();
    let missed = folder.run("render huge.ron --tolerance 1e-3 --size 30x30 -o missed.png");
    assert_eq!(code(&missed), 3);
    // Of several scenes the one that says more of what is missing decides.
    for (scenes, expected) in [("ball huge", 3), ("huge ball", 3), ("huge none ball", 2)] {
        let names: Vec<String> = scenes
            .split(' ')
            .map(|name| format!("{name}.ron"))
            .collect();
        let arguments = format!("render {} --size 9x9 -o all/{{scene}}.png", names.join(" "));
        assert_eq!(code(&folder.run(&arguments)), expected, "{scenes}");
    }
    assert!(!text(&missed.stdout).contains(", 0 over, "));
    assert!(folder.path("missed.png").exists());
    let errors = text(&missed.stderr);
    let (_, worst) = errors
        .split_once(" over the tolerance, the worst in ")
        .unwrap();
    let numbers = worst.split(|letter: char| !letter.is_ascii_digit());
    let numbers: Vec<&str> = numbers.filter(|number| !number.is_empty()).collect();
    // The same pixel alone is found where it is in the whole picture.
    let (col, row) = (numbers[0], numbers[1]);
    assert!((col, row) != ("0", "0"), "{errors}");
    let region = format!("--region {col},{row},1,1");
    let render = "render huge.ron --tolerance 1e-3 --size 30x30 -o worst.png";
    let errors = text(&folder.run(&format!("{render} {region}")).stderr);
    let expected =
        format!("worst.png: 1 pixel over the tolerance, the worst in column {col}, row {row} ");
    assert!(errors.contains(&expected), "{errors}");
    for refused in ["0", "-1", "inf", "NaN", "much"] {
        let output = folder.run(&format!("render ball.ron --tolerance={refused}"));
        assert_eq!(code(&output), 2, "{refused}");
    }
}
