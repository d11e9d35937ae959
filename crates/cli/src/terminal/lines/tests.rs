use serde_json::{Value, json};

use super::*;
use crate::terminal::console::tests::Text;

/// A frame with this number.
fn frame(number: i32) -> Frame<'static> {
    const SUMMARY: Summary = Summary {
        pixels: 50,
        largest_error: 1e-3,
        bounds: 7,
        over_tolerance: 2,
    };
    Frame {
        number,
        path: Path::new("a\u{9b}.png"),
        time: Duration::from_millis(250),
        summary: &SUMMARY,
    }
}

/// The texts on stdout and on stderr while three frames are rendered and one is skipped.
fn tell(reader: Reader) -> (String, String) {
    let (out, err) = (Text::default(), Text::default());
    let console = Console::to(out.clone(), err.clone());
    console.speak_to(reader);
    let mut lines = Lines::new(&console, 4);
    lines.silence = Duration::ZERO;
    lines.begin(50);
    lines.advance(1);
    lines.advance(49);
    lines.written(&frame(7), 1, 0);
    lines.leave_out();
    lines.begin(50);
    lines.advance(50);
    lines.begin(50);
    lines.written(&frame(9), 1, 1);
    lines.advance(49);
    lines.advance(1);
    lines.written(&frame(-10), 2, 1);
    (out.read(), err.read())
}

/// The lines without the remaining time, which depends on the machine.
fn timeless(text: &str) -> Vec<&str> {
    let lines = text.lines();
    let cut = |line| str::split_once(line, " done, ").map_or(line, |(start, _)| start);
    lines.map(cut).collect()
}

#[test]
fn people_read_a_line_for_each_frame() {
    let (out, err) = tell(Reader::People);
    assert_eq!(out, "");
    let expected = [
        "25%",
        "frame 7: 1 of 4",
        "50%",
        "75%",
        "frame 9: 2 of 4",
        "99%",
        "100%",
        "frame -10: 3 of 4",
    ];
    assert_eq!(timeless(&err), expected);
    assert!(!err.contains(|letter: char| letter.is_control() && letter != '\n'));
}

/// Results have lines of their own, and most runs end before the first line is due.
#[test]
fn people_read_nothing_in_the_first_seconds() {
    let err = Text::default();
    let console = Console::to(Text::default(), err.clone());
    let lines = Lines::new(&console, 2);
    lines.begin(50);
    lines.advance(50);
    lines.written(&frame(1), 1, 0);
    assert_eq!(err.read(), "");
}

/// However much happens, people see at most one line per interval.
#[test]
fn people_read_one_line_after_each_silence() {
    type Step = fn(&Lines<'_>);
    let percents: Step = |lines| lines.advance(10);
    let frames: Step = |lines| lines.written(&frame(1), 1, 0);
    for (events, expected) in [
        ([percents, percents], ["10%", "30%"]),
        ([frames, frames], ["frame 1: 1 of 2", "frame 1: 1 of 2"]),
        ([percents, frames], ["10%", "20%"]),
        ([frames, percents], ["frame 1: 1 of 2", "frame 1: 1 of 2"]),
    ] {
        let err = Text::default();
        let console = Console::to(Text::default(), err.clone());
        let lines = Lines::new(&console, 2);
        lines.begin(50);
        for (silence, line) in expected.into_iter().enumerate() {
            lines.told.lock().unwrap().at -= SILENCE;
            for event in events {
                event(&lines);
            }
            let text = err.read();
            assert_eq!(timeless(&text), expected[..=silence], "{line}");
        }
    }
}

#[test]
fn runners_of_open_job_description_read_whole_percents() {
    let (out, err) = tell(Reader::OpenJd);
    assert_eq!(err, "");
    let expected = [
        "openjd_progress: 25",
        "openjd_status: frame 7: 1 of 4",
        "openjd_progress: 50",
        "openjd_progress: 75",
        "openjd_status: frame 9: 2 of 4",
        "openjd_progress: 99",
        "openjd_progress: 100",
        "openjd_status: frame -10: 3 of 4",
    ];
    assert_eq!(timeless(&out), expected);
}

#[test]
fn programs_read_an_object_a_line() {
    let (out, err) = tell(Reader::Json);
    assert_eq!(out, "");
    let events = err.lines().map(|line| {
        let mut event: Value = serde_json::from_str(line).unwrap();
        let left = event.as_object_mut().unwrap().remove("seconds_left");
        assert!(left.is_none_or(|left| left.as_f64().is_some_and(|left| left >= 0.0)));
        event
    });
    let percent = |percent: u64| json!({ "event": "progress", "percent": percent });
    let frame = |frame: i32, done: u64| {
        json!({
            "event": "frame", "frame": frame, "path": "a\u{9b}.png", "seconds": 0.25, "error": 1e-3, "over": 2,
            "done": done, "frames": 4
        })
    };
    let expected = [
        percent(25),
        frame(7, 1),
        percent(50),
        percent(75),
        frame(9, 2),
        percent(99),
        percent(100),
        frame(-10, 3),
    ];
    assert_eq!(events.collect::<Vec<Value>>(), expected);
}

/// Parts of pictures may be computed from more pixels than they have.
#[test]
fn nothing_is_more_than_done() {
    let out = Text::default();
    let console = Console::to(out.clone(), Text::default());
    console.speak_to(Reader::OpenJd);
    let lines = Lines::new(&console, 1);
    lines.begin(50);
    lines.advance(60);
    lines.advance(60);
    assert_eq!(out.read(), "openjd_progress: 100\n");
}

#[test]
fn frames_that_are_all_left_out_are_done() {
    let out = Text::default();
    let console = Console::to(out.clone(), Text::default());
    console.speak_to(Reader::OpenJd);
    let lines = Lines::new(&console, 2);
    lines.leave_out();
    lines.leave_out();
    assert_eq!(out.read(), "openjd_progress: 50\nopenjd_progress: 100\n");
}
