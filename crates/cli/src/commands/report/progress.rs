//! The progress of measuring: a bar on a terminal, a line for every setting elsewhere, or nothing.

use std::time::Duration;

use indicatif::ProgressBar;

use crate::base::numbers;
use crate::terminal::bar::{bar, style};
use crate::terminal::console::Console;

/// The progress of a long measurement.
pub(super) struct Progress<'a> {
    console: &'a Console,
    display: Display,
}

enum Display {
    Quiet,
    Bar(ProgressBar),
    Lines,
}

impl<'a> Progress<'a> {
    pub(super) fn new(console: &'a Console, quiet: bool) -> Self {
        let bar = if quiet { None } else { bar(console) };
        let display = match bar {
            Some(bar) => Display::Bar(bar.with_style(style(true))),
            None if quiet => Display::Quiet,
            None => Display::Lines,
        };
        Self { console, display }
    }

    /// A picture begins.
    pub(super) fn begin(&self, name: &str, pixels: u64) {
        match &self.display {
            Display::Bar(bar) => {
                bar.reset();
                bar.set_length(pixels);
                bar.set_message(name.to_owned());
            }
            // What comes first may take long without a word.
            Display::Lines if name.starts_with("reference") => self.console.note(name),
            Display::Lines | Display::Quiet => {}
        }
    }

    /// Some pixels are done.
    pub(super) fn advance(&self, pixels: u64) {
        if let Display::Bar(bar) = &self.display {
            bar.inc(pixels);
        }
    }

    /// A picture is done that was not rendered before.
    pub(super) fn picture_done(&self, name: &str, time: Duration) {
        if let Display::Lines = &self.display {
            let time = numbers::duration(time.as_secs_f64());
            self.console.note(&format!("{name}: {time}"));
        }
    }

    /// All settings were run once more.
    pub(super) fn run_done(&self, run: usize, runs: usize) {
        if let Display::Lines = &self.display {
            self.console.note(&format!("run {run} of {runs} done"));
        }
    }

    /// Leaves the terminal as it was.
    pub(super) fn finish(&self) {
        if let Display::Bar(bar) = &self.display {
            bar.finish_and_clear();
        }
    }
}
