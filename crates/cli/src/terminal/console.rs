//! Where the user reads: results on stdout, all else on stderr.

use std::env;
use std::io::{self, ErrorKind, IsTerminal, Write};
use std::sync::{Mutex, OnceLock, PoisonError};

use clap::builder::StyledStr;
use serde::Serialize;

use crate::base::failure::{Failure, reason};

const BOLD_RED: &str = "\x1b[1;31m";
const BOLD_YELLOW: &str = "\x1b[1;33m";
const RESET: &str = "\x1b[0m";

/// The two streams, shared by threads.
///
/// Printing does not fail: the work goes on. Whether results were lost is told at the end.
pub(crate) struct Console {
    out: Stream,
    err: Stream,
    /// The program that reads, where one is known.
    reader: OnceLock<Reader>,
}

/// A program that has its own form of messages.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub(crate) enum Reader {
    /// Reads objects of JSON, one a line, on stderr.
    Json,
    /// Runs jobs of Open Job Description, and reads what went wrong on stdout.
    OpenJd,
}

/// A message in JSON.
#[derive(Serialize)]
#[serde(tag = "event", rename_all = "snake_case")]
enum Message<'a> {
    Warning { message: &'a str },
    Error { message: &'a str },
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
            reader: OnceLock::new(),
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
            reader: OnceLock::new(),
        }
    }

    /// Speaks to a program from now on.
    pub(crate) fn speak_to(&self, reader: Reader) {
        self.reader.get_or_init(|| reader);
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

    /// A line of JSON about how things go.
    pub(crate) fn event(&self, event: &impl Serialize) {
        // Events are plain numbers and texts, which always have a form in JSON.
        if let Ok(line) = serde_json::to_string(event) {
            self.note(&line);
        }
    }

    /// Something that the user should know, though the work goes on.
    pub(crate) fn warn(&self, message: &str) {
        if self.reader.get() == Some(&Reader::Json) {
            return self.event(&Message::Warning { message });
        }
        self.note(&format!(
            "{} {message}",
            self.err.paint("marbles:", BOLD_YELLOW)
        ));
    }

    /// Why something was not done.
    pub(crate) fn failure(&self, failure: &Failure) {
        let text = failure.to_string();
        let message = text.trim_end();
        match self.reader.get() {
            Some(Reader::Json) => return self.event(&Message::Error { message }),
            Some(Reader::OpenJd) => self.reason(message),
            None => {}
        }
        self.note(&self.message(failure));
    }

    /// What [`Self::failure`] prints, without the end of the last line.
    pub(crate) fn message(&self, failure: &Failure) -> String {
        match failure {
            Failure::Usage(message) | Failure::Frames(message) | Failure::Work(message) => {
                format!(
                    "{} {}",
                    self.err.paint("marbles:", BOLD_RED),
                    message.trim_end()
                )
            }
            Failure::Scene(error) if self.err.styled => error.styled().trim_end().to_owned(),
            Failure::Scene(error) => error.to_string().trim_end().to_owned(),
        }
    }

    /// The last line on stderr of a process that has to end at once.
    pub(crate) fn farewell(&self) -> &'static str {
        match self.reader.get() {
            Some(Reader::Json) => r#"{"event":"warning","message":"interrupted"}"#,
            // Below the bar that may be there.
            Some(Reader::OpenJd) | None => "\nmarbles: interrupted",
        }
    }

    /// Why the exit code will not be 0, for runners of jobs, which show only this of a log.
    pub(crate) fn reason(&self, message: &str) {
        if self.reader.get() == Some(&Reader::OpenJd) {
            let first = message.lines().next().unwrap_or_default();
            self.result(&format!("openjd_fail: {first}"));
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

#[cfg(test)]
pub(crate) mod tests {
    use std::sync::Arc;

    use serde_json::{Value, json};

    use super::*;

    /// What was printed.
    #[derive(Clone, Default)]
    pub(crate) struct Text(Arc<Mutex<Vec<u8>>>);

    impl Write for Text {
        fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
            self.0.lock().unwrap().write(bytes)
        }

        fn flush(&mut self) -> io::Result<()> {
            Ok(())
        }
    }

    impl Text {
        pub(crate) fn read(&self) -> String {
            String::from_utf8(self.0.lock().unwrap().clone()).unwrap()
        }
    }

    /// What goes to stdout and to stderr about a warning and a failure.
    fn say(reader: Option<Reader>) -> (String, String) {
        let (out, err) = (Text::default(), Text::default());
        let console = Console::to(out.clone(), err.clone());
        if let Some(reader) = reader {
            console.speak_to(reader);
        }
        console.warn("two \"words\"");
        console.failure(&Failure::Work("one line\nand another\n".to_owned()));
        (out.read(), err.read())
    }

    #[test]
    fn programs_get_messages_in_their_form() {
        let plain = "marbles: two \"words\"\nmarbles: one line\nand another\n";
        assert_eq!(say(None), (String::new(), plain.to_owned()));
        let fail = "openjd_fail: one line\n".to_owned();
        assert_eq!(say(Some(Reader::OpenJd)), (fail, plain.to_owned()));
        let (out, err) = say(Some(Reader::Json));
        assert_eq!(out, "");
        let lines = err.lines().map(|line| serde_json::from_str(line).unwrap());
        let expected = [
            json!({ "event": "warning", "message": "two \"words\"" }),
            json!({ "event": "error", "message": "one line\nand another" }),
        ];
        assert_eq!(lines.collect::<Vec<Value>>(), expected);
    }
}
