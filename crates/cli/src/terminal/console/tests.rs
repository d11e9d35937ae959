//! Tests of `console.rs`.

use std::sync::Arc;

use serde_json::{Value, json};

use super::*;

/// The printed text.
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

/// The texts on stdout and on stderr about a warning and a failure.
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

#[test]
fn names_and_contents_do_nothing_to_a_terminal() {
    let (out, err) = (Text::default(), Text::default());
    let console = Console::to(out.clone(), err.clone());
    let evil = "a\u{1b}[31m\u{9b}1m\u{202e}b\tc\nd";
    console.result(evil);
    console.note(evil);
    console.warn(evil);
    console.failure(&Failure::Work(evil.to_owned()));
    let shown = "a\\u{1b}[31m\\u{9b}1m\\u{202e}b\tc\nd\n";
    assert_eq!(out.read(), shown);
    assert_eq!(
        err.read(),
        format!("{shown}marbles: {shown}marbles: {shown}")
    );
}
