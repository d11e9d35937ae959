//! Where the user reads: results on stdout, all else on stderr.

use std::env;
use std::io::{self, ErrorKind, IsTerminal, Write};
use std::sync::{Mutex, OnceLock, PoisonError};

use clap::builder::StyledStr;

use crate::failure::{Failure, reason};

const BOLD_RED: &str = "\x1b[1;31m";
const BOLD_YELLOW: &str = "\x1b[1;33m";
const RESET: &str = "\x1b[0m";

/// The two streams, shared by threads.
///
/// Printing does not fail: the work goes on. Whether results were lost is told at the end.
pub(crate) struct Console {
    out: Stream,
    err: Stream,
}

struct Stream {
    write: Mutex<Box<dyn Write + Send>>,
    /// Why something could not be printed, the first time.
    error: OnceLock<io::Error>,
    terminal: bool,
    styled: bool,
}

impl Console {
    /// The streams of the process.
    pub(crate) fn of_process() -> Self {
        let colors = env::var_os("NO_COLOR").is_none_or(|value| value.is_empty())
            && env::var_os("TERM").is_none_or(|value| value != "dumb");
        Self {
            out: Stream {
                write: Mutex::new(Box::new(io::stdout())),
                error: OnceLock::new(),
                terminal: io::stdout().is_terminal(),
                styled: colors && io::stdout().is_terminal(),
            },
            err: Stream {
                write: Mutex::new(Box::new(io::stderr())),
                error: OnceLock::new(),
                terminal: io::stderr().is_terminal(),
                styled: colors && io::stderr().is_terminal(),
            },
        }
    }

    /// A console that is no terminal.
    #[cfg(test)]
    pub(crate) fn to(out: impl Write + Send + 'static, err: impl Write + Send + 'static) -> Self {
        let plain = |write: Box<dyn Write + Send>| Stream {
            write: Mutex::new(write),
            error: OnceLock::new(),
            terminal: false,
            styled: false,
        };
        Self {
            out: plain(Box::new(out)),
            err: plain(Box::new(err)),
        }
    }

    /// Whether messages go to a terminal.
    pub(crate) fn is_interactive(&self) -> bool {
        self.err.terminal
    }

    /// Whether results go to a terminal.
    pub(crate) fn shows_results(&self) -> bool {
        self.out.terminal
    }

    /// A line of results.
    pub(crate) fn result(&self, line: &str) {
        self.print(&format!("{line}\n"));
    }

    /// Results that are no line: as they are.
    pub(crate) fn print(&self, text: &str) {
        self.out.print(text);
    }

    /// That results could not be printed, where a reader still waits for them.
    pub(crate) fn lost_results(&self) -> Option<Failure> {
        let error = self.out.error.get()?;
        let message = format!("cannot write the results: {}", reason(error));
        Some(Failure::Work(message))
    }

    /// A line about how things go.
    pub(crate) fn note(&self, line: &str) {
        self.err.print(&format!("{line}\n"));
    }

    /// Something that the user should know, though the work goes on.
    pub(crate) fn warn(&self, message: &str) {
        self.note(&format!(
            "{} {message}",
            self.err.paint("marbles:", BOLD_YELLOW)
        ));
    }

    /// Why something was not done.
    pub(crate) fn failure(&self, failure: &Failure) {
        self.note(&self.message(failure));
    }

    /// What [`Self::failure`] prints, without the end of the last line.
    pub(crate) fn message(&self, failure: &Failure) -> String {
        match failure {
            Failure::Usage(message) | Failure::Frames(message) | Failure::Work(message) => {
                format!("{} {message}", self.err.paint("marbles:", BOLD_RED))
            }
            Failure::Scene(error) if self.err.styled => error.styled().trim_end().to_owned(),
            Failure::Scene(error) => error.to_string().trim_end().to_owned(),
        }
    }

    /// What clap has to say, about a wrong command line or as help.
    pub(crate) fn clap(&self, message: &StyledStr, is_error: bool) {
        let stream = if is_error { &self.err } else { &self.out };
        if stream.styled {
            stream.print(&message.ansi().to_string());
        } else {
            stream.print(&message.to_string());
        }
    }
}

impl Stream {
    fn print(&self, text: &str) {
        let mut write = self.write.lock().unwrap_or_else(PoisonError::into_inner);
        let written = write
            .write_all(text.as_bytes())
            .and_then(|()| write.flush());
        match written {
            // A reader that has gone has read enough.
            Err(error) if error.kind() != ErrorKind::BrokenPipe => {
                self.error.get_or_init(|| error);
            }
            _ => {}
        }
    }

    fn paint(&self, text: &str, style: &str) -> String {
        if self.styled {
            format!("{style}{text}{RESET}")
        } else {
            text.to_owned()
        }
    }
}
