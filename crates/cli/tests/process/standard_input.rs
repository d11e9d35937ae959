//! Scenes from the standard input, and in JSON.

use std::fs::{self, File};
use std::process::Output;

use crate::folder::{BALL, Folder};

/// The ball of [`BALL`].
const IN_JSON: &str = r#"{
    "image": {"width": 600, "height": 600},
    "lens": {"Retina": {"width": 600, "distance": 100}},
    "camera": {"Free": {}},
    "lights": [{"Directional": {"toward": [-1, 1, -1]}}],
    "spheres": [{"center": [0, 0, 400], "radius": 300}],
    "animation": null
}"#;

/// Runs `marbles` with a file as its standard input.
fn run(folder: &Folder, arguments: &str, input: &str) -> Output {
    let input = File::open(folder.path(input)).unwrap();
    folder.marbles(arguments).stdin(input).output().unwrap()
}

#[test]
fn a_scene_from_the_standard_input_is_that_of_the_file() {
    let folder = Folder::new();
    fs::write(folder.path("ball.json"), IN_JSON).unwrap();
    assert!(folder.run("render ball.ron -o a.npy").status.success());
    assert!(folder.run("render ball.json -o b.npy").status.success());
    for (input, output) in [("ball.ron", "c.npy"), ("ball.json", "d.npy")] {
        let result = run(&folder, &format!("render - -o {output}"), input);
        assert!(result.status.success(), "{result:?}");
        assert_eq!(folder.read("a.npy"), folder.read(output), "{output}");
    }
    assert_eq!(folder.read("a.npy"), folder.read("b.npy"));
    // Its name is `scene`, and its tables lie in the current folder.
    fs::write(folder.path("balls.csv"), "x,y,z,radius\n0,0,400,300\n").unwrap();
    let cloud = BALL.replace(
        "spheres: [(center: (0, 0, 400), radius: 300)]",
        "clouds: [(file: \"balls.csv\")]",
    );
    fs::write(folder.path("cloud.ron"), cloud).unwrap();
    assert!(run(&folder, "render -", "cloud.ron").status.success());
    assert!(folder.run("render cloud.ron -o cloud.png").status.success());
    assert_eq!(folder.read("scene.png"), folder.read("cloud.png"));
}

#[test]
fn commands_that_read_scenes_again_refuse_the_standard_input() {
    let folder = Folder::new();
    for (arguments, input, part) in [
        (
            "farm slurm - -o a.png",
            "ball.ron",
            "which every task reads",
        ),
        (
            "preview --watch -",
            "ball.ron",
            "--watch: expected the file",
        ),
        ("render - -o a.png", "empty", "-:1:1: expected a scene"),
        ("render - -o a.png", "broken.json", "-:1:2: expected JSON"),
    ] {
        fs::write(folder.path("empty"), "").unwrap();
        fs::write(folder.path("broken.json"), "{image: 3}").unwrap();
        let result = run(&folder, arguments, input);
        let text = String::from_utf8_lossy(&result.stderr);
        assert_eq!(result.status.code(), Some(2), "{arguments}: {text}");
        assert!(text.contains(part), "{arguments}: {text}");
    }
    assert!(!folder.path("a.png").exists());
}

#[test]
fn a_sidecar_does_not_replace_a_scene_in_json() {
    let folder = Folder::new();
    fs::write(folder.path("ball.json"), IN_JSON).unwrap();
    let sidecar = folder.run("render ball.json --sidecar");
    let text = String::from_utf8_lossy(&sidecar.stderr);
    assert!(text.contains("would replace the scene"), "{text}");
    assert_eq!(folder.read("ball.json"), IN_JSON.as_bytes());
}
