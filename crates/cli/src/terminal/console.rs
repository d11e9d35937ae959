//! The console: results go to stdout, unless pictures do, and everything else to stderr.

use std::env;
use std::io::{self, ErrorKind, IsTerminal, Write};
use std::sync::{Mutex, OnceLock, PoisonError};

use clap::builder::StyledStr;
use console::Term;
use serde_json::Value;

use crate::base::failure::{Failure, reason};

const BOLD_RED: &str = "\x1b[1;31m";
const BOLD_YELLOW: &str = "\x1b[1;33m";
const RESET: &str = "\x1b[0m";

/// The two streams, shared by threads.
///
/// Printing does not fail: the work continues. Lost results are reported at the end.
pub(crate) struct Console {
    out: Stream,
    err: Stream,
    /// The reader of messages, if it is a program.
    reader: OnceLock<Reader>,
    /// Set if stdout is for pictures.
    keeps_results_aside: OnceLock<()>,
}

/// A reader of messages, with its own form.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub(crate) enum Reader {
    People,
    /// A program that reads JSON objects from stderr, one per line.
    Json,
    /// A runner of Open Job Description, which reads failures from stdout.
    OpenJd,
}

struct Stream {
    write: Mutex<Box<dyn Write + Send>>,
    /// The first reason why something could not be printed.
    error: OnceLock<io::Error>,
    terminal: bool,
    styled: bool,
}

impl Console {
    /// The streams of the process.
    pub(crate) fn of_process() -> Self {
        let colors = env::var_os("NO_COLOR").is_none_or(|value| value.is_empty())
            && env::var_os("TERM").is_none_or(|value| value != "dumb");
        let (out, err) = (io::stdout(), io::stderr());
        let (out_terminal, err_terminal) = (out.is_terminal(), err.is_terminal());
        Self {
            out: Stream::new(out, out_terminal, colors),
            err: Stream::new(err, err_terminal, colors),
            reader: OnceLock::new(),
            keeps_results_aside: OnceLock::new(),
        }
    }

    /// A console that is no terminal.
    pub(crate) fn to(out: impl Write + Send + 'static, err: impl Write + Send + 'static) -> Self {
        Self {
            out: Stream::new(out, false, false),
            err: Stream::new(err, false, false),
            reader: OnceLock::new(),
            keeps_results_aside: OnceLock::new(),
        }
    }

    /// Sets the reader of all further messages.
    pub(crate) fn speak_to(&self, reader: Reader) {
        self.reader.get_or_init(|| reader);
    }

    /// From now on prints results on stderr, because stdout is for pictures.
    pub(crate) fn keep_results_aside(&self) {
        self.keeps_results_aside.get_or_init(|| ());
    }

    /// The reader of messages.
    pub(crate) fn reader(&self) -> Reader {
        self.reader.get().copied().unwrap_or(Reader::People)
    }

    /// Returns whether messages go to a terminal.
    pub(crate) fn is_interactive(&self) -> bool {
        self.err.terminal
    }

    /// Returns whether results go to a terminal.
    pub(crate) fn shows_results(&self) -> bool {
        self.out.terminal
    }

    /// The width of text with several lines: no more than is comfortable to read, and no more than the terminal has.
    pub(crate) fn columns(&self) -> usize {
        const MOST: usize = 100;
        let err = || self.err.columns(&Term::stderr());
        self.result_columns().or_else(err).unwrap_or(MOST).min(MOST)
    }

    /// The columns of the terminal to which results go, if they go to one.
    pub(crate) fn result_columns(&self) -> Option<usize> {
        self.out.columns(&Term::stdout())
    }

    /// A line of results, or several.
    pub(crate) fn result(&self, lines: &str) {
        self.print(&format!("{}\n", self.harmless(lines)));
    }

    /// Results that are not lines, unchanged.
    pub(crate) fn print(&self, text: &str) {
        let are_aside = self.keeps_results_aside.get().is_some();
        match (are_aside, self.reader()) {
            (false, _) => self.out.print(text),
            // Events there contain the results.
            (true, Reader::Json) => {}
            (true, Reader::People | Reader::OpenJd) => self.err.print(text),
        }
    }

