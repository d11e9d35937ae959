//! Progress as lines, for logs and for programs.

use std::borrow::Cow;
use std::path::Path;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Mutex, PoisonError};
use std::time::{Duration, Instant};

use marbles_core::Summary;
use serde::Serialize;

use super::console::{Console, Reader};
use crate::base::numbers;

/// The minimum time between lines for people: results have lines of their own.
const SILENCE: Duration = Duration::from_secs(5);

/// Counts the progress, and prints it.
pub(super) struct Lines<'a> {
    console: &'a Console,
    frames: u64,
    started: Instant,
    /// The number of pixels per frame, known when the first one begins; all frames are assumed to have the same size.
    pixels: AtomicU64,
    rendered: AtomicU64,
    left_out: AtomicU64,
    told: Mutex<Told>,
    /// The minimum time between lines for people.
    silence: Duration,
}

/// A complete frame.
pub(crate) struct Frame<'a> {
    pub(crate) number: i32,
    /// Its file, which may contain all frames of an animation.
    pub(crate) path: &'a Path,
    /// The rendering time.
    pub(crate) time: Duration,
    pub(crate) summary: &'a Summary,
}

impl Frame<'_> {
    /// The JSON object for it.
    fn event(&self, done: u64, frames: u64) -> String {
        let error = self.summary.largest_error;
        let event = Event {
            event: "frame",
            frame: self.number,
            path: self.path.to_string_lossy(),
            seconds: self.time.as_secs_f64(),
            error: error.is_finite().then_some(error),
            over: self.summary.over_tolerance,
            done,
            frames,
        };
        // Numbers and texts can be told.
        serde_json::to_string(&event).unwrap_or_default()
    }
}

/// The report about a frame, for programs.
#[derive(Serialize)]
struct Event<'a> {
    event: &'static str,
    frame: i32,
    path: Cow<'a, str>,
    seconds: f64,
    /// `None` if it is unknown.
    error: Option<f64>,
    over: u64,
    done: u64,
    frames: u64,
}

/// The previous line.
struct Told {
    percent: u64,
    at: Instant,
}

impl<'a> Lines<'a> {
    /// Begins with none of `frames` frames done.
    pub(super) fn new(console: &'a Console, frames: u64) -> Self {
        let started = Instant::now();
        Self {
            console,
            frames,
            started,
            pixels: AtomicU64::new(0),
            rendered: AtomicU64::new(0),
            left_out: AtomicU64::new(0),
            told: Mutex::new(Told {
                percent: 0,
                at: started,
            }),
            silence: SILENCE,
        }
    }

    /// A frame with this number of pixels begins.
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
        let silence = match self.console.reader() {
            Reader::People => self.silence,
            Reader::Json | Reader::OpenJd => Duration::ZERO,
        };
        // Lines come in order because no thread prints without this lock.
        let mut told = self.told.lock().unwrap_or_else(PoisonError::into_inner);
        if percent > told.percent && told.at.elapsed() >= silence {
            told.percent = percent;
            self.tell_percent(percent, self.left(rendered));
            told.at = Instant::now();
        }
    }

    /// A frame is complete; so far this many were written and skipped.
    pub(super) fn written(&self, frame: &Frame<'_>, written: u64, skipped: u64) {
        let done = written + skipped;
        let mut told = self.told.lock().unwrap_or_else(PoisonError::into_inner);
        match self.console.reader() {
            Reader::People if told.at.elapsed() < self.silence => return,
            Reader::People => self.console.note(&self.story(frame.number, written, done)),
            Reader::OpenJd => {
                let story = self.story(frame.number, written, done);
                self.console.result(&format!("openjd_status: {story}"));
            }
            Reader::Json => self.console.note(&frame.event(done, self.frames)),
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
        match self.console.reader() {
            Reader::People => {
                let left = left.map_or(String::new(), |left| {
                    format!(", {} left", numbers::wait(left))
                });
                self.console.note(&format!("{percent}% done{left}"));
            }
            Reader::OpenJd => self.console.result(&format!("openjd_progress: {percent}")),
            Reader::Json => {
                let left = left.map_or(String::new(), |left| {
                    // In any case with a point.
                    format!(r#","seconds_left":{:?}"#, left.as_millis() as f64 / 1e3)
                });
                let event = format!(r#"{{"event":"progress","percent":{percent}{left}}}"#);
                self.console.note(&event);
            }
        }
    }

    /// The progress of all frames in whole percents; skipped frames count as done.
    fn percent(&self, rendered: u64) -> u64 {
        let pixels = u128::from(self.pixels.load(Ordering::Relaxed).max(1));
        let done = u128::from(self.left_out.load(Ordering::Relaxed)) * pixels;
        let percent = 100 * (done + u128::from(rendered)) / (u128::from(self.frames) * pixels);
        percent.min(100) as u64
    }

    /// The estimated time for the remaining frames, if it is known.
    fn left(&self, rendered: u64) -> Option<Duration> {
        let pixels = self.pixels.load(Ordering::Relaxed);
        let frames = self.frames - self.left_out.load(Ordering::Relaxed).min(self.frames);
        let missing = frames.saturating_mul(pixels).saturating_sub(rendered);
        let seconds = self.started.elapsed().as_secs_f64() * missing as f64 / rendered as f64;
        Duration::try_from_secs_f64(seconds).ok()
    }
}

#[cfg(test)]
mod tests;
