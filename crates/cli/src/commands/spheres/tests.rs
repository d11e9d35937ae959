//! Tables of spheres, read back.

use std::fs;

use crate::base::status;
use crate::tests::{run_here, temporary};

const SCENE: &str = r#"(
    image: (width: 60, height: 40),
    lens: Retina(width: 60, distance: 100),
    camera: Free(position: (0, 0, 0)),
    spheres: [
        (center: (0, 0, 100), radius: 10),
        (center: (0, 0, 50), radius: 1),
        (center: (12, 0, 0), radius: 3),
        (center: (500, 0, 100), radius: 5),
    ],
)"#;

/// The rows of the table of a scene, field by field, and what was printed.
fn table(name: &str, scene: &str, options: &[&str]) -> (Vec<Vec<String>>, String) {
    let (path, output) = (temporary(name), temporary(&format!("{name}.csv")));
    fs::write(&path, scene).unwrap();
    let mut args = vec![
        "spheres",
        path.to_str().unwrap(),
        "-o",
        output.to_str().unwrap(),
    ];
    args.extend(options);
    let (code, out, err) = run_here(&args);
    assert_eq!((code, &*err), (status::SUCCESS, ""));
    let text = fs::read_to_string(&output).unwrap();
    fs::remove_file(&path).unwrap();
    fs::remove_file(&output).unwrap();
    let fields = |line: &str| line.split(',').map(str::to_owned).collect();
    (text.lines().map(fields).collect(), out)
}

#[test]
fn rows_have_the_numbers_of_closed_forms() {
    let (rows, out) = table("spheres.ron", SCENE, &[]);
    assert!(out.ends_with("4 spheres in 1 frame\n"), "{out}");
    assert_eq!(rows.len(), 5);
    assert!(rows.iter().all(|row| row.len() == rows[0].len()));
    let column = |name: &str| rows[0].iter().position(|field| field == name).unwrap();
    let number = |row: usize, name: &str| -> f64 { rows[row][column(name)].parse().unwrap() };
    // The middle of the picture, where the middle of the first pixel is (0, 0).
    for (name, expected) in [("center_x", 29.5), ("center_y", 19.5), ("depth", 100.0)] {
        assert_eq!(number(1, name), expected, "{name}");
    }
    // A ball straight ahead: a circle with the radius distance · r / √(z² − r²).
    let radius = 100.0 * 10.0 / (100.0_f64 * 100.0 - 100.0).sqrt();
    let small = 100.0 / (50.0_f64 * 50.0 - 1.0).sqrt();
    let disc = |radius: f64| std::f64::consts::PI * radius * radius;
    for (name, expected) in [
        ("semi_major", radius),
        ("semi_minor", radius),
        ("left", 29.5 - radius),
        ("bottom", 19.5 + radius),
        ("area", disc(radius)),
    ] {
        assert!((number(1, name) - expected).abs() < 1e-10, "{name}");
    }
    // The small ball is in front of it.
    let error = number(1, "visible_area_error");
    let seen = disc(radius) - disc(small);
    assert!((number(1, "visible_area") - seen).abs() <= error && error < 0.02);
    assert!((number(1, "visible_fraction") - seen / disc(radius)).abs() < 1e-3);
    assert!((number(2, "visible_area") - disc(small)).abs() < number(2, "visible_area_error"));
    // Beside the eye there is no ellipse, and no center in the picture.
    for name in [
        "center_x",
        "ellipse_y",
        "semi_minor",
        "left",
        "area",
        "visible_fraction",
    ] {
        assert_eq!(rows[3][column(name)], "", "{name}");
    }
    assert_eq!((number(3, "depth"), number(3, "visible_area")), (0.0, 0.0));
    // Out of the picture.
    assert_eq!((number(4, "area"), number(4, "visible_area")), (0.0, 0.0));
    assert_eq!(rows[4][column("visible_fraction")], "");
}

#[test]
fn frames_follow_each_other() {
    let scene = SCENE.replace(
        "    spheres: [",
        "    animation: Keyframes(frames: (1, 3), keys: [(frame: 1, pan: 0), (frame: 3, pan: 20)]),
    spheres: [",
    );
    let (rows, out) = table(
        "spheres-frames.ron",
        &scene,
        &["--frames", "3,1", "--size", "30x20"],
    );
    assert!(out.ends_with("4 spheres in 2 frames\n"), "{out}");
    let firsts: Vec<&str> = rows[1..].iter().map(|row| &*row[0]).collect();
    assert_eq!(firsts, ["3", "3", "3", "3", "1", "1", "1", "1"]);
    let center = rows[5][2].parse::<f64>().unwrap();
    assert!((center - 14.5).abs() < 1e-12, "{center}");
}

#[test]
fn wrong_frames_and_the_scene_as_output_are_refused() {
    // If a table is written all the same, then here.
    let folder = temporary("spheres-refused");
    fs::create_dir_all(&folder).unwrap();
    let (path, table) = (folder.join("scene.ron"), folder.join("table.csv"));
    fs::write(&path, SCENE).unwrap();
    let [name, table] = [&path, &table].map(|path| path.to_str().unwrap());
    let (code, _, err) = run_here(&["spheres", name, "--frames", "2", "-o", table]);
    assert_eq!(code, status::REFUSED);
    assert!(
        err.contains("--frames: expected 1, the only frame of the scene, found 2"),
        "{err}"
    );
    let (code, _, err) = run_here(&["spheres", name, "-o", name]);
    assert_eq!(code, status::REFUSED);
    assert!(err.contains("would replace the scene"), "{err}");
    let text = fs::read_to_string(&path).unwrap();
    fs::remove_dir_all(folder).unwrap();
    assert_eq!(text, SCENE);
}
