//! Animated PNG, and what all loops have in common.

use std::fs::{self, File};
use std::io::BufReader;
use std::path::Path;
use std::process::Stdio;
use std::time::Duration;

use png::BitDepth;

use crate::files::run_on_file_system;
use crate::folder::{Folder, code, text};
use crate::signals::{interrupt, wait_until};

const TURN: &str = "(
    image: (width: 40, height: 30),
    lens: Fov(50),
    camera: Orbit(target: (0, 0, 0), radius: 5, elevation: 10),
    background: \"#203040\",
    lights: [Directional(toward: (-1, 1, -1), intensity: (1, 0.8, 0.5))],
    spheres: [(center: (0, 0, 0), radius: 1), (center: (1.5, 0, 0), radius: 0.5)],
    animation: Turntable(frames: 7, fps: 29.97),
)
";

/// The pictures of a file, and a description of the animation: frames, plays, delay.
struct Decoded {
    pictures: Vec<Vec<u8>>,
    animation: Option<(u32, u32, (u16, u16))>,
    depth: BitDepth,
}

fn decode(path: &Path) -> Decoded {
    let file = BufReader::new(File::open(path).unwrap());
    let mut reader = png::Decoder::new(file).read_info().unwrap();
    let control = reader.info().animation_control;
    let mut decoded = Decoded {
        pictures: Vec::new(),
        animation: None,
        depth: reader.info().bit_depth,
    };
    for _ in 0..control.map_or(1, |control| control.num_frames) {
        let mut pixels = vec![0; reader.output_buffer_size().unwrap()];
        reader.next_frame(&mut pixels).unwrap();
        decoded.pictures.push(pixels);
        decoded.animation = control.map(|control| {
            let frame = reader.info().frame_control.unwrap();
            assert_eq!((frame.x_offset, frame.y_offset), (0, 0));
            let delay = (frame.delay_num, frame.delay_den);
            (control.num_frames, control.num_plays, delay)
        });
    }
    reader.finish().unwrap();
    decoded
}

#[test]
fn a_loop_has_the_pictures_of_the_files() {
    let folder = Folder::new();
    fs::write(folder.path("turn.ron"), TURN).unwrap();
    for (name, options) in [("plain", ""), ("deep", "--alpha --bits 16")] {
        let output = folder.run(&format!("render turn.ron -o {name}.#.png {options}"));
        assert_eq!(code(&output), 0);
        let output = folder.run(&format!("render turn.ron -o {name}.apng {options}"));
        assert_eq!(code(&output), 0);
        let lines = text(&output.stdout);
        let start = format!("{name}.apng: error <= ");
        assert!(lines.starts_with(&start), "{lines}");
        assert_eq!(lines.lines().count(), 1, "{lines}");

        let animation = decode(&folder.path(&format!("{name}.apng")));
        // For ever, and each frame as long as television has it.
        assert_eq!(animation.animation, Some((7, 0, (1001, 30_000))));
        let files = (1..=7).map(|frame| decode(&folder.path(&format!("{name}.{frame}.png"))));
        let files: Vec<Decoded> = files.collect();
        assert!(files.iter().all(|file| file.depth == animation.depth));
        assert!(files.iter().all(|file| file.animation.is_none()));
        let pictures: Vec<Vec<u8>> = files.into_iter().flat_map(|file| file.pictures).collect();
        assert_ne!(pictures[0], pictures[1]);
        assert!(pictures == animation.pictures, "{name}");
    }
}

#[test]
fn frames_are_chosen_as_for_files() {
    let folder = Folder::new();
    fs::write(folder.path("turn.ron"), TURN).unwrap();
    let output = folder.run("render turn.ron -o out/turn.apng --frames 5,1-3x2 --threads 2");
    assert_eq!(code(&output), 0);
    let animation = decode(&folder.path("out/turn.apng"));
    let files = ["5", "1", "3"].map(|frame| {
        let output = folder.run(&format!("render turn.ron -o {frame}.png --frames {frame}"));
        assert_eq!(code(&output), 0);
        decode(&folder.path(&format!("{frame}.png")))
            .pictures
            .remove(0)
    });
    assert!(files.as_slice() == animation.pictures);
    // A still is a loop of one frame, or of those that are asked for.
    assert_eq!(
        code(&folder.run("render ball.ron -o ball.apng --size 9x9")),
        0
    );
    let ball = decode(&folder.path("ball.apng"));
    assert_eq!(ball.animation, Some((1, 0, (1, 24))));

    // The rate that is asked for comes before the scene's.
    let output = folder.run("render turn.ron -o fast.apng --fps 12.5 --frames 1-2 --size 9x9");
    assert_eq!(code(&output), 0);
    let fast = decode(&folder.path("fast.apng"));
    assert_eq!(fast.animation, Some((2, 0, (2, 25))));

    let output = folder.run("render turn.ron -o turn.##.apng");
    assert_eq!(code(&output), 2);
    assert_eq!(
        text(&output.stderr),
        "marbles: turn.##.apng: all frames go into one file, so its name cannot contain the frame number\n"
    );
}

