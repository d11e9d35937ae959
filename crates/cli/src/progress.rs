//! How far the work is: a bar on a terminal, a line for each frame of a sequence elsewhere,
//! or nothing.

use std::fmt::Write;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::{Duration, Instant};

use indicatif::{ProgressBar, ProgressState, ProgressStyle};

use crate::console::Console;
use crate::failure::Failure;
use crate::loading::LINE;
use crate::numbers;

/// Shades of the bar, from full to empty.
const SHADES: &str = "█▉▊▋▌▍▎▏ ";

/// The progress of a sequence, and the way by which lines reach the user without disturbing it.
pub(crate) struct Progress<'a> {
    console: &'a Console,
    frames: u64,
    left_out: AtomicU64,
    display: Display,
}

enum Display {
    Quiet,
    Bar(ProgressBar),
    Lines { started: Instant },
}

impl<'a> Progress<'a> {
    /// Begins with none of `frames` frames done.
    pub(crate) fn new(console: &'a Console, quiet: bool, frames: u64) -> Self {
        let lines = || Display::Lines {
            started: Instant::now(),
        };
        let display = if quiet {
            Display::Quiet
        } else if console.is_interactive() {
            let bar = ProgressBar::new(0).with_style(style(frames > 1));
            // Terminals that cannot go back to the start of a line have no bars.
            if bar.is_hidden() {
                lines()
            } else {
                Display::Bar(bar)
            }
        } else {
            lines()
        };
        Self {
            console,
            frames,
            left_out: AtomicU64::new(0),
            display,
        }
    }

    /// Prepares what so many spheres are rendered with.
    pub(crate) fn while_preparing<T>(&self, spheres: usize, prepare: impl FnOnce() -> T) -> T {
        /// Fewer take no time.
        const MANY: usize = 1 << 15;
        let Display::Bar(bar) = &self.display else {
            return prepare();
        };
        if spheres < MANY {
            return prepare();
        }
        if let Ok(line) = ProgressStyle::with_template(LINE) {
            bar.set_style(line);
        }
        bar.set_message(format!("preparing {spheres} spheres"));
        bar.tick();
        prepare()
    }

    /// A frame begins, the one with this index of those that are not left out; the others are
    /// supposed to be as large.
    pub(crate) fn begin(&self, index: u64, pixels: u64) {
        if let Display::Bar(bar) = &self.display {
            let left_out = self.left_out.load(Ordering::Relaxed);
            let frames = self.frames - left_out;
            bar.set_length(frames.saturating_mul(pixels));
            bar.set_style(style(self.frames > 1));
            if index == 0 {
                // What came before tells nothing about the frames.
                bar.reset_eta();
            }
            bar.set_message(format!("frame {} of {}", left_out + index + 1, self.frames));
        }
    }

    /// A frame will not be rendered.
    pub(crate) fn leave_out(&self) {
        self.left_out.fetch_add(1, Ordering::Relaxed);
    }

    /// Some pixels are done.
    pub(crate) fn advance(&self, pixels: u64) {
        if let Display::Bar(bar) = &self.display {
            bar.inc(pixels);
        }
    }

    /// A frame's file is complete; how many were written until now, and how many skipped.
    pub(crate) fn written(&self, frame: i32, written: u64, skipped: u64) {
        if let Display::Lines { started } = &self.display {
            let frames = self.frames;
            if frames == 1 {
                // The line of results says it all.
                return;
            }
            let done = written + skipped;
            let mut line = format!("frame {frame}: {done} of {frames} done");
            if done < frames {
                let per_frame = started.elapsed().as_secs_f64() / written as f64;
                let seconds = per_frame * (frames - done) as f64;
                let left = Duration::try_from_secs_f64(seconds).unwrap_or_default();
                line.push_str(&format!(", {} left", numbers::wait(left)));
            }
            self.console.note(&line);
        }
    }

    /// A line of results.
    pub(crate) fn result(&self, line: &str) {
        if !matches!(self.display, Display::Quiet) {
            self.aside(|| self.console.result(line));
        }
    }

    /// Something that the user should know.
    pub(crate) fn warn(&self, message: &str) {
        self.aside(|| self.console.warn(message));
    }

    /// Why something was not done.
    pub(crate) fn failure(&self, failure: &Failure) {
        self.aside(|| self.console.failure(failure));
    }

    /// Leaves the terminal as it was.
    pub(crate) fn finish(&self) {
        if let Display::Bar(bar) = &self.display {
            bar.finish_and_clear();
        }
    }

    /// Prints while the bar is out of the way.
    fn aside(&self, print: impl FnOnce()) {
        match &self.display {
            Display::Bar(bar) => bar.suspend(print),
            Display::Quiet | Display::Lines { .. } => print(),
        }
    }
}

/// A bar in pixels, after a message where there is one.
pub(crate) fn style(has_message: bool) -> ProgressStyle {
    let template = if has_message {
        "{msg} {wide_bar} {percent:>3}% of {total}{left}"
    } else {
        "{wide_bar} {percent:>3}% of {total}{left}"
    };
    ProgressStyle::with_template(template)
        // Without its template the bar is plainer, no reason to stop.
        .unwrap_or_else(|_| ProgressStyle::default_bar())
        .progress_chars(SHADES)
        .with_key("total", |state: &ProgressState, text: &mut dyn Write| {
            // Writing into a string cannot fail.
            let _ = text.write_str(&numbers::pixels(state.len().unwrap_or(0)));
        })
        .with_key("left", |state: &ProgressState, text: &mut dyn Write| {
            if state.pos() > 0 {
                let _ = write!(text, ", {} left", numbers::wait(state.eta()));
            }
        })
}
