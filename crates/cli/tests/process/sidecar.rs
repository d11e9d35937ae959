//! Sidecars of pictures.

use std::fs;

use serde_json::Value;

use crate::folder::{Folder, code, text};

fn read(folder: &Folder, name: &str) -> Value {
    serde_json::from_slice(&folder.read(name)).unwrap()
}

/// The names in the folder except for the scene.
fn names(folder: &Folder) -> Vec<String> {
    let mut names = folder.names(".");
    names.retain(|name| name != "ball.ron");
    names
}

#[test]
fn every_picture_has_a_sidecar_beside_it() {
    let folder = Folder::new();
    let output = folder.run("render roll.ron -o a.#.png --frames 1-2 --size 60x30 --sidecar");
    assert_eq!(code(&output), 0, "{}", text(&output.stderr));
    assert_eq!(
        names(&folder),
        ["a.1.json", "a.1.png", "a.2.json", "a.2.png"]
    );
    // A line for each picture and one for all: sidecars are no pictures.
    assert_eq!(text(&output.stdout).lines().count(), 3);
    let [one, two] = ["a.1.json", "a.2.json"].map(|name| read(&folder, name));
    assert_eq!((&one["frame"], &two["frame"]), (&1.into(), &2.into()));
    assert_ne!(one["digest"], two["digest"]);
    let matrix = serde_json::json!([[10.0, 0.0, 29.5], [0.0, 10.0, 14.5], [0.0, 0.0, 1.0]]);
    assert_eq!(one["camera"]["K"], matrix);
    assert!(one["error"].as_f64().unwrap() <= 1e-3);
    assert_eq!((&one["tolerance"], &one["over"]), (&1e-3.into(), &0.into()));
    let png = text(&folder.run("compare a.1.png a.2.png").stdout);
    assert!(png.contains("PNG"), "{png}");

    // `check` tells the same, but for what only rendering knows.
    let output = folder.run("check ball.ron --json");
    assert_eq!((code(&output), &*text(&output.stderr)), (0, ""));
    let mut known: Value = serde_json::from_slice(&output.stdout).unwrap();
    folder.run("render ball.ron -o whole.exr --samples 1 --sidecar");
    let mut whole = read(&folder, "whole.json");
    let rendered = [
        "samples",
        "error",
        "evidence",
        "bounded_pixels",
        "over",
        "digest",
    ];
    for name in rendered {
        let object = whole.as_object_mut().unwrap();
        assert!(object.remove(name).is_some(), "{name}");
        assert_eq!(known.as_object_mut().unwrap().remove(name), None);
    }
    // And more of what is rendered.
    for name in ["shadows", "materials", "spheres", "warnings"] {
        let object = known.as_object_mut().unwrap();
        assert!(object.remove(name).is_some(), "{name}");
    }
    assert_eq!(whole, known);
}

