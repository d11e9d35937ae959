//! Frames that a scene does not have, or that have no view.

use std::fs;

use crate::folder::{BALL, Folder, code, text};

#[test]
fn frames_that_cannot_be_rendered_do_not_stop_the_others() {
    const THROUGH: &str = "(
    image: (width: 9, height: 9),
    lens: Fov(50),
    camera: LookAt(position: (0, 0, -2), target: (0, 0, 0)),
    ambient: 1,
    spheres: [(center: (0, 0, 5), radius: 1)],
    animation: Keyframes(frames: (1, 3), keys: [
        (frame: 1, position: (0, 0, -2), ease: Linear),
        (frame: 3, position: (0, 0, 2)),
    ]),
)
";
    let folder = Folder::new();
    fs::write(folder.path("through.ron"), THROUGH).unwrap();
    let output = folder.run("render through.ron");
    assert_eq!(code(&output), 1);
    let pictures = ["through.0001.png", "through.0003.png"];
    let expected = [&["ball.ron"], &pictures[..], &["through.ron"]].concat();
    assert_eq!(folder.names("."), expected);
    let errors = text(&output.stderr);
    assert!(
        errors.starts_with("marbles: through.ron: frame 2: "),
        "{errors}"
    );
    assert!(
        errors.ends_with("marbles: 2 of 3 frames written, failed: 2\n"),
        "{errors}"
    );
    let output = folder.run("render through.ron --fail-fast --skip-existing");
    assert_eq!(code(&output), 1);
    assert_eq!(text(&output.stdout).lines().count(), 1);
    let errors = text(&output.stderr);
    let last = "marbles: 0 of 3 frames written, 1 skipped, failed: 2\n";
    assert!(errors.ends_with(last), "{errors}");

    // Another reason is told as well, and a frame alone needs no summary.
    fs::remove_file(folder.path("through.0003.png")).unwrap();
    fs::create_dir(folder.path("through.0003.png")).unwrap();
    let output = folder.run("render through.ron");
    assert_eq!(code(&output), 1);
    let errors = text(&output.stderr);
    for part in [
        "marbles: through.ron: frame 2: ",
        "marbles: through.0003.png: cannot write the file: a folder has this name\n",
    ] {
        assert_eq!(errors.matches(part).count(), 1, "{errors}");
    }
    let last = "marbles: 1 of 3 frames written, failed: 2-3\n";
    assert!(errors.ends_with(last), "{errors}");
    let output = folder.run("render through.ron --frames 2 -o alone.png");
    assert_eq!(code(&output), 1);
    let errors = text(&output.stderr);
    assert!(
        errors.starts_with("marbles: through.ron: frame 2: "),
        "{errors}"
    );
    assert!(!errors.contains(" frames written"), "{errors}");

    let output = folder.run("check through.ron");
    assert_eq!(code(&output), 2);
    let errors = text(&output.stderr);
    let start = "marbles: through.ron: frame 2: ";
    assert!(errors.starts_with(start), "{errors}");

    // Only the frame in the middle has no view, and there are too many to look at all.
    for (last, expected) in [(99_999, 2), (999_999, 0)] {
        let far = THROUGH
            .replace("frame: 3", &format!("frame: {last}"))
            .replace("(1, 3)", &format!("(1, {last})"));
        fs::write(folder.path("far.ron"), far).unwrap();
        let output = folder.run("check far.ron");
        assert_eq!(code(&output), expected, "{last} frames");
        let all = !text(&output.stdout).contains("100000 of 999999 were checked\n");
        assert_eq!(all, last < 100_000);
    }
}

#[test]
fn stills_without_a_view_are_refused_by_all_commands() {
    let folder = Folder::new();
    let scene = "(image: (width: 9, height: 9), lens: Fov(50), camera: Frame(), ambient: 1,
        spheres: [(center: (0, 0, 0), radius: 1e308)])";
    fs::write(folder.path("far.ron"), scene).unwrap();
    fs::write(
        folder.path("turn.ron"),
        scene.replace("ambient", "animation: Turntable(), ambient"),
    )
    .unwrap();
    for command in [
        "check far.ron",
        "check far.ron --json",
        "render far.ron",
        "preview far.ron",
        "spheres far.ron",
        "report far.ron",
        "farm slurm far.ron -o far.png",
        "check turn.ron",
        "spheres turn.ron",
        "farm openjd turn.ron -o far.#.png",
    ] {
        let output = folder.run(command);
        let errors = text(&output.stderr);
        assert_eq!(code(&output), 2, "{command}: {errors}");
        assert!(
            errors.contains(".ron: frame 1: the camera is infinitely far away"),
            "{command}: {errors}"
        );
    }
}

#[test]
fn frames_that_a_scene_does_not_have_are_refused() {
    let folder = Folder::new();
    let turn = BALL.replace(
        "camera: Free()",
        "camera: Orbit(target: (0, 0, 0), radius: 900), animation: Turntable(frames: 12)",
    );
    fs::write(folder.path("turn.ron"), turn).unwrap();
    for (scene, frames, expected) in [
        ("ball", "1-10", "1, the only frame of the scene, found 2"),
        ("ball", "7", "1, the only frame of the scene, found 7"),
        (
            "turn",
            "3,200",
            "a frame of the scene, from 1 to 12, found 200",
        ),
        (
            "turn",
            "12-0:-1",
            "a frame of the scene, from 1 to 12, found 0",
        ),
        (
            "roll",
            "-10",
            "a frame of the scene, from -9 to 20100, found -10",
        ),
    ] {
        for command in ["render", "spheres", "farm openjd", "farm slurm"] {
            let arguments = format!("{command} {scene}.ron -o out/a.# --frames={frames}");
            let ending = if command == "spheres" { "csv" } else { "png" };
            let output = folder.run(&arguments.replace("a.#", &format!("a.#.{ending}")));
            let said = format!("marbles: --frames: expected {expected}\n");
            assert_eq!(text(&output.stderr), said, "{arguments}");
            assert_eq!(code(&output), 2, "{arguments}");
            assert!(!folder.path("out").exists(), "{arguments}");
        }
    }
}
