//! The progress of measuring: a bar on a terminal, a line for every setting elsewhere, or nothing.

use std::time::Duration;

use indicatif::ProgressBar;

use crate::base::numbers;
use crate::terminal::bar::{bar, style};
use crate::terminal::console::Console;

/// The progress of a long measurement.
pub(super) struct Progress<'a> {
    console: &'a Console,
    quiet: bool,
    bar: Option<ProgressBar>,
}

impl<'a> Progress<'a> {
    pub(super) fn new(console: &'a Console, quiet: bool) -> Self {
        let bar = if quiet { None } else { bar(console) };
        Self {
            console,
            quiet,
            bar: bar.map(|bar| bar.with_style(style(true))),
        }
    }

    /// A picture begins.
    pub(super) fn begin(&self, name: &str, pixels: u64) {
        match &self.bar {
            Some(bar) => {
                bar.reset();
                bar.set_length(pixels);
                bar.set_message(name.to_owned());
            }
            // What comes first may take long without a word.
            None if name.starts_with("reference") => self.note(name),
            None => {}
        }
    }

    /// Some pixels are done.
    pub(super) fn advance(&self, pixels: u64) {
        if let Some(bar) = &self.bar {
            bar.inc(pixels);
        }
    }

    /// A picture that had not been rendered before is done.
    pub(super) fn picture_done(&self, name: &str, time: Duration) {
        let time = numbers::duration(time.as_secs_f64());
        self.note(&format!("{name}: {time}"));
    }

    /// All settings have been run once more.
    pub(super) fn run_done(&self, run: usize, runs: usize) {
        self.note(&format!("run {run} of {runs} done"));
    }

    /// Leaves the terminal as it was.
    pub(super) fn finish(&self) {
        if let Some(bar) = &self.bar {
            bar.finish_and_clear();
        }
    }

    /// A line in place of a bar.
    fn note(&self, line: &str) {
        if self.bar.is_none() && !self.quiet {
            self.console.note(line);
        }
    }
}
