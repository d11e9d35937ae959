//! Progress as lines, for logs and for programs.

use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Mutex, PoisonError};
use std::time::{Duration, Instant};

use serde::Serialize;

use crate::base::numbers;
use crate::terminal::console::Console;

/// How long a log stays silent while a frame takes long.
const SILENCE: Duration = Duration::from_secs(30);

/// What reads the lines.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub(super) enum Reader {
    /// People, in a log: a line for each frame, and now and then one where frames take longer.
    People,
    /// Programs that read JSON.
    Json,
    /// Runners of Open Job Description.
    OpenJd,
}

/// Counts what is done, and says so.
pub(super) struct Lines<'a> {
    console: &'a Console,
    reader: Reader,
    frames: u64,
    started: Instant,
    /// Pixels of a frame, as soon as one begins; frames are supposed to be as large.
    pixels: AtomicU64,
    rendered: AtomicU64,
    left_out: AtomicU64,
    told: Mutex<Told>,
}

/// The last line.
struct Told {
    percent: u64,
    at: Instant,
}

/// A line of JSON.
#[derive(Serialize)]
#[serde(tag = "event", rename_all = "snake_case")]
enum Event {
    Progress {
        percent: u64,
        #[serde(skip_serializing_if = "Option::is_none")]
        seconds_left: Option<f64>,
    },
    Frame {
        frame: i32,
        done: u64,
        frames: u64,
    },
}

impl<'a> Lines<'a> {
    /// Begins with none of `frames` frames done.
    pub(super) fn new(console: &'a Console, reader: Reader, frames: u64) -> Self {
        let started = Instant::now();
        Self {
            console,
            reader,
            frames,
            started,
            pixels: AtomicU64::new(0),
            rendered: AtomicU64::new(0),
            left_out: AtomicU64::new(0),
            told: Mutex::new(Told {
                percent: 0,
                at: started,
            }),
        }
    }

    /// A frame of so many pixels begins.
    pub(super) fn begin(&self, pixels: u64) {
        self.pixels.store(pixels, Ordering::Relaxed);
    }

    /// A frame will not be rendered.
    pub(super) fn leave_out(&self) {
        self.left_out.fetch_add(1, Ordering::Relaxed);
        self.advance(0);
    }

    /// Some pixels are done.
    pub(super) fn advance(&self, pixels: u64) {
        let before = self.rendered.fetch_add(pixels, Ordering::Relaxed);
        let rendered = before + pixels;
        let percent = self.percent(rendered);
        let silence = match self.reader {
            Reader::People => SILENCE,
            Reader::Json | Reader::OpenJd => Duration::ZERO,
        };
        // Lines come in order because nobody prints without this lock.
        let mut told = self.told.lock().unwrap_or_else(PoisonError::into_inner);
        if percent > told.percent && told.at.elapsed() >= silence {
            told.percent = percent;
            self.tell_percent(percent, self.left(rendered));
            told.at = Instant::now();
        }
    }

    /// A frame's file is complete; how many were written until now, and how many skipped.
    pub(super) fn written(&self, frame: i32, written: u64, skipped: u64) {
        let frames = self.frames;
        let done = written + skipped;
        let mut told = self.told.lock().unwrap_or_else(PoisonError::into_inner);
        match self.reader {
            // The line of results says it all.
            Reader::People if frames == 1 => {}
            Reader::People => self.console.note(&self.story(frame, written, done)),
            Reader::OpenJd => {
                let story = self.story(frame, written, done);
                self.console.result(&format!("openjd_status: {story}"));
            }
            Reader::Json => self.console.event(&Event::Frame {
                frame,
                done,
                frames,
            }),
        }
        told.at = Instant::now();
    }

    fn story(&self, frame: i32, written: u64, done: u64) -> String {
        let frames = self.frames;
        let mut line = format!("frame {frame}: {done} of {frames} done");
        if done < frames {
            let per_frame = self.started.elapsed().as_secs_f64() / written as f64;
            let seconds = per_frame * (frames - done) as f64;
            let left = Duration::try_from_secs_f64(seconds).unwrap_or_default();
            line.push_str(&format!(", {} left", numbers::wait(left)));
        }
        line
    }

