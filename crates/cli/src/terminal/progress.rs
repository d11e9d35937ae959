//! The progress of a sequence: a bar on a terminal, lines elsewhere, or nothing.

use std::sync::atomic::{AtomicU64, Ordering};

use clap::ValueEnum;
use indicatif::ProgressBar;

use super::bar::{bar, show_line, style};
use super::console::{Console, Reader};
use super::lines::{Frame, Lines};
use crate::base::failure::Failure;

/// A form of progress, for people or programs.
#[derive(Clone, Copy, Debug, Eq, PartialEq, ValueEnum)]
pub(crate) enum ProgressForm {
    /// Lines on stdout for runners of Open Job Description
    #[value(name = "openjd")]
    OpenJd,
    /// A JSON object per line on stderr
    Json,
    /// A line on stderr at most every five seconds
    Plain,
    /// Nothing
    None,
}

impl ProgressForm {
    /// The reader of messages in this form.
    pub(crate) fn reader(self) -> Reader {
        match self {
            Self::OpenJd => Reader::OpenJd,
            Self::Json => Reader::Json,
            Self::Plain | Self::None => Reader::People,
        }
    }
}

/// The progress of a sequence. Lines for the user are printed without disturbing it.
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
    /// The form is the requested one. Otherwise there is nothing if `quiet`, a bar on a terminal, and lines elsewhere.
    pub(crate) fn new(
        console: &'a Console,
        form: Option<ProgressForm>,
        quiet: bool,
        frames: u64,
    ) -> Self {
        let display = match form {
            Some(ProgressForm::None) => Display::Nothing,
            Some(_) => Display::Lines(Lines::new(console, frames)),
            None if quiet => Display::Nothing,
            None => match bar(console) {
                Some(bar) => Display::Bar(bar.with_style(style(frames > 1))),
                None => Display::Lines(Lines::new(console, frames)),
            },
        };
        Self {
            console,
            quiet,
            frames,
            left_out: AtomicU64::new(0),
            display,
        }
    }

    /// The preparation of a number of spheres begins.
    pub(crate) fn prepare(&self, spheres: usize) {
        /// Fewer spheres take no noticeable time.
        const MANY: usize = 1 << 15;
        if let Display::Bar(bar) = &self.display
            && spheres >= MANY
        {
            show_line(bar, format!("preparing {spheres} spheres"));
        }
    }

    /// A frame begins; its index does not count skipped frames. The other frames are assumed to have the same size.
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

    /// A frame is complete; so far this many were written and skipped.
    pub(crate) fn written(&self, frame: &Frame<'_>, written: u64, skipped: u64) {
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

    /// A warning.
    pub(crate) fn warn(&self, message: &str) {
        self.aside(|| self.console.warn(message));
    }

    /// The reason for a failure.
    pub(crate) fn failure(&self, failure: &Failure) {
        self.aside(|| self.console.failure(failure));
    }

    /// Leaves the terminal as it was.
    pub(crate) fn finish(&self) {
        if let Display::Bar(bar) = &self.display {
            bar.finish_and_clear();
        }
    }

    /// Prints while the bar is hidden.
    fn aside(&self, print: impl FnOnce()) {
        match &self.display {
            Display::Bar(bar) => bar.suspend(print),
            Display::Nothing | Display::Lines(_) => print(),
        }
    }
}
