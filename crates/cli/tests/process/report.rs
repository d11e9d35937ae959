//! `marbles report` as a process: exit codes, files, the form of its results.

use std::fs;
use std::process::Stdio;
use std::time::Duration;

use crate::folder::{Folder, text};
#[cfg(unix)]
use crate::signals::{ending, signal};

/// A ball in front of the camera, so small that all settings are measured quickly.
const BALL: &str = "(
    image: (width: 6, height: 4),
    lens: Retina(width: 60, distance: 50),
    camera: Free(),
    ambient: 0.1,
    lights: [Directional(toward: (-1, 1, -1), intensity: 0.8)],
    spheres: [(center: (0, 0, 40), radius: 15)],
    animation: Keyframes(frames: (3, 7), keys: [(frame: 3, pan: 0), (frame: 7, pan: 5)]),
)
";

/// One run of as few settings as possible, on any machine.
const QUICK: &str = "--seconds 0 --runs 1";

/// A folder with the scene.
fn folder() -> Folder {
    let folder = Folder::new();
    fs::write(folder.path("ball.ron"), BALL).unwrap();
    folder
}

#[test]
fn exit_codes_tell_what_happened() {
    let folder = folder();
    fs::create_dir(folder.path("folder.csv")).unwrap();
    for (arguments, expected, message) in [
        ("ball.ron", 0, ""),
        ("ball.ron --frame 7 --size 3x2 --threads 1", 0, ""),
        ("ball.ron --csv new/a.csv --plot new/a.svg", 0, ""),
        ("ball.ron --set lights[0].diameter=5 --set sky=0.1", 0, ""),
        (
            "ball.ron --csv ball.ron/a.csv",
            1,
            "ball.ron: cannot create the folder: ",
        ),
        (
            "ball.ron --csv folder.csv",
            1,
            "folder.csv: cannot write the file: a folder has this name",
        ),
        (
            "ball.ron --plot a.jpg",
            2,
            "--plot: expected a file name that ends in .svg, the only format of plots, found `a.jpg`",
        ),
        (
            "ball.ron --plot svg",
            2,
            "--plot: expected a file name that ends in .svg, the only format of plots, found `svg`",
        ),
        (
            "ball.ron --plot a.png",
            2,
            "--plot: expected a file name that ends in .svg, the only format of plots, found `a.png`",
        ),
        (
            "ball.ron --frame 8",
            2,
            "--frame: expected a frame of the scene, from 3 to 7, found 8",
        ),
        ("ball.ron --frame -1", 2, "--frame: expected a frame of"),
        (
            "ball.ron --csv ./ball.ron",
            2,
            "./ball.ron: the output would replace the scene",
        ),
        (
            "ball.ron --csv a.svg --plot a.svg",
            2,
            "a.svg: --csv and --plot name the same file",
        ),
    ] {
        let output = folder.run(&format!("report {arguments} {QUICK}"));
        let errors = text(&output.stderr);
        assert_eq!(
            output.status.code(),
            Some(expected),
            "{arguments}: {errors}"
        );
        assert_eq!(output.stdout.is_empty(), expected > 0, "{arguments}");
        if expected > 0 {
            // Nothing was rendered before.
            let start = format!("marbles: {message}");
            assert!(errors.starts_with(&start), "{arguments}: {errors}");
        }
    }
    for arguments in [
        "",
        "missing.ron",
        "ball.ron --seconds -1",
        "ball.ron --seconds nan",
        "ball.ron --runs 0",
        "ball.ron --frame x",
        "ball.ron --size 0x1",
        "ball.ron --threads 0",
    ] {
        let output = folder.run(&format!("report {arguments}"));
        assert_eq!(output.status.code(), Some(2), "{arguments}");
    }
}

