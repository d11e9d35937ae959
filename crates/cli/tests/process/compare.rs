//! `marbles compare` as a process: exit codes, results, pictures of differences.

use std::fs;
use std::process::Output;

use crate::folder::{Folder, code, text};

/// A ball in front of the camera.
const BALL: &str = "(
    image: (width: 60, height: 40),
    lens: Retina(width: 60, distance: 50),
    camera: Free(),
    ambient: 0.1,
    lights: [Directional(toward: (-1, 1, -1), intensity: 0.8)],
    spheres: [(center: (0, 0, 40), radius: 15)],
)
";

/// A folder with pictures of the ball.
fn folder() -> Folder {
    let folder = Folder::new();
    fs::write(folder.path("ball.ron"), BALL).unwrap();
    for arguments in [
        "-o a.exr --samples 4",
        "-o a.png --samples 4",
        "-o a.npy --samples 4",
        "-o float.exr --samples 4 --float",
        "-o linear.png --samples 4 --linear",
        "-o deep.png --samples 4 --bits 16 --rgb",
        "-o fine.exr --samples 16",
        "-o wide.exr --samples 4 --size 60x41",
    ] {
        let output = folder.run(&format!("render ball.ron --quiet {arguments}"));
        assert!(output.status.success(), "{arguments}");
    }
    folder
}

/// The row `name` of the result.
fn row(output: &Output, name: &str) -> String {
    let lines = text(&output.stdout);
    let line = lines.lines().find(|line| line.starts_with(name));
    line.unwrap_or_else(|| panic!("no {name} in {lines}"))[name.len()..]
        .trim()
        .to_owned()
}

#[test]
fn exit_codes_tell_what_happened() {
    let folder = folder();
    fs::write(folder.path("cut.exr"), b"\x76\x2f\x31\x01cut").unwrap();
    for (arguments, expected) in [
        ("a.exr a.exr --tolerance 0", 0),
        ("a.exr fine.exr", 0),
        ("a.exr fine.exr --tolerance 1", 0),
        ("a.exr float.exr --tolerance 1e-3", 0),
        ("a.exr fine.exr --worst 0 --diff new/folder/diff.png", 0),
        ("a.exr fine.exr --tolerance 1e-3", 1),
        ("a.png a.exr --tolerance 0 --quiet", 1),
        ("a.exr wide.exr", 1),
        ("a.exr fine.exr --diff a.exr/diff.png", 1),
        ("a.exr", 2),
        ("a.exr missing.exr", 2),
        ("a.exr .", 2),
        ("a.exr ball.ron", 2),
        ("a.exr cut.exr", 2),
        ("a.exr fine.exr --tolerance -1", 2),
        ("a.exr fine.exr --tolerance nan", 2),
        ("a.exr fine.exr --worst many", 2),
        ("a.exr fine.exr --diff diff.jpg", 2),
        ("a.exr fine.exr --diff ./fine.exr", 2),
    ] {
        let output = folder.run(&format!("compare {arguments}"));
        let code = output.status.code();
        assert_eq!(code, Some(expected), "marbles compare {arguments}");
        let answered = expected == 0 || arguments.contains("--tolerance");
        let silent = output.stderr.is_empty();
        assert!(expected == 2 || silent == answered, "{arguments}");
    }
}

#[test]
fn sizes_that_differ_are_named() {
    let folder = folder();
    let output = folder.run("compare a.png wide.exr");
    assert_eq!(text(&output.stdout), "");
    assert_eq!(
        text(&output.stderr),
        "marbles: the pictures have different sizes: a.png is 60 x 40, wide.exr is 60 x 41\n"
    );
}

#[test]
fn formats_differ_by_their_rounding_alone() {
    let folder = folder();
    for pair in [
        "a.png a.exr",
        "a.exr float.exr",
        "deep.png float.exr",
        "a.png deep.png",
        "a.exr a.npy",
        "deep.png a.npy",
        "linear.png a.npy",
    ] {
        let output = folder.run(&format!("compare {pair}"));
        let expected = "0 of 2400 pixels, fraction 0.0e+00, differ by more than rounding";
        assert_eq!(row(&output, "beyond"), expected, "{pair}");
        let number = |name: &str| -> f64 {
            let text = row(&output, name);
            text.split(' ').next().unwrap().parse().unwrap()
        };
        assert!(number("largest") > 0.0 && number("rms") > 0.0);
        assert!(number("largest") <= number("rounding"));
        assert!(number("rms") <= number("99.9 %"));
    }
}