    /// The failure to print results, unless nobody reads them any more.
    pub(crate) fn lost_results(&self) -> Option<Failure> {
        let error = self.out.error.get()?;
        let message = format!("cannot write the results: {}", reason(error));
        Some(Failure::Work(message))
    }

    /// A line about the progress.
    pub(crate) fn note(&self, line: &str) {
        self.styled_note(&self.harmless(line));
    }

    /// A line with styles of ours.
    fn styled_note(&self, line: &str) {
        self.err.print(&format!("{line}\n"));
    }

    /// Lines without control characters, so that file names and contents cannot control a terminal. Programs get them
    /// unchanged.
    fn harmless(&self, lines: &str) -> String {
        if self.reader() == Reader::Json {
            return lines.to_owned();
        }
        let parts = lines.split_inclusive(['\n', '\t']);
        let harmless = parts.map(|part| match part.chars().next_back() {
            Some(end @ ('\n' | '\t')) => {
                marbles_scene::harmless(&part[..part.len() - 1]) + end.encode_utf8(&mut [0])
            }
            _ => marbles_scene::harmless(part),
        });
        harmless.collect()
    }

    /// A warning: the work continues.
    pub(crate) fn warn(&self, message: &str) {
        if self.reader() == Reader::Json {
            return self.message_event("warning", message);
        }
        let name = self.err.paint("marbles:", BOLD_YELLOW);
        self.styled_note(&format!("{name} {}", self.harmless(message)));
    }

    /// The reason for a failure.
    pub(crate) fn failure(&self, failure: &Failure) {
        let text = failure.to_string();
        let message = text.trim_end();
        match self.reader() {
            Reader::Json => return self.message_event("error", message),
            Reader::OpenJd => self.reason(message),
            Reader::People => {}
        }
        self.styled_note(&self.message(failure));
    }

    /// A line of JSON with a message.
    fn message_event(&self, event: &str, message: &str) {
        let message = Value::from(message).to_string();
        self.note(&format!(r#"{{"event":"{event}","message":{message}}}"#));
    }

    /// The text that [`Self::failure`] prints, without the final line feed.
    pub(crate) fn message(&self, failure: &Failure) -> String {
        let text = match failure {
            Failure::Usage(message) | Failure::Work(message) | Failure::Changed(message) => {
                let message = self.harmless(message);
                format!("{} {message}", self.err.paint("marbles:", BOLD_RED))
            }
            Failure::Scene(error) if self.err.terminal => {
                error.for_terminal(self.columns(), self.err.styled)
            }
            Failure::Scene(error) => error.to_string(),
        };
        text.trim_end().to_owned()
    }

    /// The last line on stderr of a process that must end at once.
    pub(crate) fn farewell(&self) -> &'static str {
        match self.reader() {
            Reader::Json => r#"{"event":"warning","message":"interrupted"}"#,
            // Below the bar that may be there.
            Reader::OpenJd | Reader::People => "\nmarbles: interrupted",
        }
    }

    /// The reason why the exit code will not be 0, for runners of jobs, which show only this part of a log.
    pub(crate) fn reason(&self, message: &str) {
        if self.reader() == Reader::OpenJd {
            let first = message.lines().next().unwrap_or_default();
            self.result(&format!("openjd_fail: {first}"));
        }
    }

    /// A text from clap: an error in the command line, or help.
    pub(crate) fn clap(&self, message: &StyledStr, is_error: bool) {
        let stream = if is_error { &self.err } else { &self.out };
        if stream.styled {
            stream.print(&message.ansi().to_string());
        } else {
            // Where reasons of ours repeat a part of a word, it is escaped here.
            stream.print(&self.harmless(&message.to_string()));
        }
    }
}

impl Stream {
    fn new(write: impl Write + Send + 'static, terminal: bool, colors: bool) -> Self {
        Self {
            write: Mutex::new(Box::new(write)),
            error: OnceLock::new(),
            terminal,
            styled: colors && terminal,
        }
    }

    /// The number of columns, if the stream is a terminal of known size.
    fn columns(&self, terminal: &Term) -> Option<usize> {
        let (_, columns) = terminal.size_checked().filter(|_| self.terminal)?;
        (columns > 0).then(|| columns.into())
    }

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

#[cfg(test)]
pub(crate) mod tests;