#[test]
fn results_are_facts_and_a_table() {
    let folder = folder();
    let output = folder.run(&format!("report ball.ron --threads 2 {QUICK}"));
    let lines = text(&output.stdout);
    let facts: Vec<&str> = lines.lines().take_while(|line| !line.is_empty()).collect();
    let names: Vec<&str> = facts.iter().map(|line| line[..12].trim()).collect();
    assert_eq!(names, ["scene", "reference", "times"], "{lines}");
    assert_eq!(
        &facts[0][12..],
        "ball.ron, frame 3, 6 x 4 pixels, 2 threads"
    );
    assert!(facts[1].contains("tolerance 1e-7: error <= "), "{lines}");
    assert_eq!(&facts[2][12..], "median of 1 run");

    let table: Vec<&str> = lines.lines().filter(|line| line.starts_with('|')).collect();
    let settings: Vec<&str> = table
        .iter()
        .map(|line| line.split('|').nth(1).unwrap().trim())
        .collect();
    assert_eq!(settings[0], "setting");
    let expected = [
        "tolerance 1e-1",
        "tolerance 1e-2",
        "tolerance 1e-3",
        "tolerance 1e-4",
        "tolerance 1e-5",
        "tolerance 1e-6",
        "1 sample",
        "2 x 2 samples",
        "4 x 4 samples",
    ];
    assert_eq!(settings[2..], expected);
    let width = table[0].chars().count();
    assert!(table.iter().all(|line| line.chars().count() == width));

    // Progress is told apart from results.
    let progress = text(&output.stderr);
    assert!(
        progress.starts_with("reference, tolerance 1e-7\n"),
        "{progress}"
    );
    assert_eq!(progress.matches("run 1 of 1, ").count(), expected.len());
}

#[test]
fn files_hold_the_numbers() {
    let folder = folder();
    fs::rename(folder.path("ball.ron"), folder.path("a,b.ron")).unwrap();
    let arguments = format!("report a,b.ron --csv a.csv --plot PLOT.SVG --quiet {QUICK}");
    let output = folder.run(&arguments);
    assert_eq!(output.status.code(), Some(0));
    assert!(output.stdout.is_empty() && output.stderr.is_empty());
    let svg = text(&folder.read("PLOT.SVG"));
    assert!(svg.starts_with("<svg xmlns=\"http://www.w3.org/2000/svg\""));
    assert!(svg.ends_with("</svg>\n") && svg.contains(">4×4</text>"));
    let csv = text(&folder.read("a.csv"));
    let lines: Vec<&str> = csv.lines().collect();
    assert_eq!(lines.len(), 1 + 1 + 6 + 3);
    let titles: Vec<&str> = lines[0].split(',').collect();
    let column = |name: &str| titles.iter().position(|title| *title == name).unwrap();
    for line in &lines[1..] {
        let cells = line.strip_prefix("\"a,b.ron\",").unwrap();
        let cells: Vec<&str> = [""].into_iter().chain(cells.split(',')).collect();
        assert_eq!(cells.len(), titles.len(), "{line}");
        let number = |name: &str| cells[column(name)].parse::<f64>();
        assert!(number("seconds").unwrap() > 0.0);
        assert_eq!(number("frame"), Ok(3.0));
        if cells[column("method")] == "tolerance" {
            let tolerance = number("tolerance").unwrap();
            assert!(number("largest_error").unwrap() <= tolerance, "{line}");
            assert!(number("rmse").unwrap() <= number("largest_error").unwrap());
            assert_eq!(number("pixels_over_tolerance"), Ok(0.0));
        }
    }
}

#[test]
fn pixels_that_miss_their_tolerance_end_with_3() {
    let folder = folder();
    // Lines cannot be trusted with numbers of this size, so there is no reference either.
    let huge = BALL.replace("(0, 0, 40), radius: 15", "(0, 0, 4e200), radius: 3e200");
    fs::write(folder.path("huge.ron"), huge).unwrap();
    let output = folder.run(&format!("report huge.ron --csv a.csv {QUICK}"));
    assert_eq!(output.status.code(), Some(3));
    let results = text(&output.stdout);
    assert!(results.contains(" pixels excluded: the reference is not accurate enough there"));
    assert!(results.contains("tolerance 1e-3: "), "{results}");
    assert!(folder.path("a.csv").exists());
}

#[cfg(unix)]
#[test]
fn interrupted_reports_write_nothing() {
    let folder = folder();
    let mut child = folder
        .marbles("report ball.ron --csv a.csv --size 1000x1000 --seconds 600")
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    // The signals are listened to before anything is rendered.
    let mut first = [0];
    let mut errors = child.stderr.take().unwrap();
    std::io::Read::read_exact(&mut errors, &mut first).unwrap();
    std::thread::sleep(Duration::from_millis(20));
    signal(ending(), &child);
    let output = child.wait_with_output().unwrap();
    assert_eq!(output.status.code(), Some(130));
    assert!(output.stdout.is_empty());
    assert!(!folder.path("a.csv").exists());
}