#[test]
fn the_result_is_a_table() {
    let folder = folder();
    let output = folder.run("compare a.exr fine.exr --tolerance 1e-3 --worst 2 --diff diff.png");
    let lines = text(&output.stdout);
    let names: Vec<&str> = lines.lines().map(|line| line[..12].trim()).collect();
    let expected = [
        "A", "B", "largest", "rms", "99.9 %", "over", "rounding", "beyond", "worst", "", "", "diff",
    ];
    assert_eq!(names, expected, "{lines}");
    assert_eq!(row(&output, "A"), "a.exr: 60 x 40, EXR, half, RGB");
    assert!(row(&output, "over").ends_with(", tolerance 1e-3"));
    let worst: Vec<&str> = lines.lines().nth(9).unwrap().split_whitespace().collect();
    let expected = format!(
        "{} in {}, column {}, row {}",
        worst[5], worst[2], worst[0], worst[1]
    );
    assert_eq!(row(&output, "largest"), expected);
}

#[test]
fn the_picture_of_differences_holds_them() {
    let folder = folder();
    let compared = folder.run("compare a.exr fine.exr --diff diff.exr");
    fs::write(folder.path("black.ron"), BALL.replace("15", "1e-9")).unwrap();
    folder.run("render black.ron -o black.exr --float --quiet");
    let output = folder.run("compare diff.exr black.exr");
    for name in ["largest", "rms", "99.9 %"] {
        assert_eq!(row(&output, name), row(&compared, name));
    }
}

#[test]
fn the_error_channel_is_told_and_not_compared() {
    let folder = folder();
    let rendered = folder.run("render ball.ron -o e.exr --samples 4 --error-channel --quiet");
    assert!(rendered.status.success());
    let output = folder.run("compare a.exr e.exr --tolerance 0");
    assert_eq!(output.status.code(), Some(0));
    let name = "e.exr: 60 x 40, EXR, half, RGB and error";
    assert_eq!(row(&output, "B"), name);
    assert!(output.stderr.is_empty());
    let refused = folder.run("render ball.ron -o e.png --error-channel");
    assert_eq!(refused.status.code(), Some(2));
    assert_eq!(
        text(&refused.stderr),
        "marbles: --error-channel is for EXR, NPY and NPZ files, but the output is PNG\n"
    );
}

#[test]
fn quiet_prints_nothing() {
    let folder = folder();
    let output = folder.run("compare a.exr fine.exr --tolerance 1e-9 --quiet");
    assert_eq!(output.status.code(), Some(1));
    assert!(output.stdout.is_empty() && output.stderr.is_empty());
}

/// Pixels that neither file contains are counted as well.
#[test]
fn parts_are_compared_as_whole_pictures() {
    let folder = Folder::new();
    let run = |arguments: &str| {
        let output = folder.run(arguments);
        assert_eq!(code(&output), 0, "{arguments}: {}", text(&output.stderr));
        text(&output.stdout)
    };
    let render = "render ball.ron --float --size 60x45 --samples 1";
    run(&format!("{render} -o all.exr"));
    run(&format!("{render} -o a.exr --region 14,9,17,12"));
    run(&format!("{render} -o b.exr --region 33,17,9,20"));
    run("compare all.exr all.exr --diff black.exr");
    let numbers = |a: &str, b: &str, difference: &str| {
        let told = run(&format!("compare {a} {b} --diff {difference}"));
        let wanted = ["largest ", "rms ", "99.9 % "];
        let lines = told.lines();
        let lines = lines.filter(|line| wanted.iter().any(|start| line.starts_with(start)));
        let lines = lines.map(|line| line.split_once(" (").map_or(line, |(number, _)| number));
        lines.map(str::to_owned).collect::<Vec<_>>()
    };
    let apart = numbers("a.exr", "b.exr", "apart.exr");
    assert_eq!(apart.len(), 3);
    assert_eq!(apart, numbers("black.exr", "apart.exr", "same.exr"));
    // What is left without the one is the other.
    numbers("apart.exr", "a.exr", "left.exr");
    assert!(run("compare left.exr b.exr").contains("the pictures are the same"));
    assert!(!run("compare left.exr a.exr").contains("the pictures are the same"));
    run("compare a.exr b.exr --diff apart.png");
    run("compare black.exr apart.exr --diff same.png");
    assert!(folder.read("apart.png") == folder.read("same.png"));

    // Alpha is 1 where a file has none, and 0 where one has no pixels. These are in the ball.
    for (name, alpha) in [("alpha", "--alpha"), ("none", "")] {
        run(&format!(
            "{render} -o {name}.exr {alpha} --region 29,22,2,2"
        ));
    }
    let told = run("compare alpha.exr none.exr");
    assert!(told.contains("largest     1.000e+00"), "{told}");
}