/// The endings of loops.
const ENDINGS: [&str; 3] = ["apng", "gif", "webp"];

#[test]
fn loops_are_neither_resumed_nor_shared_by_tasks() {
    let folder = Folder::new();
    let one_frame = "needs one file per frame, but this output contains all frames";
    for ending in ENDINGS {
        for (arguments, message) in [
            (
                "render ball.ron --skip-existing -o turn",
                format!("--skip-existing {one_frame}"),
            ),
            (
                "render ball.ron --sidecar -o turn",
                format!("--sidecar {one_frame}"),
            ),
            (
                "render ball.ron --per-light -o turn",
                format!("--per-light {one_frame}"),
            ),
            (
                "farm slurm ball.ron -o turn",
                "a task writes one file per frame, but this output contains all frames".to_owned(),
            ),
            (
                "render roll.ron -o turn.##",
                format!(
                    "turn.##.{ending}: all frames go into one file, so its name cannot contain the frame number"
                ),
            ),
        ] {
            let output = folder.run(&format!("{arguments}.{ending}"));
            assert_eq!(code(&output), 2, "{arguments}");
            assert_eq!(text(&output.stdout), "");
            assert_eq!(text(&output.stderr), format!("marbles: {message}\n"));
        }
    }
    assert_eq!(folder.names("."), ["ball.ron"]);
}

#[test]
fn without_all_frames_there_is_no_loop() {
    let folder = Folder::new();
    // In frame 3 the camera stands at its target.
    let through = "(
    image: (width: 9, height: 9),
    lens: Fov(50),
    camera: LookAt(position: (0, 0, -2), target: (0, 0, 0)),
    animation: Keyframes(frames: (1, 5), keys: [
        (frame: 1, position: (0, 0, -2), ease: Linear),
        (frame: 5, position: (0, 0, 2)),
    ]),
)
";
    fs::write(folder.path("through.ron"), through).unwrap();
    for ending in ENDINGS {
        let name = format!("through.{ending}");
        fs::write(folder.path(&name), "what was there").unwrap();
        let output = folder.run(&format!("render through.ron -o {name}"));
        assert_eq!(code(&output), 1);
        assert_eq!(text(&output.stdout), "");
        let errors = text(&output.stderr);
        assert!(errors.contains(".ron: frame 3: "), "{errors}");
        // What comes after it is not rendered for nothing.
        for frame in [4, 5] {
            let line = format!("frame {frame}: ");
            assert!(!errors.contains(&line), "{errors}");
        }
        assert!(
            errors.ends_with("marbles: 0 of 5 frames written, failed: 3\n"),
            "{errors}"
        );
        let mut names = ["ball.ron", &*name, "through.ron"];
        names.sort_unstable();
        assert_eq!(folder.names("."), names);
        assert_eq!(folder.read(&name), b"what was there");
        fs::remove_file(folder.path(&name)).unwrap();
    }
}

#[test]
fn an_interrupted_loop_leaves_nothing() {
    for ending in ENDINGS {
        let folder = Folder::new();
        let mut child = folder
            .marbles(&format!(
                "render roll.ron -o out/a.{ending} --frames 1-600 --size 150x150 --samples 12"
            ))
            .stdout(Stdio::null())
            .stderr(Stdio::null())
            .spawn()
            .unwrap();
        let is_begun = |name: &String| folder.path("out").join(name).metadata().unwrap().len() > 0;
        wait_until("a frame", || folder.names("out").iter().any(is_begun));
        let (code, time) = interrupt(&mut child);
        assert_eq!(code, Some(130));
        assert!(time < Duration::from_secs(1), "{time:?}");
        assert!(folder.names("out").is_empty());
    }
}

#[test]
fn a_loop_that_a_disk_has_no_room_for_leaves_nothing() {
    for ending in ENDINGS {
        let folder = Folder::new();
        let arguments = format!("render roll.ron -o out/a.{ending} --frames 1-60 --size 99x99");
        let Some(output) = run_on_file_system(&folder, "size=32k", &arguments) else {
            return;
        };
        assert_eq!(code(&output), 1);
        // Where the names in the folder would be.
        assert_eq!(text(&output.stdout), "");
        let errors = text(&output.stderr);
        let expected =
            format!("marbles: out/a.{ending}: cannot write the file: no space left on device\n");
        assert!(errors.contains(&expected), "{errors}");
        // Some frames are complete in the file that is given up.
        let last = errors.lines().last().unwrap();
        assert_eq!(last, "marbles: 0 of 60 frames written, failed: 1-60");
    }
}
