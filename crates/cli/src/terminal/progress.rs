//! How far the work is: a bar on a terminal, lines elsewhere, or nothing.

mod lines;

use std::fmt::Write;
use std::sync::atomic::{AtomicU64, Ordering};

use indicatif::{ProgressBar, ProgressState, ProgressStyle};

use self::lines::{Lines, Reader};
use crate::base::failure::Failure;
use crate::base::numbers;
use crate::commands::args::ProgressForm;
use crate::commands::scene::LINE;
use crate::terminal::console::Console;

/// Two columns at the end of the line, and the way back before them: there terminals show `^C`, which
/// would else begin another line, and the bar would stay where it was.
const ROOM: &str = "  \x1b[2D";

/// Shades of the bar, from full to empty.
const SHADES: &str = "█▉▊▋▌▍▎▏ ";

/// The progress of a sequence, and the way by which lines reach the user without disturbing it.
pub(crate) struct Progress<'a> {
    console: &'a Console,
    quiet: bool,
    frames: u64,
    left_out: AtomicU64,
    display: Display<'a>,
}

enum Display<'a> {
    Nothing,
    Bar(ProgressBar),
    Lines(Lines<'a>),
}

impl<'a> Progress<'a> {
    /// Begins with none of `frames` frames done.
    ///
    /// In the form that is asked for; else where the user wants it `quiet` there is nothing, on a
    /// terminal a bar, and lines elsewhere.
    pub(crate) fn new(
        console: &'a Console,
        form: Option<ProgressForm>,
        quiet: bool,
        frames: u64,
    ) -> Self {
        let lines = |reader| Display::Lines(Lines::new(console, reader, frames));
        let display = match form {
            Some(ProgressForm::OpenJd) => lines(Reader::OpenJd),
            Some(ProgressForm::Json) => lines(Reader::Json),
            Some(ProgressForm::Plain) => lines(Reader::People),
            Some(ProgressForm::None) => Display::Nothing,
            None if quiet => Display::Nothing,
            None if console.is_interactive() => {
                let bar = ProgressBar::new(0).with_style(style(frames > 1));
                // Terminals that cannot go back to the start of a line have no bars.
                if bar.is_hidden() {
                    lines(Reader::People)
                } else {
                    Display::Bar(bar)
                }
            }
            None => lines(Reader::People),
        };
        Self {
            console,
            quiet,
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
        match &self.display {
            Display::Bar(bar) => {
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
            Display::Lines(lines) => lines.begin(pixels),
            Display::Nothing => {}
        }
    }

    /// A frame will not be rendered.
    pub(crate) fn leave_out(&self) {
        self.left_out.fetch_add(1, Ordering::Relaxed);
        if let Display::Lines(lines) = &self.display {
            lines.leave_out();
        }
    }

    /// Some pixels are done.
    pub(crate) fn advance(&self, pixels: u64) {
        match &self.display {
            Display::Bar(bar) => bar.inc(pixels),
            Display::Lines(lines) => lines.advance(pixels),
            Display::Nothing => {}
        }
    }

    /// A frame's file is complete; how many were written until now, and how many skipped.
    pub(crate) fn written(&self, frame: i32, written: u64, skipped: u64) {
        if let Display::Lines(lines) = &self.display {
            lines.written(frame, written, skipped);
        }
    }

    /// A line of results.
    pub(crate) fn result(&self, line: &str) {
        if !self.quiet {
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
            Display::Nothing | Display::Lines(_) => print(),
        }
    }
}

/// A bar in pixels, after a message where there is one.
pub(crate) fn style(has_message: bool) -> ProgressStyle {
    let message = if has_message { "{msg} " } else { "" };
    let template = format!("{message}{{wide_bar}} {{percent:>3}}% of {{total}}{{left}}{ROOM}");
    ProgressStyle::with_template(&template)
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
