//! Progress in the different forms.

use std::fs;

use serde_json::Value;

use crate::folder::{BALL, Folder, code, text};

const ARGUMENTS: &str = "render roll.ron -o #.png --size 9x9 --frames 1-3";

#[test]
fn runners_of_open_job_description_read_stdout() {
    let folder = Folder::new();
    let output = folder.run(&format!("{ARGUMENTS} --progress=openjd"));
    assert_eq!((code(&output), text(&output.stderr)), (0, String::new()));
    let all = text(&output.stdout);
    assert_eq!(all.matches("\nopenjd_progress: 100\n").count(), 1, "{all}");
    assert!(all.contains("\nopenjd_status: frame 3: 3 of 3 done\n"));
    assert_eq!(all.matches(".png: ").count(), 3);

    let output = folder.run(&format!("{ARGUMENTS} --progress=openjd --quiet"));
    let lines = text(&output.stdout);
    assert!(
        lines.lines().all(|line| line.starts_with("openjd_")),
        "{lines}"
    );
    assert!(lines.contains("openjd_progress: 100\n"));

    for (arguments, expected, exit_code) in [
        ("render no.ron", "openjd_fail: no.ron: no such file\n", 2),
        (
            "render ball.ron -o a.bmp",
            "openjd_fail: expected a file name",
            2,
        ),
        (
            "render huge.ron --size 9x9",
            "openjd_fail: some pixels are over",
            3,
        ),
    ] {
        let huge = BALL.replace("(0, 0, 400), radius: 300", "(0, 0, 4e200), radius: 3e200");
        fs::write(folder.path("huge.ron"), huge).unwrap();
        let output = folder.run(&format!("{arguments} --progress=openjd --quiet"));
        assert_eq!(code(&output), exit_code);
        let lines = text(&output.stdout);
        assert_eq!(lines.matches("openjd_fail").count(), 1, "{lines}");
        assert!(lines.contains(expected), "{lines}");
    }
}

/// Existing frames and failed frames count as done.
#[test]
fn progress_comes_to_an_end_whatever_becomes_of_frames() {
    let folder = Folder::new();
    let animation = "camera: LookAt(position: (0, 0, -2), target: (0, 0, 0)),
    animation: Keyframes(frames: (1, 4), keys: [
        (frame: 1, position: (0, 0, -2), ease: Linear), (frame: 3, position: (0, 0, 2)),
    ])";
    let through = BALL.replace("camera: Free()", animation);
    fs::write(folder.path("through.ron"), through).unwrap();
    let render = "render through.ron -o #.png --size 9x9 --skip-existing --progress=openjd";
    let output = folder.run(&format!("{render} --frames 1"));
    assert_eq!(code(&output), 0);
    let output = folder.run(render);
    assert_eq!(code(&output), 1);
    let lines = text(&output.stdout);
    let percents = lines
        .lines()
        .filter_map(|line| line.strip_prefix("openjd_progress: "));
    let percents: Vec<u32> = percents.map(|percent| percent.parse().unwrap()).collect();
    assert!(percents.is_sorted_by(|one, next| one < next), "{lines}");
    assert_eq!((percents[0], percents.last()), (25, Some(&100)), "{lines}");
    // The frame that was skipped is done, the one that failed is not.
    let status: Vec<&str> = lines
        .lines()
        .filter_map(|line| line.strip_prefix("openjd_status: "))
        .collect();
    assert!(status[0].starts_with("frame 3: 2 of 4 done, "), "{lines}");
    assert!(status[1].starts_with("frame 4: 3 of 4 done, "), "{lines}");
}

#[test]
fn programs_read_json_on_stderr() {
    let folder = Folder::new();
    let events = |arguments: &str| {
        let output = folder.run(&format!("{arguments} --progress=json"));
        let lines = text(&output.stderr);
        let events = lines
            .lines()
            .map(|line| serde_json::from_str(line).unwrap());
        (text(&output.stdout), events.collect::<Vec<Value>>())
    };
    let (results, events_of_frames) = events(ARGUMENTS);
    assert_eq!(results.lines().count(), 4);
    let named = |name| {
        let events = events_of_frames.iter();
        events.filter(move |event| event["event"] == name)
    };
    let frames: Vec<i64> = named("frame")
        .filter_map(|event| event["frame"].as_i64())
        .collect();
    assert_eq!(frames, [1, 2, 3]);
    for (event, path) in named("frame").zip(["1.png", "2.png", "3.png"]) {
        assert_eq!((&event["path"], &event["over"]), (&path.into(), &0.into()));
        assert!(event["seconds"].as_f64().is_some_and(|time| time >= 0.0));
        assert!(event["error"].as_f64().is_some_and(|error| error <= 1e-3));
    }
    assert_eq!(named("progress").next_back().unwrap()["percent"], 100);

    let (results, errors) = events("render no.ron");
    assert_eq!((results.as_str(), errors.len()), ("", 1));
    assert_eq!(errors[0]["event"], "error");
    assert_eq!(errors[0]["message"], "no.ron: no such file");
}

#[test]
fn lines_for_people_are_not_for_programs() {
    let folder = Folder::new();
    let stderr = |form: &str| {
        let output = folder.run(&format!("{ARGUMENTS} {form}"));
        assert_eq!(code(&output), 0);
        text(&output.stderr)
    };
    // Before five seconds are over nothing is told but results.
    for form in [
        "",
        "--progress=plain",
        "--progress=plain --quiet",
        "--progress=none",
        "--quiet",
    ] {
        assert_eq!(stderr(form), "", "{form}");
    }
}