/// A program without the scene file computes the brightest point of a ball, and finds it there.
#[test]
fn check_tells_all_that_another_renderer_needs() {
    let folder = Folder::new();
    let scene = "(
        image: (width: 150, height: 100), lens: Fov(40),
        camera: LookAt(position: (2, 3, -10), target: (0, 0.7, 0), roll: 10),
        lights: [Directional(toward: (-1, 1.5, -1), intensity: (1, 0.8, 0.5))],
        materials: { \"a\": (albedo: (0.6, 0.3, 0.2), highlight: (strength: 0.25)) },
        spheres: [(center: (-1, 1, 0), radius: 1, material: \"a\"), (center: (2, 1, 0.5), radius: 0.5)],
    )";
    fs::write(folder.path("peer.ron"), scene).unwrap();
    let output = folder.run("check peer.ron --json");
    let known: Value = serde_json::from_slice(&output.stdout).unwrap();
    let expected = serde_json::json!([
        {"center": [-1.0, 1.0, 0.0], "radius": 1.0, "albedo": [0.6, 0.3, 0.2], "material": "a"},
        {"center": [2.0, 1.0, -0.5], "radius": 0.5, "albedo": [1.0, 1.0, 1.0], "material": null},
    ]);
    assert_eq!(known["spheres"], expected);
    assert_eq!(known["shadows"], true);
    let expected = serde_json::json!([{
        "name": "a", "albedo": [0.6, 0.3, 0.2], "exponent": 1.0,
        "highlight": {"strength": 0.25, "shininess": 40.0}, "rough": null, "outline": null,
    }]);
    assert_eq!(known["materials"], expected);
    assert_eq!(known["camera"]["roll"].as_f64().map(f64::round), Some(10.0));

    // The point of the first ball that faces the light, as OpenCV projects it.
    let vector =
        |value: &Value| -> [f64; 3] { std::array::from_fn(|index| value[index].as_f64().unwrap()) };
    let (toward, center) = (
        vector(&known["lights"][0]["toward"]),
        vector(&known["spheres"][0]["center"]),
    );
    let point: [f64; 3] = std::array::from_fn(|index| center[index] + toward[index]);
    let camera = &known["camera"];
    let translation = vector(&camera["t"]);
    let seen: [f64; 3] = std::array::from_fn(|row| {
        let axis = vector(&camera["R"][row]);
        (0..3).map(|index| axis[index] * point[index]).sum::<f64>() + translation[row]
    });
    let matrix: [[f64; 3]; 3] = std::array::from_fn(|row| vector(&camera["K"][row]));
    let pixel = |row: usize| matrix[row][row] * seen[row] / seen[2] + matrix[row][2];
    folder.run("render peer.ron -o peer.npy --set lights[0].intensity=1 --set materials.a.highlight=(strength:0)");
    let array = folder.read("peer.npy");
    let (col, row) = (pixel(0).round() as usize, pixel(1).round() as usize);
    let bytes = &array[array.len() - 8 * 3 * 150 * 100 + 8 * 3 * (150 * row + col)..][..8];
    let red = f64::from_le_bytes(bytes.try_into().unwrap());
    assert!((0.59..=0.6).contains(&red), "{red} at {col}, {row}");
}

#[test]
fn the_same_input_makes_the_same_sidecar() {
    let folder = Folder::new();
    folder.run("render ball.ron -o a.png --size 50x40 --sidecar --threads 1");
    let scene = folder.path("ball.ron");
    let absolute = scene.to_str().unwrap();
    folder.run(&format!(
        "render {absolute} -o b.png --size 50x40 --sidecar --threads 3"
    ));
    assert_eq!(text(&folder.read("a.json")), text(&folder.read("b.json")));
}

#[test]
fn a_frame_is_there_when_its_sidecar_is() {
    let folder = Folder::new();
    let run = |more: &str| {
        let arguments = "render roll.ron -o #.png --frames 1-5 --size 9x9 --skip-existing";
        let output = folder.run(&format!("{arguments} {more}"));
        assert_eq!(code(&output), 0, "{}", text(&output.stderr));
        text(&output.stdout).matches(": skipped").count()
    };
    assert_eq!(run(""), 0);
    assert_eq!(run(""), 5);
    // All lack a sidecar; then none does, and pictures alone do not ask for it.
    assert_eq!(run("--sidecar"), 0);
    assert_eq!(run("--sidecar"), 5);
    assert_eq!(run(""), 5);
    let good = folder.read("1.json");
    fs::remove_file(folder.path("2.json")).unwrap();
    fs::write(folder.path("3.json"), &folder.read("3.json")[..100]).unwrap();
    fs::write(folder.path("4.json"), folder.read("5.json")).unwrap();
    fs::write(folder.path("5.json.tmp"), "left by a killed process").unwrap();
    assert_eq!(run("--sidecar"), 2);
    assert_eq!(folder.read("1.json"), good);
    for frame in 1..=5 {
        let name = format!("{frame}.json");
        assert_eq!(read(&folder, &name)["frame"], frame);
    }
    assert!(!folder.path("5.json.tmp").exists());
}

#[test]
fn parts_tell_their_region_and_the_camera_of_the_whole() {
    let folder = Folder::new();
    folder.run("render ball.ron -o all.png --size 48x48 --sidecar");
    folder.run("render ball.ron -o part.png --size 48x48 --region 16,8,10,20 --sidecar");
    let (all, part) = (read(&folder, "all.json"), read(&folder, "part.json"));
    let region = serde_json::json!({"col": 16, "row": 8, "width": 10, "height": 20});
    assert_eq!((&part["region"], all.get("region")), (&region, None));
    for same in ["image", "camera", "lights", "digest"] {
        assert_eq!(part[same], all[same], "{same}");
    }
    let output = folder.run("render ball.ron -o part.png --size 48x48 --sidecar --skip-existing");
    assert!(!text(&output.stdout).contains("skipped"));
}

#[test]
fn sidecars_that_cannot_be_are_refused() {
    let folder = Folder::new();
    fs::copy(folder.path("ball.ron"), folder.path("ball.json")).unwrap();
    for (arguments, expected) in [
        (
            "render ball.ron -o a.apng --sidecar",
            "marbles: --sidecar needs one file per frame, but this output contains all frames\n",
        ),
        (
            "render ball.json --sidecar",
            "marbles: ball.json: the output would replace the scene, or a table that it names\n",
        ),
        (
            "check ball.ron --json --frame 3",
            "marbles: --frame: expected 1, the only frame of the scene, found 3\n",
        ),
    ] {
        let output = folder.run(arguments);
        assert_eq!(code(&output), 2, "{arguments}");
        assert_eq!(text(&output.stderr), expected);
    }
    assert_eq!(code(&folder.run("check ball.ron --frame 1")), 2);
    assert_eq!(names(&folder), ["ball.json"]);

    // What is in the way of a sidecar keeps its picture from being complete.
    fs::create_dir(folder.path("a.json")).unwrap();
    let output = folder.run("render ball.ron -o a.png --size 9x9 --sidecar");
    assert_eq!(code(&output), 1);
    let errors = text(&output.stderr);
    assert_eq!(
        errors,
        "marbles: a.json: cannot write the file: a folder has this name\n"
    );
    assert_eq!(names(&folder), ["a.json", "ball.json"]);
}

#[test]
fn tasks_of_farms_write_sidecars() {
    let folder = Folder::new();
    let output = folder.run("farm slurm ball.ron -o out/#.png --sidecar");
    assert_eq!(code(&output), 0);
    assert!(text(&output.stdout).contains("--sidecar"));
}