    fn tell_percent(&self, percent: u64, left: Option<Duration>) {
        match self.reader {
            Reader::People => {
                let left = left.map_or(String::new(), |left| {
                    format!(", {} left", numbers::wait(left))
                });
                self.console.note(&format!("{percent}% done{left}"));
            }
            Reader::OpenJd => self.console.result(&format!("openjd_progress: {percent}")),
            Reader::Json => self.console.event(&Event::Progress {
                percent,
                seconds_left: left.map(|left| left.as_millis() as f64 / 1e3),
            }),
        }
    }

    /// Whole percents of all frames, those that are left out counted as done.
    fn percent(&self, rendered: u64) -> u64 {
        let pixels = u128::from(self.pixels.load(Ordering::Relaxed).max(1));
        let done = u128::from(self.left_out.load(Ordering::Relaxed)) * pixels;
        let percent = 100 * (done + u128::from(rendered)) / (u128::from(self.frames) * pixels);
        percent.min(100) as u64
    }

    /// The time that the other frames will take, as far as that is known.
    fn left(&self, rendered: u64) -> Option<Duration> {
        let pixels = self.pixels.load(Ordering::Relaxed);
        let frames = self.frames - self.left_out.load(Ordering::Relaxed).min(self.frames);
        let missing = frames.saturating_mul(pixels).saturating_sub(rendered);
        let seconds = self.started.elapsed().as_secs_f64() * missing as f64 / rendered as f64;
        Duration::try_from_secs_f64(seconds).ok()
    }
}

#[cfg(test)]
mod tests {
    use serde_json::{Value, json};

    use super::*;
    use crate::terminal::console::tests::Text;

    /// What goes to stdout and to stderr while three frames are rendered, one is left out.
    fn tell(reader: Reader) -> (String, String) {
        let (out, err) = (Text::default(), Text::default());
        let console = Console::to(out.clone(), err.clone());
        let lines = Lines::new(&console, reader, 4);
        lines.begin(50);
        lines.advance(1);
        lines.advance(49);
        lines.written(7, 1, 0);
        lines.leave_out();
        lines.begin(50);
        lines.advance(50);
        lines.begin(50);
        lines.written(9, 1, 1);
        lines.advance(49);
        lines.advance(1);
        lines.written(-10, 2, 1);
        (out.read(), err.read())
    }

    /// Without the time that is left, which depends on the machine.
    fn timeless(text: &str) -> Vec<&str> {
        let lines = text.lines();
        let cut = |line| str::split_once(line, " done, ").map_or(line, |(start, _)| start);
        lines.map(cut).collect()
    }

    #[test]
    fn people_read_a_line_for_each_frame() {
        let (out, err) = tell(Reader::People);
        assert_eq!(out, "");
        let expected = ["frame 7: 1 of 4", "frame 9: 2 of 4", "frame -10: 3 of 4"];
        assert_eq!(timeless(&err), expected);
        assert!(!err.contains(|letter: char| letter.is_control() && letter != '\n'));
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
        let frame = |frame: i32, done: u64| json!({ "event": "frame", "frame": frame, "done": done, "frames": 4 });
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

    /// Parts of pictures may be rendered from more pixels than they have.
    #[test]
    fn nothing_is_more_than_done() {
        let out = Text::default();
        let console = Console::to(out.clone(), Text::default());
        let lines = Lines::new(&console, Reader::OpenJd, 1);
        lines.begin(50);
        lines.advance(60);
        lines.advance(60);
        assert_eq!(out.read(), "openjd_progress: 100\n");
    }

    #[test]
    fn frames_that_are_all_left_out_are_done() {
        let out = Text::default();
        let console = Console::to(out.clone(), Text::default());
        let lines = Lines::new(&console, Reader::OpenJd, 2);
        lines.leave_out();
        lines.leave_out();
        assert_eq!(out.read(), "openjd_progress: 50\nopenjd_progress: 100\n");
    }
}
